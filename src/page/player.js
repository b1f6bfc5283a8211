// Time, controls, curves that follow the picture.
const first = times[0], last_time = times[times.length - 1], length = last_time - first;
const state = { t: first, playing: true, slow: 1, bend: 1, gap: 1, held: false };
const show = () => ({ forces: $("forces").checked, traces: $("traces").checked, names: $("names").checked });

const near = (list, x) => list.reduce((best, y) => (Math.abs(Math.log(y / x)) < Math.abs(Math.log(best / x)) ? y : best));
const round = x => near([1, 2, 5].map(k => k * 10 ** Math.floor(Math.log10(x))).concat(10 ** Math.ceil(Math.log10(x))), x);
const slider = (id, key, text) => {
  const apply = () => {
    const raw = 10 ** +$(id).value;
    state[key] = raw > 1 && key !== "slow" ? round(raw) : raw;
    if (key === "slow") state[key] = round(raw);
    $(id + "-says").textContent = text(state[key]);
    stale = true;
  };
  $(id).addEventListener("input", apply);
  return apply;
};
let stale = true;
const applies = [
  slider("slow", "slow", k => (k === 1 ? "real time" : k > 1 ? `${k} x slower` : `${+(1 / k).toPrecision(2)} x faster`)),
  slider("bend", "bend", k => `${k} x`),
  slider("gap", "gap", k => `${k} x`),
];
// A run takes some six seconds; what is too small to be seen is made a twentieth of the picture.
$("slow").value = Math.log10(Math.min(9999, Math.max(0.1, 6 / length)));
if (bend_most > 0) $("bend").value = Math.max(0, Math.log10(0.04 * size / bend_most)); else $("bend-label").hidden = true;
if (gap_most > 0) $("gap").value = Math.max(0, Math.log10(0.012 * size / gap_most)); else $("gap-label").hidden = true;
applies.forEach(apply => apply());

const play = on => {
  state.playing = on;
  $("play").textContent = on ? "pause" : "play";
  $("play").setAttribute("aria-pressed", String(on));
};
const go = t => { state.t = Math.min(last_time, Math.max(first, t)); stale = true; };
$("play").addEventListener("click", () => play(!state.playing));
$("instant").addEventListener("input", () => { play(false); go(first + length * +$("instant").value); });
for (const id of ["forces", "traces", "names"]) $(id).addEventListener("change", () => { stale = true; });
$("home").addEventListener("click", () => { reset_camera(); stale = true; });
if (!gpu) {
  const note = document.createElement("p");
  note.textContent = "This browser gives no WebGL: the moving picture is left out; curves and tables stand below.";
  canvas.parentNode.replaceWith(note);
}

// Pointers: one turns or moves, two zoom.
const pointers = new Map();
const turn = (dx, dy) => { camera.yaw -= 0.008 * dx; camera.pitch = Math.min(1.55, Math.max(-1.55, camera.pitch + 0.008 * dy)); stale = true; };
const zoom = k => { camera.distance = Math.min(20 * size, Math.max(0.05 * size, camera.distance * k)); stale = true; };
const shift = (dx, dy) => {
  const { right, top } = looks(), k = 0.66 * camera.distance / canvas.clientHeight;
  camera.target = V.add(camera.target, V.add(V.by(-k * dx, right), V.by(k * dy, top)));
  stale = true;
};
canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); pointers.set(event.pointerId, [event.clientX, event.clientY]); });
for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => pointers.delete(event.pointerId));
canvas.addEventListener("pointermove", event => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY], [dx, dy] = [now[0] - before[0], now[1] - before[1]];
  if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1], apart = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
    zoom(apart(before) / Math.max(1, apart(now)));
    shift(dx / 2, dy / 2);
  } else if (event.shiftKey || event.buttons === 2) shift(dx, dy);
  else turn(dx, dy);
  pointers.set(event.pointerId, now);
});
canvas.addEventListener("wheel", event => { event.preventDefault(); zoom(Math.exp(0.0012 * event.deltaY)); }, { passive: false });
canvas.addEventListener("contextmenu", event => event.preventDefault());
document.addEventListener("keydown", event => {
  if (event.target.matches("input,select,button,textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
  const step = length / Math.min(400, times.length - 1);
  const does = {
    " ": () => play(!state.playing), ",": () => { play(false); go(state.t - step); }, ".": () => { play(false); go(state.t + step); },
    "+": () => zoom(0.9), "=": () => zoom(0.9), "-": () => zoom(1.1), Home: () => reset_camera(),
  };
  if (document.activeElement === canvas) Object.assign(does, {
    ArrowLeft: () => turn(-12, 0), ArrowRight: () => turn(12, 0), ArrowUp: () => turn(0, -12), ArrowDown: () => turn(0, 12),
  });
  if (does[event.key]) { does[event.key](); stale = true; event.preventDefault(); }
});

// Curves: a line at the instant, values beside the names, and back: the instant under the pointer.
const SVG = "http://www.w3.org/2000/svg";
let charts = [];
const link = svg => {
  const [low, high, left, wide] = svg.dataset.x.split(",").map(Number);
  const seek = event => {
    const box = svg.getBoundingClientRect(), x = (event.clientX - box.left) * svg.viewBox.baseVal.width / box.width;
    if (x < left - 4 || x > left + wide + 4) return;
    state.held = true;
    go(low + (high - low) * (x - left) / wide);
  };
  svg.addEventListener("pointermove", seek);
  svg.addEventListener("pointerdown", seek);
  svg.addEventListener("pointerleave", () => { state.held = false; });
  sight.observe(svg);
  svg.querySelector(".cursor").style.visibility = "visible";
  const now = [...svg.querySelectorAll(".now")].map(span => [span, span.dataset.columns.split(",").map(Number)]);
  return { svg, cursor: svg.querySelector(".cursor"), at: t => left + wide * (t - low) / (high - low), now };
};
// Only what is in sight follows, and numbers no more often than they can be read.
const in_sight = new Set();
const sight = new IntersectionObserver(list => { for (const { target, isIntersecting } of list) { if (isIntersecting) in_sight.add(target); else in_sight.delete(target); } stale = true; });
let told = -1;
const follow = (when, tell) => {
  for (const { svg, cursor, at, now } of charts) {
    if (!in_sight.has(svg)) continue;
    cursor.setAttribute("transform", `translate(${at(state.t).toFixed(1)} 0)`);
    if (tell) for (const [span, columns] of now) {
      span.textContent = digits(columns.length > 1 ? Math.hypot(...columns.map(c => value_at(when, c))) : value_at(when, columns[0]));
    }
  }
};

// Any column.
const known = run.columns.map(([name, unit], at) => ({ name, unit, at })).filter(({ name }) => !/\.pose\d+$/.test(name));
const select = $("column");
for (const { name, unit, at } of known) select.append(new Option(`${name} [${unit}]`, at));
const choose = () => {
  const column = +select.value, [name, unit] = run.columns[column], list = times.map((_, row) => cell(row, column));
  let [low, high] = [Math.min(...list), Math.max(...list)];
  if (!(high > low)) [low, high] = [low - 1, high + 1];
  const labelled = [low, (low + high) / 2, high].map(v => [v, digits(v)]);
  // A label that is cut loses its sign: as wide as the longest, 7.4 a character.
  const L = Math.max(58, 8 + 7.4 * Math.max(...labelled.map(([, text]) => text.length)));
  const [W, H, R, T, B] = [480, 220, 16, 34, 30], x = t => L + (W - L - R) * (t - first) / length, y = v => H - B - (H - T - B) * (v - low) / (high - low);
  const svg = document.createElementNS(SVG, "svg");
  const add = (tag, attributes, text) => {
    const made = document.createElementNS(SVG, tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    svg.append(made);
    return made;
  };
  svg.setAttribute("class", "chart");
  svg.setAttribute("viewBox", `0 0 ${W} ${H}`);
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", name);
  svg.dataset.x = [first, last_time, L, W - L - R].join();
  for (const [v, text] of labelled) {
    add("path", { class: "grid", d: `M${L} ${y(v)}H${W - R}` });
    add("text", { x: L - 6, y: y(v) + 4, "text-anchor": "end" }, text);
  }
  for (const t of [first, (first + last_time) / 2, last_time]) add("text", { x: x(t), y: H - 10, "text-anchor": "middle" }, digits(t) + " s");
  const title = add("text", { class: "title", x: L, y: 18 }, `${name} [${unit}]`), now = document.createElementNS(SVG, "tspan");
  now.setAttribute("class", "now");
  now.setAttribute("dx", "8");
  now.dataset.columns = column;
  title.append(now);
  add("polyline", { class: "s k0", points: list.map((v, row) => `${x(times[row]).toFixed(1)},${y(v).toFixed(1)}`).join(" ") });
  add("path", { class: "cursor", d: `M0 ${T}V${H - B}` });
  $("chosen").replaceChildren(svg);
  charts = [...document.querySelectorAll("svg[data-time]")].map(link).concat(link(svg));
  stale = true;
};
select.addEventListener("change", choose);
if (known.length) choose();

const dark = matchMedia("(prefers-color-scheme: dark)");
const restyle = () => { learn_colours(); everything = true; bearings.forEach(bearing => bearing.restyle()); if (worn && worn.redraw) worn.redraw(); stale = true; };
dark.addEventListener("change", restyle);
// Pictures are drawn as fine as the machine keeps up with while they move, and in full when they stand.
const FINEST = Math.min(2, devicePixelRatio || 1), STANDING = gpu && gpu.software ? Math.max(2, FINEST) : FINEST;
let fine = FINEST, moving = true;
let wide = canvas.clientWidth, high = canvas.clientHeight;
const fit = () => {
  const k = moving ? fine : STANDING, [w, h] = [Math.round(wide * k), Math.round(high * k)];
  if (w && h && (canvas.width !== w || canvas.height !== h)) { canvas.width = w; canvas.height = h; stale = true; }
};
// The next picture fits itself: a canvas that is resized here, after a picture and before it is shown, would flash empty.
new ResizeObserver(() => { wide = canvas.clientWidth; high = canvas.clientHeight; stale = true; }).observe(canvas);
for (const bearing of bearings) sight.observe(bearing.canvas);

// What is out of sight is drawn first of all, for paper, and in other colours.
let everything = true;
const on_paper = is => { document.documentElement.classList.toggle("on-paper", is); restyle(); draw(); };
addEventListener("beforeprint", () => on_paper(true));
addEventListener("afterprint", () => on_paper(false));

const draw = () => {
  const when = place_in(state.t), now = performance.now(), tell = !state.playing || now - told > 100;
  if (tell) told = now;
  if (gpu && canvas.width) paint(when, state.bend, state.gap, show());
  for (const bearing of bearings) if (in_sight.has(bearing.canvas) || everything) bearing.draw(when, tell || everything);
  everything = false;
  follow(when, tell);
  if (tell) {
    $("clock").textContent = `t = ${state.t.toFixed(Math.max(2, 3 - Math.floor(Math.log10(length))))} s`;
    $("instant").value = (state.t - first) / length;
  }
};
// Pictures in each of the last seconds, and how long the last ones took.
let before = 0, frames = 0, since = 0, took = 1000 / 60, rested = 0;
const adapt = passed => {
  took += 0.1 * (1000 * passed - took);
  // Down at once, up slowly, so that it does not swing.
  if (took > 20 && fine > 0.6) { fine = Math.max(0.6, fine * 0.85); took = 1000 / 60; rested = 0; }
  else if (took < 17.2 && fine < FINEST && ++rested > 240) { fine = Math.min(FINEST, fine * 1.1); rested = 0; }
};
const tick = now => {
  const passed = Math.min(0.1, (now - before) / 1000), runs = state.playing && !state.held;
  before = now;
  if (runs) { state.t += passed / state.slow; if (state.t > last_time) state.t = first + (state.t - first) % length; stale = true; adapt(passed); }
  moving = runs || pointers.size > 0;
  fit();
  if (stale) { stale = false; draw(); frames++; }
  if (now - since > 1000) {
    $("rate").textContent = state.playing ? `${Math.round(frames * 1000 / (now - since))} pictures a second` : "";
    [since, frames] = [now, 0];
  }
  requestAnimationFrame(tick);
};
window.linkwear = { state, camera, go, play, draw };
requestAnimationFrame(now => { before = since = now; tick(now); });

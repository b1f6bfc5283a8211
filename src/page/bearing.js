// Journals in their bearings and wear around them, in the plane across the axis.
const sharp = (px, parent) => {
  const made = document.createElement("canvas");
  made.style.width = px + "px";
  made.width = made.height = px * Math.min(2, devicePixelRatio || 1);
  parent.append(made);
  return made;
};
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const digits = x => (x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(4)));

const bearings = scene.joints.filter(joint => joint.clearance && index.has(joint.name + ".x")).map(joint => {
  const column = name => index.get(`${joint.name}.${name}`);
  const frame = document.createElement("figure"), canvas = sharp(260, frame), says = document.createElement("figcaption");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "orbit of the journal of " + joint.name + " in its bearing");
  frame.append(says);
  $("bearings").append(frame);
  const [x, y, Fn, gap, angle, vt] = ["x", "y", "Fn", "gap", "contact_angle", "vt"].map(column);
  let reach = joint.clearance.radial, strongest = 0;
  const path = [];
  for (let row = 0; row < times.length; row++) {
    const at = [cell(row, x), cell(row, y)];
    path.push(at);
    reach = Math.max(reach, Math.hypot(...at));
    if (Fn !== undefined) strongest = Math.max(strongest, cell(row, Fn));
  }
  // Clearance is drawn large: the journal may move by what is between both circles. What stands still is drawn once.
  const c = canvas.getContext("2d"), w = canvas.width, mid = w / 2, unit = w / 260, scale = 0.2 * w / reach, journal = 0.2 * w;
  const still = document.createElement("canvas");
  still.width = still.height = w;
  let ink, blue, red;
  const restyle = () => {
    [ink, blue, red] = ["--ink", "--c0", "--c5"].map(css);
    const s = still.getContext("2d");
    s.clearRect(0, 0, w, w);
    s.strokeStyle = css("--soft");
    s.lineWidth = 4 * unit;
    s.beginPath(); s.arc(mid, mid, journal + scale * joint.clearance.radial, 0, 7); s.stroke();
    s.lineWidth = 1.5 * unit;
    s.strokeStyle = blue;
    s.beginPath();
    path.forEach(([a, b], k) => s[k ? "lineTo" : "moveTo"](mid + scale * a, mid - scale * b));
    s.stroke();
  };
  restyle();
  const draw = (when, tell) => {
    const px = value_at(when, x), py = value_at(when, y), cx = mid + scale * px, cy = mid - scale * py;
    c.clearRect(0, 0, w, w);
    c.drawImage(still, 0, 0);
    c.lineWidth = 1.5 * unit;
    c.beginPath(); c.arc(cx, cy, journal, 0, 7); c.globalAlpha = 0.2; c.fillStyle = blue; c.fill(); c.globalAlpha = 1; c.strokeStyle = ink; c.stroke();
    c.beginPath(); c.arc(cx, cy, 3 * unit, 0, 7); c.fillStyle = ink; c.fill();
    const force = Fn === undefined ? 0 : value_at(when, Fn), r = Math.hypot(px, py);
    if (force > 0 && r > 0 && strongest > 0) {
      const dx = px / r, dy = -py / r, fx = cx + journal * dx, fy = cy + journal * dy, long = 0.25 * w * force / strongest, tx = fx - long * dx, ty = fy - long * dy;
      c.strokeStyle = c.fillStyle = red;
      c.lineWidth = 2.5 * unit;
      c.beginPath(); c.moveTo(fx, fy); c.lineTo(tx, ty); c.stroke();
      c.beginPath(); c.moveTo(tx, ty);
      for (const s of [-1, 1]) c.lineTo(tx + 8 * unit * dx + s * 4 * unit * dy, ty + 8 * unit * dy - s * 4 * unit * dx);
      c.fill();
    }
    if (tell) says.textContent = `${joint.name}: journal in its bearing, clearance ${digits(1e6 * joint.clearance.radial)} um drawn large; contact force ${digits(force)} N${gap === undefined ? "" : ", gap " + digits(1e6 * value_at(when, gap)) + " um"}`;
  };
  return { joint, canvas, draw, restyle, columns: { angle, Fn, vt } };
});

// Depth by angle: sliding work of the run, its largest value 1.
const BINS = 72;
function around({ angle, Fn, vt }) {
  const bins = new Float64Array(BINS);
  if (angle === undefined || Fn === undefined || vt === undefined) return bins;
  // A contact is as wide as some degrees: work is spread over three bins.
  for (let row = times.length > 8 ? times.length >> 2 : 0; row < times.length; row++) {
    const at = (Math.floor((cell(row, angle) / (2 * Math.PI) + 1) * BINS) % BINS + BINS) % BINS, work = cell(row, Fn) * Math.abs(cell(row, vt));
    bins[at] += work / 2;
    bins[(at + 1) % BINS] += work / 4;
    bins[(at + BINS - 1) % BINS] += work / 4;
  }
  const most = Math.max(...bins);
  return most > 0 ? bins.map(x => x / most) : bins;
}
const worn = $("worn");
if (worn && life) {
  const shown = life.cycles.length ? life.cycles[0].joints.map((entry, at) => ({ at, bearing: bearings.find(b => b.joint.name === entry.joint) })).filter(o => o.bearing) : [];
  // Where a ball bears in its socket is no one angle: of it there is no such picture.
  const around_of = shown.map(({ at, bearing }) => ({ at, bearing, shape: around(bearing.columns) })).filter(({ shape }) => shape.some(x => x > 0));
  const parts = around_of.map(part => ({ ...part, canvas: sharp(280, $("polars")) }));
  const slider = $("cycle");
  slider.max = life.cycles.length;
  slider.value = life.cycles.length;
  const draw = () => {
    const last = life.cycles.length, upto = +slider.value;
    for (const { at, bearing, canvas, shape } of parts) {
      const c = canvas.getContext("2d"), w = canvas.width, mid = w / 2, ring = 0.14 * w, most = life.cycles[last - 1].joints[at].wear_m, unit = w / 280;
      c.clearRect(0, 0, w, w);
      c.font = `${11 * unit}px system-ui,sans-serif`;
      c.strokeStyle = css("--line");
      for (const part of [0, 0.5, 1]) { c.beginPath(); c.arc(mid, mid, ring + 0.27 * w * part, 0, 7); c.stroke(); }
      const steps = Math.min(upto, 10);
      for (let k = 1; k <= steps; k++) {
        const cycle = Math.max(1, Math.round(upto * k / steps)), depth = life.cycles[cycle - 1].joints[at].wear_m / most;
        c.beginPath();
        shape.forEach((x, bin) => {
          const a = 2 * Math.PI * (bin + 0.5) / BINS, r = ring + 0.27 * w * x * depth;
          c[bin ? "lineTo" : "moveTo"](mid + r * Math.cos(a), mid - r * Math.sin(a));
        });
        c.closePath();
        c.globalAlpha = k === steps ? 1 : 0.35;
        c.strokeStyle = css("--c1");
        c.lineWidth = (k === steps ? 2 : 1) * unit;
        c.stroke();
        c.globalAlpha = 1;
      }
      c.fillStyle = css("--ink");
      c.textAlign = "center";
      c.fillText(bearing.joint.name, mid, mid + 4 * unit);
      for (const [a, text] of [[0, "0°"], [90, "90°"], [180, "180°"], [270, "270°"]]) {
        const r = ring + 0.305 * w;
        c.fillText(text, mid + r * Math.cos(a * Math.PI / 180), mid - r * Math.sin(a * Math.PI / 180) + 4 * unit);
      }
      c.fillStyle = css("--soft");
      c.textAlign = "left";
      c.fillText(`outer ring: ${digits(1e6 * most)} um`, 2 * unit, 11 * unit);
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", "wear around the bearing of " + bearing.joint.name);
    }
    const depth = upto ? life.cycles[upto - 1].joints.map(j => `${j.joint} ${digits(1e6 * j.wear_m)} um`).join(", ") : "new";
    $("cycle-says").textContent = `${upto}: ${depth}`;
  };
  slider.addEventListener("input", draw);
  worn.redraw = draw;
  draw();
  worn.hidden = !parts.length;
}

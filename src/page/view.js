// The mechanism in space: where its bodies are at an instant, seen through a camera that can be turned.
const read = id => JSON.parse(document.getElementById(id).textContent);
const $ = id => document.getElementById(id);
const { scene, run } = read("motion");
const simulation = read("simulation"), life = read("life");
const times = run.times, width = run.columns.length;
const values = (() => {
  const text = atob(run.values), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
})();
const index = new Map(run.columns.map(([name], at) => [name, at]));
const cell = (row, column) => values[row * width + column];
// Row before an instant, and how far on to the next.
const place_in = t => {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) { const m = (low + high) >> 1; if (times[m] <= t) low = m; else high = m; }
  const span = times[high] - times[low];
  return [low, span > 0 ? Math.min(1, Math.max(0, (t - times[low]) / span)) : 0];
};
const value_at = ([row, part], column) => {
  const a = cell(row, column);
  return part > 0 ? a + part * (cell(row + 1, column) - a) : a;
};
const vector_at = (when, column) => [0, 1, 2].map(i => value_at(when, column + i));

for (const body of scene.bodies) {
  body.pose = index.get(body.name + ".pose0");
  body.modes = body.line.length ? body.line[0].shape.map((_, k) => index.get(`${body.name}.eta${k + 1}`)) : [];
  const near = p => body.line.findIndex(n => V.norm(V.sub(n.at, p)) < 1e-6 * (1 + V.norm(p)));
  body.node = body.places.map(near);
}
for (const joint of scene.joints) joint.force = index.get(joint.name + ".Fx");

const moved = (when, body, p) => {
  const at = body.pose;
  return [0, 1, 2].map(i => value_at(when, at + 3 * i) * p[0] + value_at(when, at + 3 * i + 1) * p[1] + value_at(when, at + 3 * i + 2) * p[2] + value_at(when, at + 9 + i));
};
const turned = (when, body, d) => [0, 1, 2].map(i => V.dot([0, 1, 2].map(j => value_at(when, body.pose + 3 * i + j)), d));
const bent = (when, body, list) => {
  let sum = [0, 0, 0];
  body.modes.forEach((column, k) => { sum = V.add(sum, V.by(value_at(when, column), list[k])); });
  return sum;
};
// Journals of revolute joints leave their bearings across the axis; the offset in the frame of the bearing.
const offset_at = (when, joint) => {
  if (!joint.clearance) return null;
  const [[pb, pp], [cb, cp]] = joint.sides;
  const end = (b, p) => (b === null ? p : moved(when, scene.bodies[b], p));
  return V.sub(end(cb, cp), end(pb, pp));
};

// Straight parts that a flexible body is drawn by, between two of its nodes.
const BENDS = 6;
// What is seen at an instant: places of every body, with deflection and clearance made larger.
function figure(when, bend, gap) {
  const shifts = scene.bodies.map(() => []);
  for (const joint of scene.joints) {
    if (!joint.clearance || gap <= 1) continue;
    const [body, p] = joint.sides[1];
    if (body !== null) shifts[body].push([p, V.by(gap - 1, offset_at(when, joint))]);
  }
  return scene.bodies.map((body, b) => {
    const shift = p => { const s = shifts[b].find(([q]) => V.norm(V.sub(p, q)) < 1e-9); return s ? s[1] : [0, 0, 0]; };
    const places = body.places.map((p, k) => {
      const node = body.node[k];
      const q = node < 0 ? p : V.add(p, V.by(bend, bent(when, body, body.line[node].shape)));
      return V.add(moved(when, body, q), shift(p));
    });
    if (!body.line.length) return { places, curve: null };
    const curve = [];
    for (let k = 0; k + 1 < body.line.length; k++) {
      const [a, b2] = [body.line[k], body.line[k + 1]], d = V.sub(b2.at, a.at), l = V.norm(d);
      const [u0, u1, s0, s1] = [bent(when, body, a.shape), bent(when, body, b2.shape), bent(when, body, a.slope), bent(when, body, b2.slope)];
      for (let j = k ? 1 : 0; j <= BENDS; j++) {
        const x = j / BENDS, y = 1 - x;
        let u = V.add(V.by(y * y * (1 + 2 * x), u0), V.by(x * x * (3 - 2 * x), u1));
        u = V.add(u, V.add(V.by(l * x * y * y, s0), V.by(-l * x * x * y, s1)));
        curve.push(moved(when, body, V.add(V.add(a.at, V.by(x, d)), V.by(bend, u))));
      }
    }
    const ends = [shift(body.line[0].at), shift(body.line[body.line.length - 1].at)];
    return { places, curve: curve.map((p, k) => V.add(p, V.add(V.by(1 - k / (curve.length - 1), ends[0]), V.by(k / (curve.length - 1), ends[1])))) };
  });
}

// How large everything is over the run.
const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
const include = p => p.forEach((x, i) => { box.low[i] = Math.min(box.low[i], x); box.high[i] = Math.max(box.high[i], x); });
let bend_most = 0, gap_most = 0, force_most = 0;
for (let row = 0; row < times.length; row += Math.max(1, Math.floor(times.length / 120))) {
  const when = [row, 0];
  for (const body of scene.bodies) {
    body.places.forEach(p => include(moved(when, body, p)));
    for (const node of body.line) bend_most = Math.max(bend_most, V.norm(bent(when, body, node.shape)));
  }
  for (const joint of scene.joints) {
    const offset = offset_at(when, joint);
    if (offset) gap_most = Math.max(gap_most, V.norm(offset));
    if (joint.force !== undefined) force_most = Math.max(force_most, V.norm(vector_at(when, joint.force)));
  }
}
scene.joints.forEach(joint => joint.sides.forEach(([body, p]) => body === null && include(p)));
const middle = V.by(0.5, V.add(box.low, box.high)), size = V.norm(V.sub(box.high, box.low)) || 1;
const thick = body => Math.min(0.03 * size, Math.max(0.006 * size, body.radius || 0.011 * size));
const knob = 0.014 * size * (scene.bodies.length > 20 ? 0.55 : 1);

// Camera: looks from `yaw` and `pitch` at a target, `up` being against gravity.
const up = V.unit(scene.up), [east, north] = across(up);
const plane_axis = (() => {
  const turning = scene.joints.filter(j => j.axis && j.look === "pin");
  const plane = scene.joints.every(j => j.is_plane);
  return plane && turning.length && turning.every(j => V.norm(V.cross(j.axis, turning[0].axis)) < 1e-6) ? V.unit(turning[0].axis) : null;
})();
const front = () => {
  if (!plane_axis) return { yaw: Math.atan2(V.dot([-0.42, -1, 0.3], north), V.dot([-0.42, -1, 0.3], east)), pitch: 0.38 };
  const a = V.dot(plane_axis, up);
  if (Math.abs(a) > 0.9) return { yaw: -Math.PI / 2, pitch: 1.2 };
  const side = V.dot(V.cross(up, plane_axis), [1, 1, 1]) < 0 ? -1 : 1;
  const d = V.by(side, plane_axis);
  return { yaw: Math.atan2(V.dot(d, north), V.dot(d, east)) + 0.2, pitch: 0.15 };
};
const camera = {};
const reset_camera = () => Object.assign(camera, front(), { distance: (plane_axis ? 1.4 : 1.6) * size, target: middle });
reset_camera();
const looks = () => {
  const { yaw, pitch } = camera, flat = V.add(V.by(Math.cos(yaw), east), V.by(Math.sin(yaw), north));
  const back = V.add(V.by(Math.cos(pitch), flat), V.by(Math.sin(pitch), up));
  const right = V.unit(V.cross(up, back));
  return { back, right, top: V.cross(back, right) };
};
function projection(aspect) {
  const { back, right, top } = looks(), eye = V.add(camera.target, V.by(camera.distance, back));
  const f = 1 / Math.tan(0.32), tall = f * Math.min(1, aspect * 0.75), near = camera.distance / 60, far = camera.distance + 12 * size;
  const view = [[...right, -V.dot(right, eye)], [...top, -V.dot(top, eye)], [...back, -V.dot(back, eye)]];
  const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
  const rows = [view[0].map(x => x * tall / aspect), view[1].map(x => x * tall), view[2].map((x, i) => a * x + (i === 3 ? b : 0)), view[2].map(x => -x)];
  const columns = [];
  for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) columns.push(rows[r][c]);
  return { matrix: columns, rows, light: V.unit(V.add(back, V.add(V.by(0.5, top), V.by(-0.3, right)))) };
}
const colour_of = name => {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim().replace("#", "");
  const long = text.length === 3 ? [...text].map(c => c + c).join("") : text;
  return [0, 2, 4].map(i => parseInt(long.slice(i, i + 2), 16) / 255).concat(1);
};
let colours;
const learn_colours = () => {
  colours = { bodies: [0, 1, 2, 3, 4, 5, 6, 7].map(k => colour_of("--c" + k)), ink: colour_of("--ink"), soft: colour_of("--soft"), line: colour_of("--line"), paper: colour_of("--panel"), force: colour_of("--c5") };
};
learn_colours();

const canvas = $("view"), gpu = solids(canvas);
const grid = gpu && (() => {
  const bottom = Math.min(...[0, 1, 2, 3, 4, 5, 6, 7].map(k => V.dot(up, [0, 1, 2].map(i => (k >> i & 1 ? box.high : box.low)[i])))) - 0.07 * size;
  const base = V.add(V.sub(middle, V.by(V.dot(middle, up), up)), V.by(bottom, up)), list = [], half = 0.75 * size;
  for (let k = -5; k <= 5; k++) for (const [a, b] of [[east, north], [north, east]]) {
    const from = V.add(base, V.by(k * half / 5, a));
    list.push(V.add(from, V.by(-half, b)), V.add(from, V.by(half, b)));
  }
  return gpu.lines(list);
})();
const traces = scene.traces.map(name => {
  const column = index.get(name + ".x");
  if (column === undefined || !gpu) return null;
  const list = [];
  for (let row = 0; row < times.length; row++) list.push(vector_at([row, 0], column));
  return gpu.lines(list);
});

function paint(when, bend, gap, show) {
  const wide = canvas.width / canvas.height, lens = projection(wide), shape = figure(when, bend, gap), labels = [];
  gpu.begin(lens.matrix, lens.light, colours.paper);
  if (grid) grid(colours.line, "pairs");
  if (show.traces) traces.forEach((trace, k) => trace && trace(colours.bodies[(k + 3) % 8]));
  scene.bodies.forEach((body, b) => {
    const { places, curve } = shape[b], colour = colours.bodies[b % 8], r = thick(body), rod = body.square ? gpu.box : gpu.rod;
    if (curve) {
      for (let k = 0; k + 1 < curve.length; k++) gpu.rod(curve[k], curve[k + 1], r, colour);
      gpu.ball(curve[0], r, colour);
      gpu.ball(curve[curve.length - 1], r, colour);
    }
    body.rods.forEach(([p, q], k) => { if (!curve || k) rod(places[p], places[q], r, colour); });
    if (!body.rods.length && places[0]) gpu.ball(places[0], 2 * r, colour);
    if (show.names && places[0]) labels.push([body.name, V.by(0.5, V.add(places[(body.rods[0] || [0])[0]], places[(body.rods[0] || [0, 0])[1] || 0])), b]);
  });
  scene.joints.forEach(joint => {
    const spot = side => { const [body, p] = joint.sides[side]; if (body === null) return p; const k = scene.bodies[body].places.findIndex(q => V.norm(V.sub(p, q)) < 1e-9); return k < 0 ? moved(when, scene.bodies[body], p) : shape[body].places[k]; };
    const [parent, child] = [spot(0), spot(1)], [body] = joint.sides[0];
    const axis = joint.axis && V.unit(body === null ? joint.axis : turned(when, scene.bodies[body], joint.axis));
    if (joint.look === "ball") gpu.ball(child, 1.25 * knob, colours.soft);
    if (axis && joint.look !== "rigid") {
      const long = joint.look === "pin" || joint.look === "short" ? 1.7 * knob : 4 * knob;
      const draw = joint.look === "slider" ? gpu.box : gpu.rod;
      draw(V.add(parent, V.by(-long, axis)), V.add(parent, V.by(long, axis)), 1.1 * knob, colours.soft);
      if (joint.clearance) gpu.rod(V.add(child, V.by(-1.35 * long, axis)), V.add(child, V.by(1.35 * long, axis)), 0.6 * knob, colours.ink);
    }
    if (body === null || joint.sides[1][0] === null) {
      const ground = body === null ? parent : child, foot = V.add(ground, V.by(-3.2 * knob, up));
      gpu.cone(foot, ground, 1.9 * knob, colours.soft);
      gpu.box(V.add(foot, V.by(-0.5 * knob, up)), foot, 2.3 * knob, colours.soft);
    }
    if (show.forces && joint.force !== undefined && force_most > 0) {
      const force = vector_at(when, joint.force), long = 0.3 * size * V.norm(force) / force_most;
      if (long > 0.01 * size) {
        const d = V.unit(force), tip = V.add(child, V.by(long, d)), neck = V.add(child, V.by(long - Math.min(0.035 * size, 0.5 * long), d));
        gpu.rod(child, neck, 0.0035 * size, colours.force);
        gpu.cone(neck, tip, 0.011 * size, colours.force);
      }
    }
    if (show.names) labels.push([joint.name, child, -1]);
  });
  place_labels(labels, lens.rows);
}
const spans = [];
function place_labels(labels, rows) {
  const [w, h] = [canvas.clientWidth, canvas.clientHeight];
  labels.forEach(([text, p, body], k) => {
    const span = spans[k] || (spans[k] = canvas.parentNode.appendChild(document.createElement("span")));
    const c = rows.map(r => r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]);
    span.textContent = text;
    span.style.color = body < 0 ? "var(--ink)" : `var(--c${body % 8})`;
    span.style.transform = `translate(${(0.5 + 0.5 * c[0] / c[3]) * w + 8}px,${(0.5 - 0.5 * c[1] / c[3]) * h - 20}px)`;
  });
  spans.forEach((span, k) => { span.hidden = k >= labels.length; });
}

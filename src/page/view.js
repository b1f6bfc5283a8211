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

// What is seen at an instant stands in arrays that are made once: poses, and places of every body.
// Straight parts that a flexible body is drawn by, between two of its nodes.
const BENDS = 6;
for (const body of scene.bodies) {
  body.now = new Float64Array(12);
  body.at = new Float64Array(3 * body.places.length);
  body.shift = new Float64Array(3 * body.places.length);
  body.amplitude = new Float64Array(body.modes.length);
  body.curve = body.line.length ? new Float64Array(3 * (BENDS * (body.line.length - 1) + 1)) : null;
  body.end_shift = body.line.length ? [body.line[0].at, body.line[body.line.length - 1].at].map(p => body.places.findIndex(q => V.norm(V.sub(p, q)) < 1e-9)) : null;
}
const same_place = (body, p) => scene.bodies[body].places.findIndex(q => V.norm(V.sub(p, q)) < 1e-9);
for (const joint of scene.joints) {
  joint.ends = joint.sides.map(([body, p]) => ({ body: body === null ? null : scene.bodies[body], p, place: body === null ? -1 : same_place(body, p), at: Float64Array.from(p) }));
  joint.along = joint.axis && Float64Array.from(V.unit(joint.axis));
}
// Moves p by a pose.
const carry = (m, x, y, z, to, at) => {
  to[at] = m[0] * x + m[1] * y + m[2] * z + m[9];
  to[at + 1] = m[3] * x + m[4] * y + m[5] * z + m[10];
  to[at + 2] = m[6] * x + m[7] * y + m[8] * z + m[11];
};
const D = new Float64Array(3), E = new Float64Array(3), S = new Float64Array(3), T = new Float64Array(3);
// Displacement by the modes, into `to`.
const sum_modes = (body, list, to) => {
  to[0] = to[1] = to[2] = 0;
  for (let k = 0; k < list.length; k++) { const a = body.amplitude[k], v = list[k]; to[0] += a * v[0]; to[1] += a * v[1]; to[2] += a * v[2]; }
};
// With deflection and clearance made larger.
function figure(when, bend, gap) {
  for (const body of scene.bodies) {
    for (let k = 0; k < 12; k++) body.now[k] = value_at(when, body.pose + k);
    for (let k = 0; k < body.modes.length; k++) body.amplitude[k] = value_at(when, body.modes[k]);
    body.shift.fill(0);
  }
  for (const joint of scene.joints) {
    if (!joint.clearance || gap <= 1) continue;
    const [parent, child] = joint.ends;
    if (!child.body || child.place < 0) continue;
    D.set(parent.p);
    if (parent.body) carry(parent.body.now, parent.p[0], parent.p[1], parent.p[2], D, 0);
    carry(child.body.now, child.p[0], child.p[1], child.p[2], E, 0);
    for (let i = 0; i < 3; i++) child.body.shift[3 * child.place + i] = (gap - 1) * (E[i] - D[i]);
  }
  for (const body of scene.bodies) {
    for (let k = 0; k < body.places.length; k++) {
      const p = body.places[k], node = body.node[k];
      if (node < 0) D.fill(0); else sum_modes(body, body.line[node].shape, D);
      carry(body.now, p[0] + bend * D[0], p[1] + bend * D[1], p[2] + bend * D[2], body.at, 3 * k);
      for (let i = 0; i < 3; i++) body.at[3 * k + i] += body.shift[3 * k + i];
    }
    if (!body.curve) continue;
    const last = body.curve.length / 3 - 1, [from, to] = body.end_shift;
    let at = 0;
    for (let k = 0; k + 1 < body.line.length; k++) {
      const a = body.line[k], b = body.line[k + 1], l = Math.hypot(b.at[0] - a.at[0], b.at[1] - a.at[1], b.at[2] - a.at[2]);
      sum_modes(body, a.shape, D); sum_modes(body, b.shape, E); sum_modes(body, a.slope, S); sum_modes(body, b.slope, T);
      for (let j = k ? 1 : 0; j <= BENDS; j++) {
        const x = j / BENDS, y = 1 - x, h0 = y * y * (1 + 2 * x), h1 = x * x * (3 - 2 * x), g0 = l * x * y * y, g1 = -l * x * x * y, part = at / last;
        const q = i => a.at[i] + x * (b.at[i] - a.at[i]) + bend * (h0 * D[i] + h1 * E[i] + g0 * S[i] + g1 * T[i]);
        carry(body.now, q(0), q(1), q(2), body.curve, 3 * at);
        for (let i = 0; i < 3; i++) body.curve[3 * at + i] += (1 - part) * (from < 0 ? 0 : body.shift[3 * from + i]) + part * (to < 0 ? 0 : body.shift[3 * to + i]);
        at++;
      }
    }
  }
  for (const joint of scene.joints) {
    for (const end of joint.ends) {
      if (!end.body) continue;
      if (end.place < 0) carry(end.body.now, end.p[0], end.p[1], end.p[2], end.at, 0);
      else for (let i = 0; i < 3; i++) end.at[i] = end.body.at[3 * end.place + i];
    }
    const body = joint.ends[0].body;
    if (joint.axis && body) {
      const m = body.now, a = joint.axis, [x, y, z] = [m[0] * a[0] + m[1] * a[1] + m[2] * a[2], m[3] * a[0] + m[4] * a[1] + m[5] * a[2], m[6] * a[0] + m[7] * a[1] + m[8] * a[2]], n = Math.hypot(x, y, z) || 1;
      joint.along[0] = x / n; joint.along[1] = y / n; joint.along[2] = z / n;
    }
  }
}

// Wheels, belts, springs and cables: where they are at an instant.
const circles = scene.circles || [], belts = scene.belts || [], links = scene.links || [];
for (const circle of circles) {
  [circle.first] = across(V.unit(circle.axis));
  Object.assign(circle, { now: new Float64Array(3), along: new Float64Array(3), x: new Float64Array(3), y: new Float64Array(3), belt: false });
}
belts.forEach(belt => belt.circles.forEach(at => { circles[at].belt = true; }));
// Teeth of all wheels are as far apart.
const pitch = Math.min(...circles.map(circle => circle.radius)) * Math.PI / 7;
for (const link of links) link.ends = link.sides.map(([body, p]) => ({ body: body === null ? null : scene.bodies[body], p, at: Float64Array.from(p) }));
const turned = (m, d, to) => { for (let i = 0; i < 3; i++) to[i] = m[3 * i] * d[0] + m[3 * i + 1] * d[1] + m[3 * i + 2] * d[2]; };
function figure_parts() {
  for (const circle of circles) {
    const m = scene.bodies[circle.body].now, { along, x, y, now } = circle;
    carry(m, circle.centre[0], circle.centre[1], circle.centre[2], now, 0);
    turned(m, circle.axis, along);
    turned(m, circle.first, x);
    y[0] = along[1] * x[2] - along[2] * x[1]; y[1] = along[2] * x[0] - along[0] * x[2]; y[2] = along[0] * x[1] - along[1] * x[0];
  }
  for (const link of links) for (const end of link.ends) if (end.body) carry(end.body.now, end.p[0], end.p[1], end.p[2], end.at, 0);
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
scene.joints.concat(links).forEach(part => part.sides.forEach(([body, p]) => body === null && include(p)));
for (const circle of circles) {
  const [x, y] = across(V.unit(circle.axis));
  for (const d of [x, y, V.by(-1, x), V.by(-1, y)]) include(moved([0, 0], scene.bodies[circle.body], V.add(circle.centre, V.by(circle.radius, d))));
}
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
  return gpu.lines(list, true);
})();
const traces = scene.traces.map(name => {
  const column = index.get(name + ".x");
  if (column === undefined || !gpu) return null;
  const list = [], stride = Math.max(1, Math.floor(times.length / 720));
  for (let row = 0; row < times.length; row += stride) list.push(vector_at([row, 0], column));
  list.push(vector_at([times.length - 1, 0], column));
  return gpu.lines(list);
});

// A place beside a wheel's centre: so far out at an angle, so far along its axis.
const beside = (circle, out, angle, off, to) => {
  const c = out * Math.cos(angle), s = out * Math.sin(angle);
  for (let i = 0; i < 3; i++) to[i] = circle.now[i] + c * circle.x[i] + s * circle.y[i] + off * circle.along[i];
};
// Straight parts of a belt, as wheels.rs has them.
const straight = (belt, side, from, to) => {
  const [a, b] = belt.circles.map(at => circles[at]), n = a.along, gap = V.sub(b.now, a.now), apart = V.sub(gap, V.by(V.dot(n, gap), n));
  const far = V.norm(apart), sign = belt.crossed ? -1 : 1, sine = (a.radius - sign * b.radius) / far, cosine = side * Math.sqrt(1 - sine * sine);
  if (!(Math.abs(cosine) > 0)) return false;
  const along = V.by(1 / far, apart), wide = V.cross(n, along), normal = V.add(V.by(sine, along), V.by(cosine, wide));
  for (let i = 0; i < 3; i++) { from[i] = a.now[i] + a.radius * normal[i]; to[i] = b.now[i] + sign * b.radius * normal[i]; }
  return true;
};
const COILS = 6, BEADS = 9;
function paint_parts(put, { disc, thin, box }) {
  figure_parts();
  const segment = (shape, a, b, r, colour) => put(shape, a[0], a[1], a[2], b[0], b[1], b[2], r, colour);
  for (const circle of circles) {
    const { radius, hollow } = circle, colour = colours.bodies[circle.body % 8], half = Math.min(0.12 * radius, 0.6 * knob), teeth = Math.min(72, Math.round(2 * Math.PI * radius / pitch));
    const high = Math.min(0.25 * pitch, 0.1 * radius);
    if (hollow) {
      for (let k = 0; k < 48; k++) {
        beside(circle, radius + 2.2 * high, k * Math.PI / 24, 0, D);
        beside(circle, radius + 2.2 * high, (k + 1) * Math.PI / 24, 0, E);
        segment(thin, D, E, 1.4 * high, colour);
      }
    } else {
      beside(circle, 0, 0, -half, D);
      beside(circle, 0, 0, half, E);
      segment(disc, D, E, circle.belt ? radius : radius - 0.6 * high, colour);
    }
    if (!circle.belt) for (let k = 0; k < teeth; k++) {
      const angle = (k + (hollow ? 0.5 : 0)) * 2 * Math.PI / teeth;
      beside(circle, radius - high, angle, 0, D);
      beside(circle, radius + high, angle, 0, E);
      segment(box, D, E, Math.min(1.2 * half, 0.28 * pitch), colour);
    }
    // A mark that turns with it.
    if (!hollow) {
      for (const side of [-1, 1]) {
        beside(circle, 0.25 * radius, 0, side * half, D);
        beside(circle, 0.8 * radius, 0, side * half, E);
        segment(thin, D, E, 0.06 * radius, colours.soft);
      }
    }
  }
  for (const belt of belts) for (const side of [-1, 1]) if (straight(belt, side, D, E)) segment(thin, D, E, 0.3 * knob, colours.ink);
  for (const { coiled, ends } of links) {
    const [a, b] = [ends[0].at, ends[1].at];
    if (!coiled) { segment(thin, a, b, 0.22 * knob, colours.ink); continue; }
    const d = V.sub(b, a), n = V.norm(d), [x, y] = across(n > 0 ? V.by(1 / n, d) : [0, 0, 1]), wide = Math.min(1.3 * knob, 0.2 * n);
    const coil = (k, to) => {
      const part = Math.max(0, Math.min(1, k / (COILS * BEADS))), angle = 2 * Math.PI * k / BEADS;
      for (let i = 0; i < 3; i++) to[i] = a[i] + (0.15 + 0.7 * part) * d[i] + wide * (Math.cos(angle) * x[i] + Math.sin(angle) * y[i]);
    };
    for (let k = 0; k < COILS * BEADS; k++) { coil(k, D); coil(k + 1, E); segment(thin, D, E, 0.22 * knob, colours.ink); }
    coil(0, D); segment(thin, a, D, 0.22 * knob, colours.ink);
    coil(COILS * BEADS, D); segment(thin, D, b, 0.22 * knob, colours.ink);
  }
}

const F = new Float64Array(3);
function paint(when, bend, gap, show) {
  const lens = projection(canvas.width / canvas.height), labels = show.names ? [] : null, { rod, thin, box, cone } = gpu.meshes, put = gpu.put, few = scene.bodies.length > 20;
  const along = (shape, p, d, from, to, r, colour) => put(shape, p[0] + from * d[0], p[1] + from * d[1], p[2] + from * d[2], p[0] + to * d[0], p[1] + to * d[1], p[2] + to * d[2], r, colour);
  figure(when, bend, gap);
  gpu.begin();
  if (grid) grid.colour = colours.line;
  traces.forEach((trace, k) => { if (trace) trace.colour = show.traces ? colours.bodies[(k + 3) % 8] : null; });
  scene.bodies.forEach((body, b) => {
    const { at, curve, rods } = body, colour = colours.bodies[b % 8], r = thick(body), shape = body.square ? box : few ? thin : rod, wide = body.square ? r * Math.SQRT2 : r;
    if (curve) {
      for (let k = 0; k + 3 < curve.length; k += 3) put(thin, curve[k], curve[k + 1], curve[k + 2], curve[k + 3], curve[k + 4], curve[k + 5], r, colour);
      const end = curve.length - 3;
      gpu.ball(curve[0], curve[1], curve[2], r, colour);
      gpu.ball(curve[end], curve[end + 1], curve[end + 2], r, colour);
    }
    for (let k = curve ? 1 : 0; k < rods.length; k++) {
      const p = 3 * rods[k][0], q = 3 * rods[k][1];
      put(shape, at[p], at[p + 1], at[p + 2], at[q], at[q + 1], at[q + 2], wide, colour);
    }
    if (!rods.length && at.length) gpu.ball(at[0], at[1], at[2], 2 * r, colour);
    if (labels && at.length) { const [p, q] = rods[0] || [0, 0]; labels.push([body.name, [0, 1, 2].map(i => 0.5 * (at[3 * p + i] + at[3 * q + i])), b]); }
  });
  paint_parts(put, gpu.meshes);
  for (const joint of scene.joints) {
    const [parent, child] = [joint.ends[0].at, joint.ends[1].at];
    if (joint.look === "strut") {
      put(few ? thin : rod, parent[0], parent[1], parent[2], child[0], child[1], child[2], 0.6 * knob, colours.soft);
      for (const end of [parent, child]) gpu.ball(end[0], end[1], end[2], knob, colours.soft);
    }
    if (joint.look === "ball") gpu.ball(child[0], child[1], child[2], 1.25 * knob, colours.soft);
    if (joint.axis && joint.look !== "rigid") {
      const d = joint.along, long = joint.look === "pin" || joint.look === "short" ? 1.7 * knob : 4 * knob, slides = joint.look === "slider";
      along(slides ? box : few ? thin : rod, parent, d, -long, long, slides ? 1.1 * knob * Math.SQRT2 : 1.1 * knob, colours.soft);
      if (joint.clearance) along(few ? thin : rod, child, d, -1.35 * long, 1.35 * long, 0.6 * knob, colours.ink);
    }
    if (!joint.ends[0].body || !joint.ends[1].body) {
      const ground = joint.ends[0].body ? child : parent;
      along(cone, ground, up, -3.2 * knob, 0, 1.9 * knob, colours.soft);
      along(box, ground, up, -3.7 * knob, -3.2 * knob, 2.3 * knob * Math.SQRT2, colours.soft);
    }
    if (show.forces && joint.force !== undefined && force_most > 0) {
      for (let i = 0; i < 3; i++) F[i] = value_at(when, joint.force + i);
      const size_of = Math.hypot(F[0], F[1], F[2]), long = 0.3 * size * size_of / force_most;
      if (long > 0.01 * size) {
        for (let i = 0; i < 3; i++) F[i] /= size_of;
        const neck = long - Math.min(0.035 * size, 0.5 * long);
        along(thin, child, F, 0, neck, 0.0035 * size, colours.force);
        along(cone, child, F, neck, long, 0.011 * size, colours.force);
      }
    }
    if (labels) labels.push([joint.name, child, -1]);
  }
  gpu.end(lens.matrix, lens.light, colours.paper);
  if (labels || spans.length) place_labels(labels || [], lens.rows);
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

// Solids by WebGL: rods, balls, boxes, cones, lines. Knows numbers in metres and colours, no mechanism.
const V = {
  add: (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]],
  sub: (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  by: (k, a) => [k * a[0], k * a[1], k * a[2]],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  norm: a => Math.hypot(a[0], a[1], a[2]),
  unit: a => { const n = V.norm(a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; },
};
// Two directions across z.
const across = z => {
  const helper = Math.abs(z[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0];
  const x = V.unit(V.cross(helper, z));
  return [x, V.cross(z, x)];
};

function solids(canvas) {
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  const shader = (kind, text) => {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `attribute vec3 p; attribute vec3 n; uniform mat4 camera; uniform mat4 model;
uniform mat3 turn; varying vec3 normal; void main() { normal = turn * n; gl_Position = camera * (model * vec4(p, 1.0)); }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `precision mediump float; varying vec3 normal; uniform vec4 colour; uniform vec3 light;
uniform float flat_; void main() { float d = 0.55 + 0.45 * max(dot(normalize(normal), light), 0.0) + 0.12 * max(dot(normalize(normal), -light), 0.0);
gl_FragColor = vec4(colour.rgb * mix(d, 1.0, flat_), colour.a); }`));
  gl.bindAttribLocation(program, 0, "p");
  gl.bindAttribLocation(program, 1, "n");
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = {};
  for (const name of ["camera", "model", "turn", "colour", "light", "flat_"]) at[name] = gl.getUniformLocation(program, name);

  const mesh = triangles => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(triangles.flat()), gl.STATIC_DRAW);
    return { buffer, count: triangles.length };
  };
  // From z = 0 to 1, of radius 1 and `top`.
  const frustum = (sides, top, smooth) => {
    const list = [], ring = k => [Math.cos(2 * Math.PI * (k + 0.5) / sides), Math.sin(2 * Math.PI * (k + 0.5) / sides)];
    for (let k = 0; k < sides; k++) {
      const [a, b] = [ring(k), ring(k + 1)], m = V.unit([a[0] + b[0], a[1] + b[1], 0]);
      const n = v => (smooth ? [v[0], v[1], 1 - top] : [m[0], m[1], 1 - top]);
      const q = [[a, 0], [b, 0], [b, 1], [a, 0], [b, 1], [a, 1]];
      for (const [v, z] of q) { const r = z ? top : 1; list.push([v[0] * r, v[1] * r, z, ...n(v)]); }
      for (const [z, r, s] of [[0, 1, -1], [1, top, 1]])
        for (const v of [[0, 0], s > 0 ? a : b, s > 0 ? b : a]) list.push([v[0] * r, v[1] * r, z, 0, 0, s]);
    }
    return mesh(list);
  };
  const sphere = () => {
    const list = [], A = 16, B = 9;
    const point = (i, j) => {
      const [u, v] = [2 * Math.PI * i / A, Math.PI * j / B];
      return [Math.sin(v) * Math.cos(u), Math.sin(v) * Math.sin(u), Math.cos(v)];
    };
    for (let i = 0; i < A; i++) for (let j = 0; j < B; j++)
      for (const [k, l] of [[i, j], [i, j + 1], [i + 1, j + 1], [i, j], [i + 1, j + 1], [i + 1, j]]) { const p = point(k, l); list.push([...p, ...p]); }
    return mesh(list);
  };
  const meshes = { rod: frustum(14, 1, true), box: frustum(4, 1, false), cone: frustum(14, 0, true), ball: sphere() };
  const use = buffer => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 24, 0);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 24, 12);
  };
  const identity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  const draw = (name, x, y, z, from, colour) => {
    const shape = meshes[name];
    use(shape.buffer);
    gl.uniformMatrix4fv(at.model, false, new Float32Array([...x, 0, ...y, 0, ...z, 0, ...from, 1]));
    // Axes are at right angles: their directions turn normals, though not all are as long.
    const [a, b, c] = [x, y, z].map(V.unit);
    gl.uniformMatrix3fv(at.turn, false, new Float32Array([...a, ...b, ...c]));
    gl.uniform4fv(at.colour, colour);
    gl.uniform1f(at.flat_, 0);
    gl.drawArrays(gl.TRIANGLES, 0, shape.count);
  };
  const between = (name, p, q, radius, colour) => {
    const z = V.sub(q, p);
    if (!(V.norm(z) > 0)) return;
    const [x, y] = across(V.unit(z));
    draw(name, V.by(radius, x), V.by(radius, y), z, p, colour);
  };
  return {
    rod: (p, q, r, colour) => between("rod", p, q, r, colour),
    box: (p, q, r, colour) => between("box", p, q, r * Math.SQRT2, colour),
    cone: (p, q, r, colour) => between("cone", p, q, r, colour),
    ball: (p, r, colour) => draw("ball", [r, 0, 0], [0, r, 0], [0, 0, r], p, colour),
    lines(points) {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points.flatMap(p => [...p, 0, 0, 1])), gl.STATIC_DRAW);
      return (colour, mode) => {
        use(buffer);
        gl.uniformMatrix4fv(at.model, false, identity);
        gl.uniform4fv(at.colour, colour);
        gl.uniform1f(at.flat_, 1);
        gl.drawArrays(mode === "pairs" ? gl.LINES : gl.LINE_STRIP, 0, points.length);
      };
    },
    begin(camera, light, paper) {
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(...paper);
      gl.enable(gl.DEPTH_TEST);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.uniformMatrix4fv(at.camera, false, new Float32Array(camera));
      gl.uniform3fv(at.light, light);
    },
  };
}

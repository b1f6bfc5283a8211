// Solids by WebGL: rods, balls, boxes, cones, lines. Knows numbers in metres and colours, no mechanism. All solids of one shape are one
// draw call: where they are stands in a list that is filled anew for each picture and never allocated.
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
  // Software that draws triangles pays four times for smooth edges: there a standing picture is drawn finer instead.
  const software = (() => {
    const gl = document.createElement("canvas").getContext("webgl"), info = gl && gl.getExtension("WEBGL_debug_renderer_info");
    const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
    if (gl && gl.getExtension("WEBGL_lose_context")) gl.getExtension("WEBGL_lose_context").loseContext();
    return /swiftshader|llvmpipe|software|basic render/i.test(name);
  })();
  const asked = { antialias: !software, alpha: false, powerPreference: "high-performance" };
  const gl = canvas.getContext("webgl2", asked) || canvas.getContext("webgl", asked);
  if (!gl) return null;
  const many = gl.drawArraysInstanced
    ? { divisor: (at, n) => gl.vertexAttribDivisor(at, n), draw: (...all) => gl.drawArraysInstanced(...all) }
    : (extension => extension && { divisor: (at, n) => extension.vertexAttribDivisorANGLE(at, n), draw: (...all) => extension.drawArraysInstancedANGLE(...all) })(gl.getExtension("ANGLE_instanced_arrays"));
  if (!many) return null;
  const shader = (kind, text) => {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  const program = (vertex, fragment, attributes, uniforms) => {
    const made = gl.createProgram(), at = {};
    gl.attachShader(made, shader(gl.VERTEX_SHADER, vertex));
    gl.attachShader(made, shader(gl.FRAGMENT_SHADER, fragment));
    attributes.forEach((name, k) => gl.bindAttribLocation(made, k, name));
    gl.linkProgram(made);
    uniforms.forEach(name => { at[name] = gl.getUniformLocation(made, name); });
    return { made, at };
  };
  // A shape stands along z from 0 to 1; its instance says from where to where, how thick, in which colour.
  const solid = program(`attribute vec3 p; attribute vec3 n; attribute vec3 a; attribute vec4 b; attribute vec3 c; uniform mat4 camera; uniform vec3 light; varying vec3 colour;
void main() { vec3 d = b.xyz - a; vec3 z = normalize(d); vec3 x = normalize(cross(abs(z.x) < 0.8 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), z)); vec3 y = cross(z, x);
vec3 m = normalize(n.x * x + n.y * y + n.z * z); float s = dot(m, light); colour = c * (0.55 + 0.45 * max(s, 0.0) + 0.12 * max(-s, 0.0));
gl_Position = camera * vec4(a + p.z * d + b.w * (p.x * x + p.y * y), 1.0); }`, "precision mediump float; varying vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }", ["p", "n", "a", "b", "c"], ["camera", "light"]);
  const line = program("attribute vec3 p; uniform mat4 camera; void main() { gl_Position = camera * vec4(p, 1.0); }",
    "precision mediump float; uniform vec4 colour; void main() { gl_FragColor = colour; }", ["p"], ["camera", "colour"]);

  const mesh = vertices => {
    const made = { count: vertices.length, vertices: gl.createBuffer(), places: gl.createBuffer(), list: new Float32Array(10 * 64), used: 0, room: 0 };
    gl.bindBuffer(gl.ARRAY_BUFFER, made.vertices);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices.flat()), gl.STATIC_DRAW);
    return made;
  };
  // From z = 0 to 1, of radius 1 and `top`.
  const frustum = (sides, top, smooth) => {
    const list = [], ring = k => [Math.cos(2 * Math.PI * (k + 0.5) / sides), Math.sin(2 * Math.PI * (k + 0.5) / sides)];
    for (let k = 0; k < sides; k++) {
      const [a, b] = [ring(k), ring(k + 1)], m = V.unit([a[0] + b[0], a[1] + b[1], 0]);
      const n = v => (smooth ? [v[0], v[1], 1 - top] : [m[0], m[1], 1 - top]);
      const sides_of = top ? [[a, 0], [b, 0], [b, 1], [a, 0], [b, 1], [a, 1]] : [[a, 0], [b, 0], [b, 1]];
      for (const [v, z] of sides_of) { const r = z ? top : 1; list.push([v[0] * r, v[1] * r, z, ...n(v)]); }
      for (const [z, r, s] of top ? [[0, 1, -1], [1, top, 1]] : [[0, 1, -1]])
        for (const v of [[0, 0], s > 0 ? a : b, s > 0 ? b : a]) list.push([v[0] * r, v[1] * r, z, 0, 0, s]);
    }
    return mesh(list);
  };
  const sphere = (A, B) => {
    const list = [];
    const point = (i, j) => {
      const [u, v] = [2 * Math.PI * i / A, Math.PI * j / B];
      return [Math.sin(v) * Math.cos(u), Math.sin(v) * Math.sin(u), Math.cos(v)];
    };
    for (let i = 0; i < A; i++) for (let j = 0; j < B; j++) {
      const quad = [[i, j], [i, j + 1], [i + 1, j + 1], [i, j], [i + 1, j + 1], [i + 1, j]];
      for (const [k, l] of j === 0 ? quad.slice(0, 3) : j === B - 1 ? [quad[0], quad[1], quad[5]] : quad) { const p = point(k, l); list.push([...p, ...p]); }
    }
    return mesh(list);
  };
  // What is drawn small has few sides.
  const meshes = { rod: frustum(12, 1, true), thin: frustum(7, 1, true), box: frustum(4, 1, false), cone: frustum(10, 0, true), ball: sphere(12, 7), disc: frustum(40, 1, true) };
  const put = (to, ax, ay, az, bx, by, bz, r, colour) => {
    if (ax === bx && ay === by && az === bz) return;
    let at = 10 * to.used++;
    if (at + 10 > to.list.length) { const list = new Float32Array(2 * to.list.length); list.set(to.list); to.list = list; }
    const list = to.list;
    list[at++] = ax; list[at++] = ay; list[at++] = az; list[at++] = bx; list[at++] = by; list[at++] = bz; list[at++] = r;
    list[at++] = colour[0]; list[at++] = colour[1]; list[at] = colour[2];
  };
  const matrix = new Float32Array(16);
  const lines = [];
  return {
    software,
    rod: (...all) => put(meshes.rod, ...all),
    put, meshes,
    ball: (x, y, z, r, colour) => put(meshes.ball, x, y, z, x, y, z + r, r, colour),
    // Points of lines: strips, or pairs.
    lines(points, pairs) {
      const buffer = gl.createBuffer(), made = { buffer, count: points.length, mode: pairs ? gl.LINES : gl.LINE_STRIP, colour: null };
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points.flat()), gl.STATIC_DRAW);
      lines.push(made);
      return made;
    },
    begin() { for (const name in meshes) meshes[name].used = 0; },
    // All that was put since `begin`, and the lines that have a colour.
    end(camera, light, paper) {
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(paper[0], paper[1], paper[2], 1);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.CULL_FACE);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      matrix.set(camera);
      gl.useProgram(line.made);
      gl.uniformMatrix4fv(line.at.camera, false, matrix);
      gl.enableVertexAttribArray(0);
      for (let k = 1; k < 5; k++) gl.disableVertexAttribArray(k);
      for (const { buffer, count, mode, colour } of lines) {
        if (!colour) continue;
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
        gl.uniform4fv(line.at.colour, colour);
        gl.drawArrays(mode, 0, count);
      }
      gl.useProgram(solid.made);
      gl.uniformMatrix4fv(solid.at.camera, false, matrix);
      gl.uniform3fv(solid.at.light, light);
      for (let k = 0; k < 5; k++) { gl.enableVertexAttribArray(k); many.divisor(k, k > 1 ? 1 : 0); }
      for (const name in meshes) {
        const shape = meshes[name];
        if (!shape.used) continue;
        gl.bindBuffer(gl.ARRAY_BUFFER, shape.vertices);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 24, 0);
        gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 24, 12);
        gl.bindBuffer(gl.ARRAY_BUFFER, shape.places);
        if (shape.room !== shape.list.length) { shape.room = shape.list.length; gl.bufferData(gl.ARRAY_BUFFER, 4 * shape.room, gl.DYNAMIC_DRAW); }
        gl.bufferSubData(gl.ARRAY_BUFFER, 0, shape.list.subarray(0, 10 * shape.used));
        gl.vertexAttribPointer(2, 3, gl.FLOAT, false, 40, 0);
        gl.vertexAttribPointer(3, 4, gl.FLOAT, false, 40, 12);
        gl.vertexAttribPointer(4, 3, gl.FLOAT, false, 40, 28);
        many.draw(gl.TRIANGLES, 0, shape.count, shape.used);
      }
    },
  };
}

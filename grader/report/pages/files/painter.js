"use strict";
/* Draws solids with WebGL: opaque ones, then edges, then transparent ones from back to front, then what is seen through everything. */
const VERTEX = `
attribute vec3 position; attribute vec3 normal; attribute float side;
uniform mat4 view; uniform mat4 model; uniform vec3 size; uniform vec2 pixel;
varying vec3 at; varying vec3 out_normal;
void main() {
  at = position;
  out_normal = side == 0.0 ? normalize(mat3(model) * (normal / size)) : vec3(0.0);
  gl_Position = view * (model * vec4(position * size, 1.0));
  if (side != 0.0) {
    vec4 other = view * (model * vec4(normal * size, 1.0));
    vec2 way = (other.xy / other.w - gl_Position.xy / gl_Position.w) / pixel;
    vec2 across = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0);
    gl_Position.xy += across * side * pixel * gl_Position.w;
  }
}`;
const FRAGMENT = `
precision mediump float;
uniform vec4 rgba; uniform float spokes; uniform vec3 toward;
varying vec3 at; varying vec3 out_normal;
void main() {
  vec3 colour = rgba.rgb;
  if (spokes > 0.0) {
    float angle = atan(at.y, at.x);
    float sector = step(0.0, sin(angle * 3.0)) * step(0.25, length(at.xy)) * step(length(at.xy), 0.97);
    float tip = step(abs(angle), 0.2) * step(0.25, length(at.xy));
    float light = dot(colour, vec3(0.3, 0.6, 0.1)) > 0.5 ? 0.0 : 1.0;
    colour = mix(colour, vec3(light), 0.2 * sector + 0.45 * tip);
  }
  float shade = length(out_normal) > 0.0 ? 0.62 + 0.28 * abs(dot(out_normal, toward)) + 0.14 * out_normal.z : 1.0;
  gl_FragColor = vec4(colour * shade, rgba.a);
}`;

const WIDTH = 1.3; // pixels of a line

function makePainter(canvas) {
  const gl = canvas.getContext("webgl", { alpha: false, antialias: true, preserveDrawingBuffer: false });
  if (!gl) return null;
  const solids = {}, program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  const place = Object.fromEntries(["view", "model", "size", "rgba", "spokes", "toward", "pixel"].map((name) => [name, gl.getUniformLocation(program, name)]));
  const slots = ["position", "normal", "side"].map((name) => gl.getAttribLocation(program, name));
  slots.forEach((slot) => gl.enableVertexAttribArray(slot));
  const make = { box: boxSolid, cylinder: cylinderSolid, sphere: sphereSolid, arrow: arrowSolid, cross: crossSolid, grid: gridSolid };
  for (const [name, solid] of Object.entries(make)) {
    solids[name] = Object.fromEntries(Object.entries(solid()).map(([part, numbers]) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
      return [part, { buffer, count: numbers.length / 7 }];
    }));
  }
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.polygonOffset(1, 1);

  function put(item, part, rgba, spokes = false) {
    const { buffer, count } = solids[item.kind][part];
    const [a, b, c, d, e, f, g, h, i, x, y, z] = item.pose;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    slots.forEach((slot, k) => gl.vertexAttribPointer(slot, k < 2 ? 3 : 1, gl.FLOAT, false, 28, 12 * k));
    gl.uniformMatrix4fv(place.model, false, [a, d, g, 0, b, e, h, 0, c, f, i, 0, x, y, z, 1]);
    gl.uniform3fv(place.size, item.size.map((value) => Math.max(value, 1e-9)));
    gl.uniform4fv(place.rgba, rgba);
    gl.uniform1f(place.spokes, spokes ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, count);
  }

  /* An item has kind, pose and size; rgba is the colour of its faces, `edge` of its edges. Seen through everything are edges with the
     colour `beneath`, edges and faces with the colour `through`, and faces with the colour `onTop`. */
  return function paint(items, camera, background, ratio) {
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...background, 1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(place.view, false, camera.matrix);
    gl.uniform3fv(place.toward, camera.toward);
    gl.uniform2f(place.pixel, (WIDTH * ratio) / canvas.width, (WIDTH * ratio) / canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    const far = (item) => item.pose.slice(9).reduce((sum, value, k) => sum + (value - camera.eye[k]) ** 2, 0);
    const clear = items.filter((item) => item.rgba && item.rgba[3] < 1).sort((one, other) => far(other) - far(one));
    items.filter((item) => item.rgba && item.rgba[3] >= 1).forEach((item) => put(item, "faces", item.rgba, item.spokes));
    gl.disable(gl.POLYGON_OFFSET_FILL);
    items.filter((item) => item.edge).forEach((item) => put(item, "edges", item.edge));
    gl.depthMask(false);
    clear.forEach((item) => put(item, "faces", item.rgba, item.spokes));
    gl.disable(gl.DEPTH_TEST);
    for (const item of items) {
      if (item.beneath) put(item, "edges", item.beneath);
      if (item.through) put(item, "faces", [...item.through.slice(0, 3), 0.16]);
      if (item.through) put(item, "edges", item.through);
      if (item.onTop) put(item, "faces", item.onTop);
    }
  };
}

"use strict";
/* A camera that looks at a point: azimuth and elevation in radians, distance in metres; the z axis points up. */
const FIELD = 0.42; // radians
const START = { azimuth: -1.05, elevation: 0.42, zoom: 1 };

function makeCamera({ centre, radius, fit }) {
  const camera = { azimuth: 0, elevation: 0, zoom: 1, target: [...centre] };
  const limit = (value, low, high) => Math.max(low, Math.min(high, value));

  camera.turn = (right, up) => {
    camera.azimuth += right;
    camera.elevation = limit(camera.elevation + up, -Math.PI / 2, Math.PI / 2);
  };
  camera.enlarge = (factor) => { camera.zoom = limit(camera.zoom * factor, 0.1, 30); };
  camera.basis = () => {
    const [ca, sa, ce, se] = [Math.cos(camera.azimuth), Math.sin(camera.azimuth), Math.cos(camera.elevation), Math.sin(camera.elevation)];
    return { right: [-sa, ca, 0], up: [-ca * se, -sa * se, ce], toward: [ca * ce, sa * ce, se] };
  };
  camera.distance = () => fit / Math.tan(FIELD / 2) / camera.zoom;
  camera.shift = (right, up, height) => {
    const { right: r, up: u } = camera.basis(), metres = (2 * camera.distance() * Math.tan(FIELD / 2)) / height;
    camera.target = camera.target.map((value, k) => value - metres * (right * r[k] - up * u[k]));
  };
  /* The matrix for WebGL, column by column, and where the eye is; `aspect` is width by height. */
  camera.seen = (aspect) => {
    const { right, up, toward } = camera.basis(), distance = camera.distance() * Math.max(1, 1 / aspect);
    const eye = camera.target.map((value, k) => value + distance * toward[k]);
    const near = Math.max(distance - 12 * radius, distance / 50), far = distance + 12 * radius;
    const s = 1 / Math.tan(FIELD / 2), dot = (a) => -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2]);
    const rows = [
      [...right, dot(right)].map((value) => (value * s) / aspect),
      [...up, dot(up)].map((value) => value * s),
      [...toward, dot(toward)].map((value) => (value * (far + near)) / (near - far)),
      [...toward, dot(toward)].map((value) => -value),
    ];
    rows[2][3] += (2 * far * near) / (near - far);
    return { matrix: [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column])), rows, eye, toward, right, up, aspect };
  };
  return camera;
}

/* Where a point is on the canvas, as shares of its width and height; null behind the eye. */
function projected({ rows }, [x, y, z]) {
  const [u, v, , w] = rows.map((row) => row[0] * x + row[1] * y + row[2] * z + row[3]);
  return w > 0 ? [0.5 + u / w / 2, 0.5 - v / w / 2] : null;
}

/* The direction in which the eye sees a place of the canvas. */
function sightline({ toward, right, up, aspect }, x, y) {
  const s = Math.tan(FIELD / 2), u = (2 * x - 1) * s * aspect, v = (1 - 2 * y) * s;
  return toward.map((value, k) => u * right[k] + v * up[k] - value);
}

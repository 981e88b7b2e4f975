"use strict";
// The shapes of a URDF, each as one of size 1 that is scaled: a box of edges 1, a cylinder of radius
// 1 and length 1 along z, a sphere of radius 1.

const CIRCLE = Array.from({ length: 48 }, (_, i) => {
  const angle = (2 * Math.PI * i) / 48;
  return [Math.cos(angle), Math.sin(angle)];
});

const Shapes = {
  /**
   * Return triangles as corners with normals, six numbers each. The triangles are about the origin,
   * and turned so that their corners are counter-clockwise from outside.
   * @param {Vector[][]} faces convex ones, each a list of corners
   * @param {(corner: Vector, middle: Vector) => Vector} normal
   * @returns {number[]}
   */
  triangles(faces, normal) {
    const numbers = [];
    for (const face of faces) {
      const middle = [0, 1, 2].map((k) => face.reduce((sum, p) => sum + p[k], 0) / face.length);
      for (let i = 2; i < face.length; i++) {
        const [a, b, c] = [face[0], face[i - 1], face[i]];
        const corners = Transforms.dot(Shapes.across(a, b, c), middle) < 0 ? [a, c, b] : [a, b, c];
        for (const corner of corners) {
          numbers.push(...corner, ...normal(corner, middle));
        }
      }
    }
    return numbers;
  },

  /** Return the direction across a triangle. @param {Vector} a @param {Vector} b @param {Vector} c */
  across(a, b, c) {
    const [x, y, z] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    const [u, v, w] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    return [y * w - z * v, z * u - x * w, x * v - y * u];
  },

  /** Return a box between two corners. @param {Vector} low @param {Vector} high */
  box(low, high) {
    const faces = [];
    const middle = low.map((value, k) => (value + high[k]) / 2);
    for (const axis of [0, 1, 2]) {
      for (const value of [low[axis], high[axis]]) {
        const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        const face = [];
        for (const [a, b] of [
          [low, low],
          [high, low],
          [high, high],
          [low, high],
        ]) {
          const corner = [0, 0, 0];
          corner[axis] = value;
          corner[u] = a[u];
          corner[v] = b[v];
          face.push(corner);
        }
        faces.push(face);
      }
    }
    return Shapes.triangles(faces, (_, at) => at.map((value, k) => value - middle[k]));
  },

  cylinder() {
    const faces = [-0.5, 0.5].map((z) => CIRCLE.map(([x, y]) => [x, y, z]));
    const caps = Shapes.triangles(faces, (_, [, , z]) => [0, 0, 2 * z]);
    const sides = CIRCLE.map(([a, b], i) => {
      const [c, d] = CIRCLE[(i + 1) % CIRCLE.length];
      return [
        [a, b, -0.5],
        [c, d, -0.5],
        [c, d, 0.5],
        [a, b, 0.5],
      ];
    });
    return [...caps, ...Shapes.triangles(sides, ([x, y]) => [x, y, 0])];
  },

  sphere() {
    const rings = 16;
    const at = (/** @type {number} */ i, /** @type {number} */ j) => {
      const [x, y] = CIRCLE[i % CIRCLE.length];
      const angle = (Math.PI * j) / rings;
      return [Math.sin(angle) * x, Math.sin(angle) * y, Math.cos(angle)];
    };
    const faces = [];
    for (let i = 0; i < CIRCLE.length; i += 2) {
      for (let j = 0; j < rings; j++) {
        faces.push([at(i, j), at(i, j + 1), at(i + 2, j + 1), at(i + 2, j)]);
      }
    }
    return Shapes.triangles(faces, (corner) => corner);
  },

  /** Return points of the frame whose hull is a shape. @param {Shape} shape @param {Pose} pose */
  points(shape, pose) {
    const [a, b, c] = shape.size;
    if (shape.kind === "sphere") {
      const centre = Transforms.apply(pose, [0, 0, 0]);
      const ends = [
        [a, 0, 0],
        [-a, 0, 0],
        [0, a, 0],
        [0, -a, 0],
        [0, 0, a],
        [0, 0, -a],
      ];
      return ends.map((end) => end.map((value, k) => value + centre[k]));
    }
    const corners = [
      [-0.5, -0.5],
      [-0.5, 0.5],
      [0.5, -0.5],
      [0.5, 0.5],
    ];
    const points = [];
    for (const [x, y] of shape.kind === "box" ? corners : CIRCLE) {
      for (const z of [-0.5, 0.5]) {
        points.push(Transforms.apply(pose, [x * a, y * b, z * c]));
      }
    }
    return points;
  },

  /**
   * Return how far along a ray a shape of size 1 is hit; Infinity if it is not.
   * @param {string} kind
   * @param {Vector} start in the frame of the shape
   * @param {Vector} direction
   */
  hit(kind, start, direction) {
    let [near, far] = [-Infinity, Infinity];
    const flat = { box: [0, 1, 2], cylinder: [2], sphere: [] }[kind] || [];
    const round = { box: [], cylinder: [0, 1], sphere: [0, 1, 2] }[kind] || [];
    for (const k of flat) {
      const ends = [(-0.5 - start[k]) / direction[k], (0.5 - start[k]) / direction[k]];
      near = Math.max(near, Math.min(...ends));
      far = Math.min(far, Math.max(...ends));
    }
    if (round.length) {
      const sum = (/** @type {Vector} */ p, /** @type {Vector} */ q) =>
        round.reduce((total, k) => total + p[k] * q[k], 0);
      const a = Math.max(sum(direction, direction), 1e-12); // not 0 along the axis of a cylinder
      const [b, c] = [sum(start, direction), sum(start, start) - 1];
      const root = Math.sqrt(b * b - a * c);
      near = Math.max(near, (-b - root) / a);
      far = Math.min(far, (-b + root) / a);
    }
    return near <= far && far > 0 ? near : Infinity;
  },
};

"use strict";
// Rigid motions, as grader/base/transforms.py has them.

/** @typedef {number[]} Vector Three numbers. */
/** @typedef {number[]} Pose T_a_b, which maps points in b to a: 12 numbers, row by row, metres. */

const Transforms = {
  /** @type {Pose} */
  IDENTITY: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],

  /** Return T_a_c = T_a_b T_b_c. @param {Pose} a @param {Pose} b @returns {Pose} */
  product(a, b) {
    const result = new Array(12);
    for (let row = 0; row < 12; row += 4) {
      for (let column = 0; column < 4; column++) {
        const sum = a[row] * b[column] + a[row + 1] * b[4 + column] + a[row + 2] * b[8 + column];
        result[row + column] = column === 3 ? sum + a[row + 3] : sum;
      }
    }
    return result;
  },

  /** Return T_b_a. @param {Pose} a @returns {Pose} */
  inverse(a) {
    const [x, y, z] = Transforms.unrotate(a, [-a[3], -a[7], -a[11]]);
    return [a[0], a[4], a[8], x, a[1], a[5], a[9], y, a[2], a[6], a[10], z];
  },

  /** Return a point given in b in frame a. @param {Pose} a @param {Vector} point */
  apply(a, point) {
    const [x, y, z] = Transforms.rotate(a, point);
    return [x + a[3], y + a[7], z + a[11]];
  },

  /** Return a direction given in b in frame a. @param {Pose} a @param {Vector} direction */
  rotate(a, [x, y, z]) {
    return [
      a[0] * x + a[1] * y + a[2] * z,
      a[4] * x + a[5] * y + a[6] * z,
      a[8] * x + a[9] * y + a[10] * z,
    ];
  },

  /** Return a direction given in a in frame b. @param {Pose} a @param {Vector} direction */
  unrotate(a, [x, y, z]) {
    return [
      a[0] * x + a[4] * y + a[8] * z,
      a[1] * x + a[5] * y + a[9] * z,
      a[2] * x + a[6] * y + a[10] * z,
    ];
  },

  /** Return the rotation about a unit axis (Rodrigues). @param {Vector} axis @param {number} angle */
  about([x, y, z], angle) {
    const s = Math.sin(angle);
    const c = Math.cos(angle);
    const t = 1 - c;
    return [
      ...[t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0],
      ...[t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0],
      ...[t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0],
    ];
  },

  /** Return the motion along a unit axis. @param {Vector} axis @param {number} length */
  along([x, y, z], length) {
    return [1, 0, 0, x * length, 0, 1, 0, y * length, 0, 0, 1, z * length];
  },

  /** Return roll, pitch and yaw about fixed axes (rad). @param {Pose} a @returns {Vector} */
  rpy(a) {
    const flat = Math.hypot(a[0], a[4]);
    const pitch = Math.atan2(-a[8], flat);
    if (flat < 1e-9) {
      return [0, pitch, Math.atan2(-a[1], a[5])];
    }
    return [Math.atan2(a[9], a[10]), pitch, Math.atan2(a[4], a[0])];
  },

  /** Return the scalar product. @param {Vector} a @param {Vector} b */
  dot(a, b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  },
};

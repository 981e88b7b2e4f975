"use strict";
/* Forward kinematics as in grader/robot/frames.py. A pose is an array of 12 numbers: the rotation row by row, then the translation. */
const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

function apply(pose, [x, y, z]) {
  const [a, b, c, d, e, f, g, h, i, u, v, w] = pose;
  return [a * x + b * y + c * z + u, d * x + e * y + f * z + v, g * x + h * y + i * z + w];
}

function rotate(pose, [x, y, z]) {
  const [a, b, c, d, e, f, g, h, i] = pose;
  return [a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z];
}

function compose(one, other) {
  const [a, b, c, d, e, f, g, h, i] = one;
  const [j, k, l, m, n, o, p, q, r] = other;
  return [
    a * j + b * m + c * p, a * k + b * n + c * q, a * l + b * o + c * r,
    d * j + e * m + f * p, d * k + e * n + f * q, d * l + e * o + f * r,
    g * j + h * m + i * p, g * k + h * n + i * q, g * l + h * o + i * r,
    ...apply(one, other.slice(9)),
  ];
}

function inverse(pose) {
  const [a, b, c, d, e, f, g, h, i, x, y, z] = pose;
  return [a, d, g, b, e, h, c, f, i, -(a * x + d * y + g * z), -(b * x + e * y + h * z), -(c * x + f * y + i * z)];
}

/* An origin of the file: x, y, z, roll, pitch, yaw. */
function placed([x, y, z, roll, pitch, yaw]) {
  const sr = Math.sin(roll), cr = Math.cos(roll), sp = Math.sin(pitch), cp = Math.cos(pitch), sy = Math.sin(yaw), cy = Math.cos(yaw);
  return [
    cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
    sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
    -sp, cp * sr, cp * cr, x, y, z,
  ];
}

function turned([x, y, z], angle) {
  const s = Math.sin(angle), c = Math.cos(angle), t = 1 - c;
  return [
    t * x * x + c, t * x * y - s * z, t * x * z + s * y,
    t * x * y + s * z, t * y * y + c, t * y * z - s * x,
    t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0, 0, 0,
  ];
}

/* The position of a joint: its own, or 0; that of the joint which it mimics. `leader` is -1 for a joint that does not exist. */
function positionOf(robot, index, given) {
  const followers = [];
  let joint = robot.joints[index], value = 0;
  for (;;) {
    if (given.has(joint.name)) { value = given.get(joint.name); break; }
    if (joint.mimic === undefined) break;
    if (joint.mimic === null) { value = NaN; break; }
    if (followers.includes(joint)) return 0;
    followers.push(joint);
    if (joint.mimic[0] < 0) break;
    joint = robot.joints[joint.mimic[0]];
  }
  return followers.reverse().reduce((found, { mimic }) => mimic[1] * found + mimic[2], value);
}

function motionOf(joint, position) {
  if (!joint.type) return IDENTITY;
  if (!Number.isFinite(position)) return null;
  if (!joint.axis) return joint.axis === null && !position ? IDENTITY : null;
  if (!position) return IDENTITY;
  const [x, y, z] = joint.axis;
  if (joint.type === "prismatic") return [...IDENTITY.slice(0, 9), x * position, y * position, z * position];
  return turned(joint.axis, position);
}

/* T_frame_link of every link, null where it is undefined; `given` are positions in radians and metres by the names of joints. */
function posesOf(robot, given) {
  const found = new Array(robot.links.length).fill(null);
  for (const link of robot.order) {
    const joint = robot.joints[robot.parent[link]];
    if (!joint) { found[link] = [link, IDENTITY]; continue; }
    const [group, above] = found[joint.parent];
    const motion = motionOf(joint, positionOf(robot, robot.parent[link], given));
    const pose = joint.origin && motion ? compose(compose(above, placed(joint.origin)), motion) : [NaN];
    found[link] = pose.every(Number.isFinite) ? [group, pose] : [link, IDENTITY];
  }
  const frame = found[robot.frame];
  const into = inverse(frame[1]);
  return found.map((one) => (one && one[0] === frame[0] ? compose(into, one[1]) : null));
}

"use strict";
// How a robot comes to rest on the ground and then drives, as grader/report/drawing/drive.py has it.

/**
 * In the frame of the robot, in metres: the centre of mass, which moves straight down; for each pose
 * on the way where up is, and the height of the mass above the ground; the velocity of the mass
 * along x and y, and its rate of turning to the left, at 1 rad/s of the joints.
 * @typedef {{mass: Vector, fall: number[][], motion: number[], joints: string[],
 *   text: string}} DriveData
 */

const Drive = {
  SECONDS: 4, // in which it drives

  /** Return the shortest rotation that turns a direction upward. @param {number[]} up */
  upright([x, y, z]) {
    const flat = Math.hypot(x, y);
    return Transforms.about(flat ? [y / flat, -x / flat, 0] : [1, 0, 0], Math.atan2(flat, z));
  },

  /**
   * Return where the robot is after a time: its pose, by how much its wheels have turned (rad), and
   * whether it is there.
   * @param {DriveData} drive
   * @param {number} floor the height of the ground in the frame of the robot
   * @param {number} size of the robot, which drives some of its lengths
   * @param {number} seconds
   */
  after({ mass, fall, motion, joints }, floor, size, seconds) {
    let at = [0, 0, 1, mass[2] - floor];
    for (const next of fall) {
      const length = 0.3 + Math.acos(Math.min(1, Transforms.dot(at, next)));
      const part = Math.max(0, Math.min(1, seconds / length));
      at = at.map((value, k) => value + (next[k] - value) * part);
      seconds -= length;
    }
    const [x, y, turn] = motion;
    const reach = Math.min((1.5 * size) / Math.hypot(x, y), (2 * Math.PI) / Math.abs(turn), 60);
    const turned = joints.length ? reach * Math.max(0, Math.min(1, seconds / Drive.SECONDS)) : 0;
    const angle = turn * turned || 0;
    const isArc = Math.abs(angle) > 1e-6;
    const [ahead, aside] = isArc
      ? [Math.sin(angle) / turn, (1 - Math.cos(angle)) / turn]
      : [turned, 0];
    const way = joints.length ? [x * ahead - y * aside, x * aside + y * ahead] : [0, 0];
    const place = [mass[0] + way[0], mass[1] + way[1], floor + at[3]];
    const turning = Transforms.product(Transforms.about([0, 0, 1], angle), Drive.upright(at));
    const pose = Transforms.product(Transforms.along(place, 1), turning);
    return {
      pose: Transforms.product(pose, Transforms.along(mass, -1)),
      turned,
      isOver: seconds >= (joints.length ? Drive.SECONDS : 0),
    };
  },
};

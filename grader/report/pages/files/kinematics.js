"use strict";
// Forward kinematics, as grader/ros/urdf/kinematics.py computes them.

/**
 * A joint. `origin` is missing if it connects no two links that are shown, `axis` (a unit vector)
 * if it cannot move; `range` and `start` are radians or metres.
 * @typedef {{name: string, type: string, parent: string, child: string, origin?: Pose,
 *   axis?: Vector, range?: number[], start?: number, mimic?: [string, number, number]}} Joint
 */
/**
 * A shape; `mesh` is the address of its triangles, of which it is the box.
 * @typedef {{kind: string, size: Vector, pose: Pose, rgba: number[], mesh?: string}} Shape
 */
/**
 * A link; `pose` is that in the frame of the robot, of a link whose joint is not known.
 * @typedef {{name: string, shapes: Shape[], pose?: Pose}} Link
 */
/** @typedef {{frame: string, root: string, links: Link[], joints: Joint[]}} Robot */

const Kinematics = {
  /**
   * Return the first joint of each name.
   * @param {Robot} robot
   * @returns {Map<string, Joint>}
   */
  jointsByName(robot) {
    /** @type {Map<string, Joint>} */
    const byName = new Map();
    for (const joint of robot.joints) {
      if (!byName.has(joint.name)) {
        byName.set(joint.name, joint);
      }
    }
    return byName;
  },

  /**
   * Return the position of a joint: its own, or the one it gets from the joint that it mimics.
   * @param {Joint} joint
   * @param {Map<string, Joint>} byName
   * @param {Map<string, number>} positions
   */
  position(joint, byName, positions) {
    /** @type {Joint[]} */
    const followers = [];
    /** @type {Joint | undefined} */
    let leader = joint;
    while (leader && leader.mimic) {
      if (followers.includes(leader)) {
        return 0;
      }
      followers.push(leader);
      leader = byName.get(leader.mimic[0]);
    }
    let value = leader ? positions.get(leader.name) || 0 : 0;
    for (const { mimic } of followers.reverse()) {
      if (mimic) {
        value = mimic[1] * value + mimic[2];
      }
    }
    return value;
  },

  /**
   * Return the pose of each link in the frame of the robot.
   * @param {Robot} robot
   * @param {Map<string, number>} positions of joints: radians or metres
   * @returns {Map<string, Pose>}
   */
  poses(robot, positions) {
    const byName = Kinematics.jointsByName(robot);
    const above = new Map(robot.joints.filter((one) => one.origin).map((one) => [one.child, one]));
    /** @type {Map<string, Pose>} */
    const known = new Map();
    for (const link of robot.links) {
      if (link.pose) {
        known.set(link.name, link.pose);
      }
    }
    for (const link of robot.links) {
      const chain = [];
      let name = link.name;
      for (let joint = above.get(name); joint && !known.has(name); joint = above.get(name)) {
        chain.push(joint);
        name = joint.parent;
      }
      for (const joint of chain.reverse()) {
        const origin = joint.origin || Transforms.IDENTITY;
        const pose = Transforms.product(known.get(joint.parent) || Transforms.IDENTITY, origin);
        known.set(joint.child, Kinematics.moved(pose, joint, byName, positions));
      }
    }
    const back = Transforms.inverse(known.get(robot.frame) || Transforms.IDENTITY);
    for (const [name, pose] of known) {
      known.set(name, Transforms.product(back, pose));
    }
    return known;
  },

  /**
   * Return a pose, moved by a joint.
   * @param {Pose} pose
   * @param {Joint} joint
   * @param {Map<string, Joint>} byName
   * @param {Map<string, number>} positions
   */
  moved(pose, joint, byName, positions) {
    if (!joint.axis) {
      return pose;
    }
    const position = Kinematics.position(joint, byName, positions);
    const motion = joint.type === "prismatic" ? Transforms.along : Transforms.about;
    return Transforms.product(pose, motion(joint.axis, position));
  },
};

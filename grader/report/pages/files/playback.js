"use strict";
// A recording on a page of `grader view`: the robot moves as it was recorded, at the time of a slider.

/**
 * The numbers of a column are the differences of whole steps, one for each time. `pose` has seven
 * columns: the place of the link `base` and its quaternion.
 * @typedef {{path: string, unit: number, times: number[], base: string, pose: number[][],
 *   joints: {[name: string]: number[]}, wrong: Wrong[], log: [number, string][]}} PlaybackData
 */
/**
 * A recording with numbers in place of steps.
 * @typedef {{times: number[], poses: number[][], columns: [string, number[]][]}} Recording
 */
/**
 * A link that was recorded elsewhere: its pose in its parent.
 * @typedef {{link: string, parent: string, pose: Pose, text: string}} Wrong
 */

const Playback = {
  /** Return the numbers of a column. @param {number[]} steps @param {number} unit */
  sums(steps, unit) {
    let sum = 0;
    return steps.map((step) => (sum += step) / unit);
  },

  /** Return the pose with a place and a quaternion of any length. @param {number[]} numbers */
  pose([x, y, z, a, b, c, d]) {
    const s = 2 / (a * a + b * b + c * c + d * d || 1);
    return [
      ...[1 - s * (b * b + c * c), s * (a * b - c * d), s * (a * c + b * d), x],
      ...[s * (a * b + c * d), 1 - s * (a * a + c * c), s * (b * c - a * d), y],
      ...[s * (a * c - b * d), s * (b * c + a * d), 1 - s * (a * a + b * b), z],
    ];
  },

  /** Return a recording with numbers. @param {PlaybackData} data @returns {Recording} */
  read({ unit, times, pose, joints }) {
    const poses = pose.map((column) => Playback.sums(column, unit));
    for (let i = 1; i < (poses.length && times.length); i++) {
      const turn = [3, 4, 5, 6].reduce((sum, k) => sum + poses[k][i] * poses[k][i - 1], 0);
      if (turn < 0) {
        [3, 4, 5, 6].forEach((k) => (poses[k][i] *= -1)); // the same rotation, on the short way
      }
    }
    /** @type {[string, number[]][]} */
    const columns = Object.entries(joints).map(([name, steps]) => [
      name,
      Playback.sums(steps, unit),
    ]);
    return { times: Playback.sums(times, unit), poses, columns };
  },

  /**
   * Return the pose of the base at a time, null without one, and the positions of joints.
   * @param {Recording} recording
   * @param {number} time
   */
  at({ times, poses, columns }, time) {
    const later = times.findIndex((one) => one >= time);
    const end = later < 0 ? times.length - 1 : later;
    const start = Math.max(0, end - 1);
    const span = times[end] - times[start];
    const part = span > 0 ? Math.max(0, Math.min(1, (time - times[start]) / span)) : 1;
    const between = (/** @type {number[]} */ column) =>
      part === 1 ? column[end] : column[start] + part * (column[end] - column[start]);
    return {
      pose: poses.length ? Playback.pose(poses.map(between)) : null,
      positions: new Map(columns.map(([name, column]) => [name, between(column)])),
    };
  },
};

/** Show the recording of the page below its robot, at a time; null without one. @param {number} time */
function showPlayback(time) {
  /** @type {Robot & {playback?: PlaybackData} | undefined} */
  const robot = JSON.parse(document.getElementById("data")?.textContent || "{}").robot;
  const data = robot?.playback;
  const view = RobotView;
  const stage = document.querySelector("#space .space");
  if (!robot || !data || !view || !stage) {
    return null;
  }
  const recording = Playback.read(data);
  const end = recording.times[recording.times.length - 1];
  /** @template {keyof HTMLElementTagNameMap} Tag @param {Tag} tag @param {string} [text] */
  const make = (tag, text = "") => {
    const element = document.createElement(tag);
    element.textContent = text;
    return element;
  };
  const [tools, button, input, output] = [make("p"), make("button"), make("input"), make("output")];
  tools.className = "space-tools";
  tools.id = "space-play";
  button.type = "button";
  Object.assign(input, {
    type: "range",
    min: "0",
    max: String(end),
    step: "any",
    id: "space-time",
  });
  input.setAttribute("aria-label", `Time in the recording ${data.path}`);
  tools.append(button, input, output);
  const told = make("ul");
  told.id = "space-wrong";
  for (const { text } of data.wrong) {
    told.append(make("li", text));
  }
  const messages = make("ol");
  messages.id = "space-log";
  const printed = data.log.map(([at, text]) => {
    const [item, line] = [make("li"), make("button", `${at.toFixed(1)} s ${text}`)];
    line.type = "button";
    line.addEventListener("click", () => {
      stop();
      show(at);
    });
    item.append(line);
    messages.append(item);
    return { at, line };
  });
  stage.after(tools, ...(data.wrong.length ? [told] : []), ...(printed.length ? [messages] : []));

  let now = 0;
  let began = 0; // when it began to play from its start, in milliseconds
  const show = (/** @type {number} */ seconds) => {
    now = Math.max(0, Math.min(end, seconds));
    const { pose, positions } = Playback.at(recording, now);
    input.value = String(now);
    output.textContent = `${now.toFixed(1)} s`;
    input.setAttribute("aria-valuetext", output.textContent);
    for (const { at, line } of printed) {
      line.classList.toggle("faint", at > now);
    }
    for (const [name, position] of positions) {
      view.positions.set(name, position);
      view.sliders.get(name)?.(position);
    }
    const base = Kinematics.poses(robot, view.positions).get(data.base);
    view.carry(
      pose && base ? Transforms.product(pose, Transforms.inverse(base)) : Transforms.IDENTITY,
    );
  };
  const stop = () => {
    began = 0;
    button.textContent = "Play";
  };
  const tick = (/** @type {number} */ at) => {
    if (!began || !tools.isConnected) {
      return;
    }
    show((at - began) / 1000);
    if (now < end) {
      requestAnimationFrame(tick);
    } else {
      stop();
    }
  };
  button.addEventListener("click", () => {
    if (began) {
      stop();
    } else if (matchMedia("(prefers-reduced-motion: reduce)").matches) {
      show(end);
    } else {
      show(now < end ? now : 0);
      began = performance.now() - 1000 * now;
      button.textContent = "Pause";
      requestAnimationFrame(tick);
    }
  });
  input.addEventListener("input", () => {
    stop();
    show(Number(input.value));
  });
  document.getElementById("space-reset")?.addEventListener("click", () => {
    stop();
    show(0);
  });
  const { poses } = recording;
  if (poses.length) {
    const [x, y, z] = poses;
    view.recorded.path = view.solid(x.flatMap((value, i) => [value, y[i], z[i], 0, 0, 0]));
    view.recorded.ground += z[0] - (view.poses().get(data.base)?.[11] || 0);
  }
  view.recorded.wrong = data.wrong;
  data.wrong.forEach(({ link }) => view.failed.add(link));
  stop();
  show(time);
  return { show, stop, time: () => now };
}

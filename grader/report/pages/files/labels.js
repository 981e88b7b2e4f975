"use strict";
/* Text over the canvas: numbers of failures, letters of axes, the name of a link; and the position of the selected link in words. */
const MAX_LETTERED = 12; // frames

function makeLabels(data, scene, canvas, holder, output) {
  function placeOf({ point, link, other }, poses) {
    const [name, number] = link >= 0 ? ["submission", link] : ["reference", other], start = number >= 0 && scene.resting[name][number];
    return point && start ? poses[name][number] && apply(compose(poses[name][number], inverse(start)), point) : point;
  }

  function texts(state, { poses, framed, long, main }) {
    const found = [], named = state.hover >= 0 ? state.hover : state.link;
    for (const callout of data.callouts) {
      const chosen = callout.link >= 0 && callout.link === state.link ? " chosen" : "";
      found.push([String(callout.number), placeOf(callout, poses), `callout${chosen}`]);
    }
    for (const { pose, link } of framed) {
      if (framed.length > MAX_LETTERED && link !== state.link) continue;
      AXES.forEach(([, letter], k) => found.push([letter, apply(pose, [0, 1, 2].map((axis) => (axis === k ? 1.25 * long : 0))), "axis"]));
    }
    if (named >= 0 && main === "submission" && poses.submission[named]) found.push([data.robot.links[named], poses.submission[named].slice(9), "name"]);
    return found.filter(([, point]) => point);
  }

  /* Put each number beside those that are already placed. */
  function place(found, seen) {
    const taken = [];
    while (holder.children.length < found.length) holder.append(document.createElement("span"));
    [...holder.children].forEach((element, k) => {
      const [text, point, kind] = found[k] || [], at = text && projected(seen, point);
      element.hidden = !at;
      if (!at) return;
      let [x, y] = [at[0] * canvas.clientWidth, at[1] * canvas.clientHeight];
      if (kind.startsWith("callout")) {
        while (taken.some(([u, v]) => Math.hypot(x - u, y - v) < 24)) x += 26;
        taken.push([x, y]);
      }
      element.className = kind;
      element.textContent = text;
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
  }

  function tell(state, { poses, main }) {
    const whose = main === "reference" ? " (submission)" : "";
    const { links, frame } = data.robot, pose = poses.submission[state.link];
    const numbers = pose && pose.slice(9).map((value) => String(Math.round(value * 1e4) / 1e4 + 0)).join(" ");
    const text = state.link < 0 ? "" : pose ? `at ${numbers} m in ${links[frame]}${whose}` : "has no pose in the picture";
    if (output.textContent !== text) output.textContent = text;
  }

  return (state, drawn, seen) => { place(texts(state, drawn), seen); tell(state, drawn); };
}

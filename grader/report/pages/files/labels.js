"use strict";
/* Text over the canvas: numbers of failures, letters of axes, the name of a link; and the position of the selected link in words. */
const MAX_LETTERED = 12; // frames
const ANGLES = [0, 1, -1, 2, -2, 3, -3, 4].map((k) => (k * Math.PI) / 4);
const AROUND = [30, 46, 64, 86].flatMap((ring) => ANGLES.map((angle) => [ring * Math.sin(angle), -ring * Math.cos(angle)]));
const NEAR = [[0, 0], [12, 0], [-12, 0], [0, -14], [0, 14]];

function makeLabels(data, scene, canvas, holder, output) {
  function placeOf({ point, link, other }, poses) {
    const [name, number] = link >= 0 ? ["submission", link] : ["reference", other], start = number >= 0 && scene.resting[name][number];
    return point && start ? poses[name][number] && apply(compose(poses[name][number], inverse(start)), point) : point;
  }

  function texts(state, { poses, framed, long, main }) {
    const found = [], named = state.hover >= 0 ? state.hover : state.link;
    for (const { pose, link } of framed) {
      if (framed.length > MAX_LETTERED && link !== state.link) continue;
      AXES.forEach(([, letter], k) => found.push([letter, apply(pose, [0, 1, 2].map((axis) => (axis === k ? 1.25 * long : 0))), "axis"]));
    }
    if (named >= 0 && main === "submission" && poses.submission[named]) found.push([data.robot.links[named], poses.submission[named].slice(9), "name"]);
    for (const callout of data.callouts) {
      const chosen = callout.link >= 0 && callout.link === state.link ? " chosen" : "";
      if (state.mode === "both" || (main === "submission" && callout.link >= 0)) found.push([String(callout.number), placeOf(callout, poses), `callout${chosen}`]);
    }
    return found.filter(([, point]) => point);
  }

  /* The width and height of a label, and where it may be beside its point, nearest first. */
  function roomOf(kind, text) {
    if (kind === "axis") return [10, 12, NEAR];
    const wide = 9 * text.length + 14, aside = wide / 2 + 10;
    return kind === "name" ? [wide, 26, [[aside, 22], [-aside, 22], [aside, -22], [-aside, -22]]] : [26, 26, AROUND];
  }

  /* Put each label at the first place that is free; without one a number covers others, and the rest is left out. */
  function place(found, seen) {
    const taken = [];
    while (holder.children.length < found.length) holder.append(document.createElement("span"));
    [...holder.children].forEach((element, k) => {
      const [text, point, kind] = found[k] || [], at = text && projected(seen, point);
      element.hidden = !at;
      if (!at) return;
      const [x, y] = [at[0] * canvas.clientWidth, at[1] * canvas.clientHeight], [wide, high, shifts] = roomOf(kind, text);
      const isFree = ([u, v]) => taken.every(([a, b, c, d]) => Math.abs(x + u - a) >= (wide + c) / 2 || Math.abs(y + v - b) >= (high + d) / 2);
      const shift = shifts.find(isFree) || (shifts === AROUND && shifts[0]);
      element.hidden = !shift;
      if (!shift) return;
      const [u, v] = shift;
      taken.push([x + u, y + v, wide, high]);
      element.className = kind;
      element.textContent = text;
      element.style.transform = `translate(${(x + u).toFixed(1)}px, ${(y + v).toFixed(1)}px) translate(-50%, -50%)`;
      element.style.setProperty("--length", `${Math.hypot(u, v).toFixed(1)}px`);
      element.style.setProperty("--angle", `${Math.atan2(u, -v).toFixed(3)}rad`);
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

"use strict";
/* What is drawn of the robots at the positions of their joints: solids, the ground, arrows of wheels, frames. */
const AXES = [[[0.85, 0.16, 0.2], "x"], [[0, 0.54, 0.39], "y"], [[0.08, 0.41, 0.85], "z"]];
const HIDDEN = 0.02; // a colour with less alpha shows edges only

const alpha = ([r, g, b], a) => [r, g, b, a];
const distance = (one, other) => Math.max(...one.map((value, k) => Math.abs(value - other[k])));

/* The z axis of a pose and the height of a point above its z = 0. */
const upOf = (pose) => [pose[2], pose[5], pose[8]];
const above = (pose, point) => upOf(pose).reduce((sum, value, k) => sum + value * (point[k] - pose[9 + k]), 0);

/* Whether two shapes look the same, within 1 mm and a degree; a cylinder may be turned about its axis. */
function looksSame(one, other) {
  const parallel = (k) => Math.abs([k, k + 3, k + 6].reduce((sum, m) => sum + one.pose[m] * other.pose[m], 0)) > 0.9998;
  const axes = { box: [0, 1, 2], cylinder: [2], sphere: [] }[one.kind];
  return one.kind === other.kind && distance(one.size, other.size) < 0.001 && distance(one.pose.slice(9), other.pose.slice(9)) < 0.001 && axes.every(parallel);
}

/* The middle and the radius of all that the robots show at rest, and half of the height in metres that a picture from START needs. */
function enclosing(robots, resting) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const add = (pose, sizes) => [0, 1, 2].forEach((k) => {
    const reach = sizes.reduce((sum, size, m) => sum + Math.abs(pose[3 * k + m]) * size, 0);
    low[k] = Math.min(low[k], pose[9 + k] - reach);
    high[k] = Math.max(high[k], pose[9 + k] + reach);
  });
  for (const [name, poses] of Object.entries(resting)) {
    for (const [link, kind, size, origin] of robots[name].shapes) add(compose(poses[link], placed(origin)), size.map((value, k) => (kind === "box" || (kind === "cylinder" && k === 2) ? value / 2 : value)));
    if (!robots[name].shapes.length) poses.filter(Boolean).forEach((pose) => add(pose, [0.05, 0.05, 0.05]));
  }
  const centre = low.map((value, k) => (value + high[k]) / 2);
  const half = high.map((value, k) => (value - low[k]) / 2), flat = Math.hypot(half[0], half[1]);
  const fit = Math.max(half[2] * Math.cos(START.elevation) + flat * Math.sin(START.elevation), (flat * 3) / 4, 1e-3);
  return { centre, radius: Math.max(Math.hypot(...half), 1e-3), fit: 1.3 * fit };
}

function makeScene(data) {
  const robots = Object.fromEntries(Object.entries({ submission: data.robot, reference: data.reference }).filter(([, robot]) => robot));
  const starts = new Map(data.sliders.map(({ joint, value }) => [joint, value]));
  const resting = Object.fromEntries(Object.entries(robots).map(([name, robot]) => [name, posesOf(robot, starts)]));
  const { centre, radius, fit } = enclosing(robots, resting);
  const called = new Set(data.callouts.map((callout) => callout.link));
  const power = 10 ** Math.floor(Math.log10(radius)), cell = radius / power > 3 ? power : power / 2;

  function solids(name, poses, state, colours) {
    const ghost = name === "reference" && state.mode === "both";
    return robots[name].shapes.filter(([link]) => poses[link]).map(([link, kind, size, origin, rgba, spokes]) => {
      const own = name === "submission" ? link : data.same[link], failed = name === "submission" && called.has(link);
      return {
        kind, size, spokes, link: ghost ? -1 : own, pose: compose(poses[link], placed(origin)),
        rgba: ghost ? alpha(colours.reference, 0.28) : rgba[3] < HIDDEN ? null : rgba,
        edge: ghost ? alpha(colours.reference, 0.9) : failed ? alpha(colours.failed, 1) : alpha(colours.ink, 0.55),
        beneath: failed ? alpha(colours.failed, 0.55) : null,
        through: own >= 0 && (own === state.link || own === state.hover) ? alpha(colours.focus, 1) : null,
      };
    });
  }

  /* Flat marks on the ground: where each wheel drives its base, or a cross. A way other than the reference's is red. */
  function arrows(name, poses, ground, state, colours) {
    return robots[name].wheels.map((wheel) => {
      const moved = compose(poses[wheel.parent] || IDENTITY, inverse(resting[name][wheel.parent] || IDENTITY));
      const up = upOf(ground), at = apply(moved, wheel.centre), way = wheel.travel ? rotate(moved, wheel.travel) : [ground[0], ground[3], ground[6]];
      const lift = 0.004 * radius - above(ground, at), ahead = wheel.travel ? 1.1 * wheel.reach : 0;
      const long = wheel.travel ? Math.max(1.5 * wheel.reach, 0.22 * radius) : 1.2 * wheel.reach;
      const start = at.map((value, k) => value + lift * up[k] + ahead * way[k]);
      const side = [up[1] * way[2] - up[2] * way[1], up[2] * way[0] - up[0] * way[2], up[0] * way[1] - up[1] * way[0]];
      const ghost = name === "reference" && state.mode === "both", colour = ghost ? colours.reference : wheel.right ? colours.link : colours.failed;
      return {
        kind: wheel.travel ? "arrow" : "cross", size: [long, long, 1], link: -1,
        pose: [way[0], side[0], up[0], way[1], side[1], up[1], way[2], side[2], up[2], ...start],
        rgba: alpha(colour, ghost ? 0.25 : 0.9), edge: alpha(colour, 1),
      };
    });
  }

  /* The ground at the root's z = 0; where wheels have driven, it has moved below the robot. */
  function grid(ground, drift, edge, rgba) {
    const pose = compose(ground, inverse([...drift.slice(0, 9), ...drift.slice(9).map((value) => value % cell)]));
    const size = 10 * cell * Math.ceil((1.6 * radius) / (10 * cell));
    return { kind: "grid", pose, size: [size, size, 1], link: -1, rgba, edge };
  }

  function grounded(name, poses, state, colours) {
    const ground = poses[name][robots[name].root];
    if (!ground) return [];
    const found = arrows(name, poses[name], ground, state, colours);
    if (name === "submission" || state.mode !== "both") found.push(grid(ground, state.drift, alpha(colours.faint, 0.4), alpha(colours.line, 0.28)));
    else if (distance(ground.slice(9), (poses.submission[robots.submission.root] || IDENTITY).slice(9)) > 0.001) found.push(grid(ground, state.drift, alpha(colours.reference, 0.3), null));
    return found;
  }

  function triad(pose, long) {
    return AXES.map(([colour], k) => {
      const size = [0.045, 0.045, 0.045].map((value) => value * long), offset = [0, 0, 0];
      size[k] = long;
      offset[k] = long / 2;
      return { kind: "box", pose: compose(pose, [...IDENTITY.slice(0, 9), ...offset]), size, link: -1, rgba: null, onTop: [...colour, 1] };
    });
  }

  /* All items to draw, the poses of both robots, and the frames that have axes. */
  function items(state, given, colours) {
    const found = [], long = 0.16 * radius, main = state.mode === "reference" ? "reference" : "submission";
    const poses = Object.fromEntries(Object.entries(robots).map(([name, robot]) => [name, posesOf(robot, given)]));
    for (const name of Object.keys(robots)) {
      if (state.mode !== name && state.mode !== "both") continue;
      const shown = solids(name, poses[name], state, colours);
      found.push(...(name === "submission" ? shown : shown.filter((one) => !found.some((other) => looksSame(one, other)))), ...grounded(name, poses, state, colours));
    }
    const own = (link) => (main === "submission" ? link : data.same[link]);
    const framed = poses[main].map((pose, link) => ({ pose, link })).filter(({ pose, link }) => pose && (state.frames || link === robots[main].root || own(link) === state.link));
    framed.forEach(({ pose }) => found.push(...triad(pose, long)));
    return { found, poses, framed, long, main };
  }

  return { robots, resting, starts, centre, radius, fit, items };
}

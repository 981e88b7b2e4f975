"use strict";
/* The robot in 3-D. It is drawn only after a change. */
const SPEED = 0.9; // radians in a second, of wheels that are driven
const GLIDE = 280; // milliseconds

function makeViewer(data, section) {
  const find = (name) => section.querySelector(`[data-part="${name}"]`);
  const canvas = find("canvas"), painter = makePainter(canvas);
  if (!painter) return null;
  const calm = matchMedia("(prefers-reduced-motion: reduce)"), watchers = [], given = new Map();
  const state = { mode: "submission", link: -1, hover: -1, frames: false, poses: [], drift: IDENTITY };
  const scene = makeScene(data), camera = makeCamera(scene);
  const label = makeLabels(data, scene, canvas, find("labels"), find("pose"));
  let colours = {}, frame = 0, seen = null, pickable = [], driving = 0;

  function readColours() {
    const style = getComputedStyle(section), hex = (name) => style.getPropertyValue(`--${name}`).trim().replace(/^#(.)(.)(.)$/, "#$1$1$2$2$3$3");
    const colour = (name) => [1, 3, 5].map((k) => parseInt(hex(name).slice(k, k + 2), 16) / 255);
    colours = Object.fromEntries(["sheet", "line", "ink", "faint", "failed", "focus", "link", "reference"].map((name) => [name, colour(name)]));
  }

  function draw() {
    frame = 0;
    const ratio = Math.min(devicePixelRatio || 1, 3);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * ratio)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const drawn = scene.items(state, given, colours);
    seen = camera.seen(width / height);
    state.poses = drawn.poses.submission;
    pickable = drawn.found.filter((item) => item.link >= 0);
    painter(drawn.found, seen, colours.sheet, ratio);
    label(state, drawn, seen);
  }

  function schedule() {
    frame = frame || requestAnimationFrame(draw);
  }

  function notify() {
    schedule();
    watchers.forEach((watcher) => watcher());
  }

  /* The link under the pointer, or -1. */
  function pick(event) {
    if (!seen) return -1;
    const box = canvas.getBoundingClientRect(), way = sightline(seen, (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    let nearest = [Infinity, -1];
    for (const { kind, pose, size, link } of pickable) {
      const back = inverse(pose), own = (vector) => vector.map((value, k) => value / Math.max(size[k], 1e-9));
      const far = meeting[kind](own(apply(back, seen.eye)), own(rotate(back, way)));
      if (far > 0 && far < nearest[0]) nearest = [far, link];
    }
    return nearest[1];
  }

  /* Move the camera; at once if the system asks for reduced motion. */
  function glide(goal) {
    const from = { ...camera, target: camera.target }, began = performance.now(), to = { ...from, ...goal };
    const turn = Math.atan2(Math.sin(to.azimuth - from.azimuth), Math.cos(to.azimuth - from.azimuth));
    const step = (now) => {
      const share = calm.matches ? 1 : Math.min(1, Math.max(0, (now - began) / GLIDE)), t = share * share * (3 - 2 * share);
      camera.azimuth = from.azimuth + t * turn;
      camera.elevation = from.elevation + t * (to.elevation - from.elevation);
      camera.zoom = from.zoom * (to.zoom / from.zoom) ** t;
      camera.target = from.target.map((value, k) => value + t * (to.target[k] - value));
      draw();
      if (share < 1) requestAnimationFrame(step);
    };
    step(began);
  }

  /* The camera angles to see a point: from its side of the robot. */
  function aspect(point) {
    const away = point ? [0, 1].map((k) => point[k] - scene.centre[k]) : [0, 0];
    return Math.hypot(...away) > 0.15 * scene.radius ? { ...START, azimuth: Math.atan2(away[1], away[0]) + (away[1] > 0 ? -0.4 : 0.4) } : START;
  }

  const numbered = (number) => data.callouts.find((callout) => callout.number === number);

  function choose(link) {
    state.link = link;
    notify();
  }

  /* Select and face the link of a callout. */
  function show(number) {
    const { link, point } = numbered(number);
    if (link < 0) state.mode = "both"; // only the reference has it
    else if (state.mode === "reference") state.mode = "submission";
    choose(link);
    glide({ ...aspect(point), zoom: 1.1, target: scene.centre.map((value, k) => value + (point ? 0.35 * (point[k] - value) : 0)) });
  }

  function set(joint, value) {
    given.set(joint, value);
    notify();
  }

  function roll(angle) {
    const { wheels, joints, root } = data.robot, places = wheels.map(({ joint }) => joints.findIndex(({ name }) => name === joint));
    const positions = () => places.map((place) => positionOf(data.robot, place, given));
    const before = positions();
    wheels.filter((wheel) => wheel.free).forEach(({ joint }) => given.set(joint, (given.get(joint) || 0) + angle));
    const angles = positions().map((position, k) => position - before[k] || 0);
    if (scene.resting.submission[root]) state.drift = compose(state.drift, rolled(wheels, scene.resting.submission[root], angles));
    notify();
  }

  /* Turn all wheels slowly until stopped; by one step if the system asks for reduced motion. */
  function drive(on) {
    let before = performance.now();
    cancelAnimationFrame(driving);
    driving = 0;
    if (on && calm.matches) roll(Math.PI / 12);
    else if (on) {
      const step = (now) => {
        driving = requestAnimationFrame(step);
        roll((SPEED * Math.min(100, Math.max(0, now - before))) / 1000);
        before = now;
      };
      driving = requestAnimationFrame(step);
    }
    notify();
  }

  function reset() {
    drive(false);
    given.clear();
    scene.starts.forEach((value, joint) => given.set(joint, value));
    state.drift = IDENTITY;
    const [called] = (data.costly || []).map(numbered).filter((callout) => callout.point);
    Object.assign(camera, aspect(called && called.point), { target: [...scene.centre] });
    notify();
  }

  canvas.addEventListener("webglcontextlost", () => { find("no-webgl").hidden = false; });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); schedule(); });
  readColours();
  reset();
  new ResizeObserver(schedule).observe(canvas);
  return { canvas, camera, state, given, watchers, draw, schedule, notify, pick, glide, choose, show, set, drive, reset, isDriving: () => driving !== 0 };
}

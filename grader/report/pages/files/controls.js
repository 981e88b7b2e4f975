"use strict";
/* The keys, the pointer and the controls around the robot in 3-D. */
const VIEWS = { front: [0, 0], side: [-Math.PI / 2, 0], top: [-Math.PI / 2, Math.PI / 2] };

function addControls(viewer, section, robot) {
  const { canvas, camera, state } = viewer, find = (name) => section.querySelector(`[data-part="${name}"]`);
  const all = (name) => section.querySelectorAll(`[data-${name}]`), pointers = new Map();

  const look = (name) => { viewer.glide({ azimuth: VIEWS[name][0], elevation: VIEWS[name][1] }); };
  const turn = (right, up) => { camera.turn(right, up); viewer.schedule(); };
  const enlarge = (factor) => { camera.enlarge(factor); viewer.schedule(); };
  const shift = (right, up) => { camera.shift(right, up, canvas.clientHeight); viewer.schedule(); };

  const keys = {
    ArrowLeft: [() => turn(-0.1, 0), () => shift(-20, 0)], ArrowRight: [() => turn(0.1, 0), () => shift(20, 0)],
    ArrowUp: [() => turn(0, 0.1), () => shift(0, -20)], ArrowDown: [() => turn(0, -0.1), () => shift(0, 20)],
    "+": [() => enlarge(1.15)], "=": [() => enlarge(1.15)], "-": [() => enlarge(1 / 1.15)], 0: [() => viewer.reset()],
    1: [() => look("front")], 2: [() => look("side")], 3: [() => look("top")], Escape: [() => viewer.choose(-1)],
  };
  canvas.addEventListener("keydown", (event) => {
    const [plain, shifted] = keys[event.key] || [];
    if (!plain || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    (event.shiftKey && shifted ? shifted : plain)();
  });

  const spread = () => { const [a, b] = [...pointers.values()]; return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0; };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, moved: 0 });
  });
  canvas.addEventListener("pointermove", (event) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) { hover(viewer.pick(event)); return; }
    const before = spread(), dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    Object.assign(pointer, { x: event.clientX, y: event.clientY, moved: pointer.moved + Math.abs(dx) + Math.abs(dy) });
    if (pointers.size === 2) { if (before) enlarge(spread() / before); shift(dx / 2, dy / 2); }
    else if (event.shiftKey || event.buttons === 4) shift(dx, dy);
    else turn(-dx * 0.008, dy * 0.008);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => {
      const pointer = pointers.get(event.pointerId);
      pointers.delete(event.pointerId);
      if (name === "pointerup" && pointer && pointer.moved < 4) viewer.choose(viewer.pick(event));
    });
  }
  canvas.addEventListener("pointerleave", () => hover(-1));
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); enlarge(Math.exp(-event.deltaY * 0.0012)); }, { passive: false });

  function hover(link) {
    if (link === state.hover) return;
    state.hover = link;
    viewer.schedule();
  }

  for (const button of all("view")) button.addEventListener("click", () => look(button.dataset.view));
  for (const button of all("mode")) {
    button.addEventListener("click", () => {
      state.mode = button.dataset.mode;
      viewer.notify();
    });
  }
  find("reset").addEventListener("click", () => viewer.reset());
  find("frames").addEventListener("click", (event) => {
    state.frames = !state.frames;
    event.currentTarget.setAttribute("aria-pressed", String(state.frames));
    viewer.schedule();
  });
  find("links").addEventListener("change", (event) => viewer.choose(Number(event.target.value)));
  if (find("drive")) {
    find("drive").addEventListener("click", () => viewer.drive(!viewer.isDriving()));
  }

  const sliders = [...all("joint")];
  const read = (slider) => Number(slider.value) * Number(slider.dataset.scale);
  function refresh() {
    for (const slider of sliders) {
      const index = Number(slider.dataset.joint), scale = Number(slider.dataset.scale);
      let value = positionOf(robot, index, viewer.given) / scale;
      if (slider.dataset.wraps) value -= 360 * Math.round(value / 360);
      if (Number(slider.value) !== value) slider.value = String(value);
      const text = `${Math.round(value * 10) / 10 + 0} ${slider.dataset.unit}`;
      slider.parentElement.querySelector("output").textContent = text;
      slider.setAttribute("aria-valuetext", text);
    }
    for (const button of all("mode")) button.setAttribute("aria-pressed", String(button.dataset.mode === state.mode));
    if (find("drive")) find("drive").setAttribute("aria-pressed", String(viewer.isDriving()));
    if (find("links").value !== String(state.link)) find("links").value = String(state.link);
  }
  for (const slider of sliders) slider.addEventListener("input", () => viewer.set(robot.joints[Number(slider.dataset.joint)].name, read(slider)));
  viewer.watchers.push(refresh);
  refresh();
}

const robotSection = document.getElementById("robot");
const pageData = JSON.parse(document.getElementById("data").textContent);
robotSection.querySelector("[data-part=space]").hidden = false;
const viewer = makeViewer(pageData, robotSection);
robotSection.querySelector("[data-part=stage]").hidden = !viewer;
robotSection.querySelector("[data-part=no-webgl]").hidden = Boolean(viewer);
if (viewer) addControls(viewer, robotSection, pageData.robot);

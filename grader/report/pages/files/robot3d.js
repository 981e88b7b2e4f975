"use strict";
// The robot in 3-D: a canvas that the pointer and keys turn, and a slider for each joint that moves.
// Without WebGL nothing of it is shown, and the three views remain.

/** @typedef {{number: number, link: string, card?: string}} Pin */
/** @typedef {Robot & {pins: Pin[], drive?: DriveData}} ShownRobot */
/** @typedef {{buffer: WebGLBuffer, count: number}} Solid */
/** @typedef {{solid: Solid, pose: Pose, size: Vector, rgba: number[]}} Item */

/** Show the robot of the page; null without one, or without WebGL. */
function showRobot() {
  const text = document.getElementById("data")?.textContent || "{}";
  /** @type {ShownRobot | undefined} */
  const robot = JSON.parse(text).robot;
  const box = document.getElementById("space");
  const canvas = /** @type {HTMLCanvasElement | null} */ (document.getElementById("space-canvas"));
  const gl = robot && canvas && canvas.getContext("webgl");
  if (!robot || !box || !canvas || !gl) {
    return null;
  }
  const find = (/** @type {string} */ id) =>
    /** @type {HTMLElement} */ (document.getElementById(`space-${id}`));
  box.hidden = false;

  // --- The robot and what the three views show of it ---
  const byName = Kinematics.jointsByName(robot);
  const START = new Map([...byName.values()].map(({ name, start = 0 }) => [name, start]));
  const HOME = { yaw: -0.9, pitch: 0.45, zoom: 1, right: 0, up: 0 };
  const positions = new Map(START);
  const camera = { ...HOME };
  const shows = { ghost: true, frames: false };
  let selected = "";
  let poses = Kinematics.poses(robot, positions);
  const parents = new Map(robot.joints.map((one) => [one.child, one]));
  let carried = Transforms.IDENTITY; // the pose of the robot, which drives
  const pose = (/** @type {string} */ link) =>
    Transforms.product(carried, poses.get(link) || Transforms.IDENTITY);
  const shapesOf = (/** @type {Link} */ link) =>
    link.shapes.map((shape) => ({ shape, at: Transforms.product(pose(link.name), shape.pose) }));
  const points = robot.links.flatMap((link) =>
    shapesOf(link).flatMap(({ shape, at }) => Shapes.points(shape, at)),
  );
  const drawing = document.querySelector(".views svg");
  const drawn = drawing && points.length ? Ghost.views(drawing, points) : null;
  const bodies = drawn ? Ghost.bodies(drawn.views, drawn.scale) : [];
  const axes = drawn ? Ghost.axes(drawn.views, drawn.scale) : [];
  const marks = drawn ? Ghost.marks(drawn.views, drawn.scale) : [];
  for (const { triangles } of bodies) {
    for (let i = 0; i < triangles.length; i += 6) {
      points.push(triangles.slice(i, i + 3));
    }
  }
  const hasShapes = points.length > 0;
  if (!hasShapes) {
    // only frames
    points.push(...[...poses.values()].map((at) => [at[3], at[7], at[11]]));
  }
  const extents = [0, 1, 2].map((k) => Ghost.extent(points.map((point) => point[k])));
  const middle = extents.map(([low, high]) => (low + high) / 2);
  const size = Math.hypot(...extents.map(([low, high]) => high - low)) || 1;
  const floor = poses.get(robot.root)?.[11] ?? extents[2][0];
  const { drive } = robot;
  // the ground on which it is set down: it does not rise to get there
  const ground = drive ? Math.min(floor, drive.mass[2] - drive.fall[0][3]) : floor;
  const failed = new Set(robot.pins.map((pin) => pin.link));
  // what a recording shows: the path of its base, and links that were recorded elsewhere
  const recorded = {
    path: /** @type {Solid | null} */ (null),
    wrong: /** @type {{link: string, parent: string, pose: Pose}[]} */ ([]),
    ground: floor,
  };

  // --- WebGL ---
  const shader = (/** @type {number} */ type, /** @type {string} */ source) => {
    const made = /** @type {WebGLShader} */ (gl.createShader(type));
    gl.shaderSource(made, source);
    gl.compileShader(made);
    return made;
  };
  const program = /** @type {WebGLProgram} */ (gl.createProgram());
  const vertices = `attribute vec3 point, normal;
uniform mat4 model, camera;
uniform mat3 turn;
varying vec3 facing;
void main() {
facing = turn * normal;
gl_Position = camera * (model * vec4(point, 1.0));
}`;
  const colours = `precision mediump float;
uniform vec4 colour;
uniform float lit;
varying vec3 facing;
void main() {
vec3 n = normalize(facing + vec3(1e-6));
float key = max(0.0, dot(n, vec3(0.36, -0.48, 0.8)));
float fill = max(0.0, dot(n, vec3(-0.6, 0.64, 0.48)));
float light = mix(1.0, 0.5 + 0.35 * key + 0.2 * fill, lit);
gl_FragColor = vec4(colour.rgb * light * colour.a, colour.a);
}`;
  gl.attachShader(program, shader(gl.VERTEX_SHADER, vertices));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, colours));
  gl.linkProgram(program);
  gl.useProgram(program);
  const attributes = ["point", "normal"].map((name) => gl.getAttribLocation(program, name));
  attributes.forEach((one) => gl.enableVertexAttribArray(one));
  const uniform = (/** @type {string} */ name) => gl.getUniformLocation(program, name);
  const at = {
    ...{ model: uniform("model"), camera: uniform("camera"), turn: uniform("turn") },
    ...{ colour: uniform("colour"), lit: uniform("lit") },
  };
  const solid = (/** @type {number[] | Float32Array} */ numbers) => {
    const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
    return { buffer, count: numbers.length / 6 };
  };
  /** @type {{[kind: string]: Solid}} */
  const solids = {
    box: solid(Shapes.box([-0.5, -0.5, -0.5], [0.5, 0.5, 0.5])),
    cylinder: solid(Shapes.cylinder()),
    sphere: solid(Shapes.sphere()),
  };
  const spoke = solid(Shapes.box([0, -0.05, -0.51], [1.02, 0.05, 0.51]));
  const ghosts = bodies.map((body) => ({ ...body, solid: solid(body.triangles) }));
  const line = solid([0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0]); // scaled to any direction
  const step = 10 ** Math.round(Math.log10(size / 3));
  const grid = solid(
    Array.from({ length: 21 }, (_, i) => (i - 10) * step).flatMap((value) =>
      [
        [value, -1],
        [value, 1],
        [-1, value],
        [1, value],
      ].flatMap(([x, y], k) =>
        k < 2 ? [x, 10 * step * y, 0, 0, 0, 0] : [10 * step * x, y, 0, 0, 0, 0],
      ),
    ),
  );

  /** Draw a solid of size 1. @param {Item} item @param {number} [lit] @param {number} [mode] */
  const draw = (
    { solid: { buffer, count }, pose: T, size, rgba },
    lit = 1,
    mode = gl.TRIANGLES,
  ) => {
    const [a, b, c] = size.map((value) => value || 1e-6);
    gl.uniformMatrix4fv(at.model, false, [
      ...[T[0] * a, T[4] * a, T[8] * a, 0, T[1] * b, T[5] * b, T[9] * b, 0],
      ...[T[2] * c, T[6] * c, T[10] * c, 0, T[3], T[7], T[11], 1],
    ]);
    gl.uniformMatrix3fv(at.turn, false, [
      ...[T[0] / a, T[4] / a, T[8] / a, T[1] / b, T[5] / b, T[9] / b],
      ...[T[2] / c, T[6] / c, T[10] / c],
    ]);
    gl.uniform4fv(at.colour, rgba);
    gl.uniform1f(at.lit, lit);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    attributes.forEach((one, i) => gl.vertexAttribPointer(one, 3, gl.FLOAT, false, 24, 12 * i));
    gl.drawArrays(mode, 0, count);
  };
  /** Draw a line. @param {Vector} start @param {Vector} end @param {number[]} rgba */
  const drawLine = (start, end, rgba) => {
    const pose = Transforms.along(start, 1);
    draw({ solid: line, pose, size: end.map((value, k) => value - start[k]), rgba }, 0, gl.LINES);
  };

  // --- The camera ---
  const sight = () => {
    const [cy, sy] = [Math.cos(camera.yaw), Math.sin(camera.yaw)];
    const [cp, sp] = [Math.cos(camera.pitch), Math.sin(camera.pitch)];
    const right = [-sy, cy, 0];
    const up = [-cy * sp, -sy * sp, cp];
    const back = [cy * cp, sy * cp, sp];
    const away = 1.55 * size * camera.zoom;
    const moved = Transforms.apply(carried, middle);
    const eye = moved.map(
      (value, k) => value + back[k] * away + size * (right[k] * camera.right + up[k] * camera.up),
    );
    const shape = canvas.width / canvas.height || 1;
    const focus = 1 / Math.tan(0.35);
    const scale = [focus / Math.max(shape, 1), focus * Math.min(shape, 1)];
    return { right, up, back, away, eye, scale };
  };
  const projection = () => {
    const { right, up, back, away, eye, scale } = sight();
    const [near, far] = [away / 50, away * 50];
    const depth = -(far + near) / (far - near);
    const row = (/** @type {Vector} */ direction, /** @type {number} */ factor) => [
      ...direction.map((value) => value * factor),
      -Transforms.dot(direction, eye) * factor,
    ];
    const rows = [row(right, scale[0]), row(up, scale[1]), row(back, depth), row(back, -1)];
    rows[2][3] -= (2 * far * near) / (far - near);
    return [0, 1, 2, 3].flatMap((column) => rows.map((one) => one[column]));
  };
  /** Return where a point is in the canvas, as parts of its size; null behind the camera. */
  const place = (/** @type {Vector} */ point) => {
    const { right, up, back, eye, scale } = sight();
    const from = point.map((value, k) => value - eye[k]);
    const depth = -Transforms.dot(back, from);
    if (depth <= 0) {
      return null;
    }
    const x = (scale[0] * Transforms.dot(right, from)) / depth;
    const y = (scale[1] * Transforms.dot(up, from)) / depth;
    return [0.5 + x / 2, 0.5 - y / 2];
  };

  // --- Drawing ---
  /**
   * Return a colour of the page.
   * @param {string} name
   * @param {number} [alpha]
   * @returns {[number, number, number, number]}
   */
  const colour = (name, alpha = 1) => {
    const value = getComputedStyle(canvas).getPropertyValue(name).trim();
    const channel = (/** @type {number} */ i) => parseInt(value.slice(i, i + 2), 16) / 255;
    return [channel(1), channel(3), channel(5), alpha];
  };
  const isMoved = () =>
    carried !== Transforms.IDENTITY ||
    [...positions].some(([name, value]) => value !== START.get(name));
  /** Return whether a shape is a cylinder that a joint turns about its own axis. */
  const turns = (/** @type {Link} */ link, /** @type {Shape} */ shape) => {
    let [joint, turned] = [parents.get(link.name), shape.pose];
    while (joint && joint.origin && !joint.axis) {
      turned = Transforms.product(joint.origin, turned);
      joint = parents.get(joint.parent);
    }
    if (shape.kind !== "cylinder" || !joint || !joint.axis || joint.type === "prismatic") {
      return false;
    }
    return Math.abs(Transforms.dot(joint.axis, Transforms.rotate(turned, [0, 0, 1]))) > 0.99;
  };
  const spokes = new Set(
    robot.links.flatMap((link) => link.shapes.filter((shape) => turns(link, shape))),
  );
  const AXES = ["--axis-x", "--axis-y", "--axis-z"];
  const drawFrame = (/** @type {Pose} */ T, /** @type {number} */ length) => {
    AXES.forEach((name, k) => {
      const end = [0, 0, 0];
      end[k] = length * size;
      drawLine([T[3], T[7], T[11]], Transforms.apply(T, end), colour(name));
    });
  };
  const scaled = (/** @type {Shape} */ shape, /** @type {number} */ more) => {
    const parts = { box: [2, 2, 2], cylinder: [1, 1, 2] }[shape.kind] || [1, 1, 1];
    return shape.size.map((value, k) => value + parts[k] * more);
  };

  const drawSolids = () => {
    /** @type {Item[]} */
    const late = [];
    /** @type {Item[]} */
    const outlined = [];
    for (const link of robot.links) {
      for (const { shape, at: pose } of shapesOf(link)) {
        const item = {
          solid: solids[shape.mesh || ""] || solids[shape.kind],
          ...{ pose, size: shape.size, rgba: shape.rgba },
        };
        if (shape.rgba[3] < 1) {
          late.push(item);
        } else {
          draw(item);
        }
        if (spokes.has(shape)) {
          const isLight = shape.rgba[0] + shape.rgba[1] + shape.rgba[2] > 1.5;
          draw({ ...item, solid: spoke, rgba: isLight ? [0, 0, 0, 1] : [1, 1, 1, 1] }, 0);
        }
        if (failed.has(link.name) || link.name === selected) {
          const rgba = colour(link.name === selected ? "--focus" : "--failed");
          outlined.push({ ...item, size: scaled(shape, 0.006 * size), rgba });
        }
      }
    }
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.FRONT); // only the back of a larger shape: its rim
    outlined.forEach((item) => draw(item, 0));
    gl.disable(gl.CULL_FACE);
    if (shows.ghost && !isMoved()) {
      for (const { solid } of ghosts) {
        const rgba = colour("--reference", 0.35);
        late.push({ solid, pose: Transforms.IDENTITY, size: [1, 1, 1], rgba });
      }
    }
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.enable(gl.POLYGON_OFFSET_FILL); // before a face of the robot in the same place
    gl.polygonOffset(-2, -4);
    const { eye } = sight();
    const far = (/** @type {Item} */ { pose: T }) =>
      Math.hypot(T[3] - eye[0], T[7] - eye[1], T[11] - eye[2]);
    late.sort((a, b) => far(b) - far(a)).forEach((item) => draw(item));
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
  };
  const drawSigns = () => {
    gl.disable(gl.DEPTH_TEST);
    for (const link of robot.links) {
      const isFrame = link.name === robot.frame;
      if (shows.frames || isFrame || link.name === selected || !hasShapes) {
        drawFrame(pose(link.name), isFrame ? 0.15 : 0.09);
      }
    }
    for (const { link, parent, pose: T } of recorded.wrong) {
      const [own, there] = [pose(link), Transforms.product(pose(parent), T)];
      drawFrame(there, 0.09);
      drawLine([own[3], own[7], own[11]], [there[3], there[7], there[11]], colour("--failed"));
    }
    if (shows.ghost && !isMoved()) {
      for (const { name, ends } of axes) {
        drawLine(ends[0], ends[1], colour(`--axis-${name}`));
      }
    }
    gl.enable(gl.DEPTH_TEST);
  };
  const render = () => {
    asked = 0;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((one) =>
      Math.max(1, Math.round(one * ratio)),
    );
    if (canvas.width !== width || canvas.height !== height) {
      [canvas.width, canvas.height] = [width, height];
    }
    poses = Kinematics.poses(robot, positions);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...colour("--sheet"));
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix4fv(at.camera, false, projection());
    const near = [carried[3], carried[7]].map((value) => Math.round(value / step) * step);
    const under = Transforms.along([...near, began ? ground : recorded.ground], 1);
    draw({ solid: grid, pose: under, size: [1, 1, 1], rgba: colour("--line") }, 0, gl.LINES);
    drawSolids();
    if (recorded.path) {
      const rgba = colour("--link");
      draw(
        { solid: recorded.path, pose: Transforms.IDENTITY, size: [1, 1, 1], rgba },
        0,
        gl.LINE_STRIP,
      );
    }
    drawSigns();
    placePins();
    placeNames();
  };
  let asked = 0;
  const redraw = () => {
    asked ||= requestAnimationFrame(render);
  };

  // --- The numbers of failed criteria ---
  const svg = (/** @type {string} */ name, /** @type {{[name: string]: string}} */ attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
    return element;
  };
  const pins = robot.pins.map((pin) => {
    const element = svg("a", { class: "space-pin", "aria-label": `${pin.number}: ${pin.link}` });
    if (pin.card) {
      element.setAttribute("href", `#${pin.card}`);
    }
    const number = svg("text", { y: "4.5" });
    number.textContent = String(pin.number);
    element.append(svg("circle", { r: "11" }), number);
    find("pins").append(element);
    return { ...pin, element };
  });
  const placePins = () => {
    pins.forEach(({ link, element }, number) => {
      const own = robot.links.find((one) => one.name === link);
      const [first] = own ? shapesOf(own) : [];
      let point = marks[number];
      if (own) {
        const T = first ? first.at : pose(link);
        point = [T[3], T[7], T[11]];
      }
      const [x, y] = (point && place(point)) || [-1, -1];
      const [right, down] = [x * canvas.clientWidth, y * canvas.clientHeight];
      element.setAttribute("transform", `translate(${right} ${down})`);
    });
  };

  // --- Names of links, at their frames ---
  let pointed = ""; // the link under the pointer
  const names = robot.links.map(({ name }) => {
    const element = svg("text", { class: "space-name", "aria-hidden": "true" });
    element.textContent = name;
    find("pins").append(element);
    return { name, element };
  });
  const LETTER = { width: 7, height: 14 }; // pixels
  const placeNames = () => {
    /** @type {{x: number, y: number, width: number}[]} */
    const taken = [];
    const first = (/** @type {string} */ name) => Number(name === selected || name === pointed);
    const shown = names.filter(
      ({ name }) => shows.frames || name === robot.frame || first(name) || !hasShapes,
    );
    names.forEach(({ element }) => element.setAttribute("visibility", "hidden"));
    for (const { name, element } of shown.sort((a, b) => first(b.name) - first(a.name))) {
      const T = pose(name);
      const [right, down] = place([T[3], T[7], T[11]]) || [-1, -1];
      const [x, y] = [right * canvas.clientWidth + 6, down * canvas.clientHeight - 6];
      const width = name.length * LETTER.width;
      const isFree = taken.every(
        (other) =>
          Math.abs(other.y - y) > LETTER.height || x > other.x + other.width || other.x > x + width,
      );
      if (right > 0 && isFree) {
        taken.push({ x, y, width });
        element.setAttribute("transform", `translate(${x} ${y})`);
        element.setAttribute("visibility", "visible");
      }
    }
  };

  // --- What a link is ---
  const links = /** @type {HTMLSelectElement} */ (find("links"));
  const about = find("about");
  const rounded = (/** @type {number[]} */ values, /** @type {number} */ digits) =>
    values.map((value) => String(+value.toFixed(digits) + 0)).join(" ");
  const describe = () => {
    const T = poses.get(selected);
    if (!T) {
      about.textContent = "";
      return;
    }
    const angles = Transforms.rpy(T).map((value) => (value * 180) / Math.PI);
    const joint = parents.get(selected);
    const position = rounded([T[3], T[7], T[11]], 4);
    const holder = joint ? `; ${joint.type} joint ${joint.name}, from ${joint.parent}` : "";
    about.textContent = `${selected} at ${position} m, rpy ${rounded(angles, 1)}° in ${robot.frame}${holder}`;
  };
  const select = (/** @type {string} */ link) => {
    selected = link;
    links.value = link;
    describe();
    redraw();
  };
  for (const { name } of robot.links) {
    links.append(new Option(name, name));
  }
  links.addEventListener("change", () => select(links.value));
  /** Return the link whose shape is seen at parts of the size of the canvas; empty if none is. */
  const linkAt = (/** @type {number} */ x, /** @type {number} */ y) => {
    const { right, up, back, eye, scale } = sight();
    const [across, above] = [(2 * x - 1) / scale[0], (1 - 2 * y) / scale[1]];
    const ray = right.map((value, k) => across * value + above * up[k] - back[k]);
    const nearest = { link: "", distance: Infinity };
    for (const link of robot.links) {
      for (const { shape, at: T } of shapesOf(link)) {
        const shrunk = (/** @type {Vector} */ v) =>
          v.map((value, k) => value / (shape.size[k] || 1e-6));
        const start = shrunk(Transforms.apply(Transforms.inverse(T), eye));
        const distance = Shapes.hit(shape.kind, start, shrunk(Transforms.unrotate(T, ray)));
        if (distance < nearest.distance) {
          [nearest.link, nearest.distance] = [link.name, distance];
        }
      }
    }
    return nearest.link;
  };

  // --- Pointer and keys ---
  const orbit = (/** @type {number} */ yaw, /** @type {number} */ pitch) => {
    camera.yaw += yaw;
    camera.pitch = Math.max(-1.57, Math.min(1.57, camera.pitch + pitch));
  };
  const zoom = (/** @type {number} */ factor) => {
    camera.zoom = Math.max(0.05, Math.min(20, camera.zoom * factor));
  };
  const pan = (/** @type {number} */ right, /** @type {number} */ up) => {
    camera.right += right * camera.zoom;
    camera.up += up * camera.zoom;
  };
  /** @type {Map<number, number[]>} */
  const pointers = new Map();
  let travelled = 0;
  const stage = /** @type {HTMLElement} */ (canvas.parentElement); // the pins are above the canvas
  const linkUnder = (/** @type {PointerEvent} */ { clientX, clientY }) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    return linkAt((clientX - left) / width, (clientY - top) / height);
  };
  const pointTo = (/** @type {string} */ link) => {
    if (link !== pointed) {
      pointed = link;
      redraw();
    }
  };
  stage.addEventListener("pointerdown", (event) => {
    travelled = pointers.size ? Infinity : 0;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  stage.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      pointTo(linkUnder(event));
      return;
    }
    const now = [event.clientX, event.clientY];
    const [right, down] = [now[0] - before[0], now[1] - before[1]];
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    const part = 1.2 / canvas.clientWidth;
    travelled += Math.abs(right) + Math.abs(down);
    if (travelled > 4) {
      stage.setPointerCapture(event.pointerId); // else a pin is clicked
    }
    if (other) {
      const apart = (/** @type {number[]} */ p) =>
        Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      zoom(apart(before) / apart(now));
      pan((-right * part) / 2, (down * part) / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      pan(-right * part, down * part);
    } else {
      orbit(-right * 0.008, down * 0.008);
    }
    pointers.set(event.pointerId, now);
    redraw();
  });
  stage.addEventListener("pointerup", (event) => {
    if (pointers.delete(event.pointerId) && travelled < 4 && event.target === canvas) {
      select(linkUnder(event));
    }
  });
  stage.addEventListener("pointerleave", () => pointTo(""));
  stage.addEventListener("pointercancel", (event) => pointers.delete(event.pointerId));
  stage.addEventListener("dragstart", (event) => event.preventDefault());
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  const onWheel = (/** @type {WheelEvent} */ event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
    redraw();
  };
  stage.addEventListener("wheel", onWheel, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const way = turn[/** @type {keyof turn} */ (event.key)];
    if (event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    if (way && event.shiftKey) {
      pan(0.05 * way[0], 0.05 * way[1]);
    } else if (way) {
      orbit(0.1 * way[0], 0.1 * way[1]);
    } else if (event.key === "+" || event.key === "=") {
      zoom(0.9);
    } else if (event.key === "-") {
      zoom(1 / 0.9);
    } else if (event.key === "Home") {
      reset();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation(); // in a review, letters and signs are keys everywhere else
    redraw();
  });

  // --- Drive: it comes to rest on the ground, then its wheels turn ---
  const driving = find("drive");
  let began = 0; // when, in milliseconds
  const driveTo = (/** @type {number} */ seconds) => {
    if (!drive) {
      return true;
    }
    const { pose, turned, isOver } = Drive.after(drive, ground, size, seconds);
    carried = pose;
    for (const joint of drive.joints) {
      positions.set(joint, (START.get(joint) || 0) + turned);
    }
    render();
    return isOver;
  };
  const tick = (/** @type {number} */ now) => {
    if (began && !driveTo((now - began) / 1000)) {
      requestAnimationFrame(tick);
    }
  };
  /** Put the robot back where it is drawn. */
  const stop = () => {
    if (!began) {
      return;
    }
    began = 0;
    carried = Transforms.IDENTITY;
    for (const joint of drive?.joints || []) {
      positions.set(joint, START.get(joint) || 0);
    }
    driving.setAttribute("aria-pressed", "false");
    describe();
    redraw();
  };
  driving.hidden = !drive;
  driving.addEventListener("click", () => {
    if (began || !drive) {
      stop();
      return;
    }
    reset();
    began = performance.now();
    driving.setAttribute("aria-pressed", "true");
    about.textContent = drive.text;
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    tick(isStill ? Infinity : began);
  });

  // --- Joints ---
  /** @type {Map<string, (position: number) => void>} */
  const sliders = new Map();
  /** @template {keyof HTMLElementTagNameMap} Tag @param {Tag} tag */
  const make = (tag) => document.createElement(tag);
  const update = () => {
    poses = Kinematics.poses(robot, positions);
    describe();
    redraw();
  };
  const addSlider = (/** @type {Joint} */ joint, /** @type {number[]} */ [lower, upper]) => {
    const [factor, unit] = joint.type === "prismatic" ? [1000, " mm"] : [180 / Math.PI, "°"];
    const [label, name] = [make("label"), make("span")];
    const [input, output] = [make("input"), make("output")];
    name.textContent = name.title = joint.name;
    input.type = "range";
    input.step = "any";
    input.min = String(lower * factor);
    input.max = String(upper * factor);
    input.disabled = lower === upper;
    const set = (/** @type {number} */ position) => {
      positions.set(joint.name, position);
      output.textContent = rounded([position * factor], 1) + unit;
    };
    const show = (/** @type {number} */ position) => {
      input.value = String(position * factor);
      set(position);
    };
    input.addEventListener("input", () => {
      stop();
      set(Number(input.value) / factor);
      update();
    });
    show(joint.start || 0);
    label.append(name, input, output);
    find("joints").append(label);
    sliders.set(joint.name, show);
  };
  for (const joint of byName.values()) {
    if (joint.range) {
      addSlider(joint, joint.range);
    }
  }

  // --- Buttons ---
  const move = (/** @type {string} */ joint, /** @type {number} */ position) => {
    const show = sliders.get(joint);
    if (show) {
      show(position);
      update();
    }
  };
  /** Put the robot at a pose: the page has moved its joints. @param {Pose} at */
  const carry = (at) => {
    stop();
    carried = at;
    update();
  };
  const reset = () => {
    stop();
    Object.assign(camera, HOME);
    for (const [name, position] of START) {
      move(name, position);
    }
    select("");
  };
  find("reset").addEventListener("click", reset);
  for (const name of /** @type {const} */ (["ghost", "frames"])) {
    const button = find(name);
    button.hidden = name === "ghost" && !bodies.length && !axes.length;
    button.setAttribute("aria-pressed", String(shows[name]));
    button.addEventListener("click", () => {
      shows[name] = !shows[name];
      button.setAttribute("aria-pressed", String(shows[name]));
      redraw();
    });
  }
  for (const link of document.querySelectorAll(".card a.pin")) {
    const number = Number(link.lastChild?.textContent);
    const pin = pins.find((one) => one.number === number);
    if (pin) {
      link.addEventListener("click", () => select(pin.link));
    }
  }
  const scheme = matchMedia("(prefers-color-scheme: dark)");
  scheme.addEventListener("change", redraw);
  const resizing = new ResizeObserver(redraw);
  resizing.observe(canvas);
  canvas.addEventListener("webglcontextlost", () => {
    box.hidden = true;
  });
  /** Release what the robot takes, before another one is shown. */
  const close = () => {
    stop();
    scheme.removeEventListener("change", redraw);
    resizing.disconnect();
    cancelAnimationFrame(asked);
    gl.getExtension("WEBGL_lose_context")?.loseContext();
  };
  render();
  return {
    ...{ camera, positions, move, select, render, reset, sliders, close, driveTo, stop },
    ...{ solid, solids, failed, recorded, carry, pose },
    poses: () => poses,
  };
}

let RobotView = showRobot();

"use strict";
/* Solids of size 1 as triangles: each vertex has x, y, z, the normal, and 0. Edges are two triangles for each line: each vertex has
   one end, the other end, and on which side of the line it is, 1 or -1. The shader gives them their width. */
const SIDES = 40;
const ring = (count) => Array.from({ length: count + 1 }, (_, k) => [Math.cos((2 * Math.PI * k) / count), Math.sin((2 * Math.PI * k) / count)]);

function quad(a, b, c, d, normal) {
  return [a, b, c, a, c, d].flatMap((point) => [...point, ...normal, 0]);
}

function line(...points) {
  return points.slice(1).flatMap((end, k) => {
    const start = points[k], [a, b, c, d] = [[...start, ...end, 1], [...start, ...end, -1], [...end, ...start, 1], [...end, ...start, -1]];
    return [...a, ...b, ...c, ...a, ...c, ...d];
  });
}

function boxSolid() {
  const faces = [], edges = [], h = 0.5;
  for (const axis of [0, 1, 2]) {
    for (const side of [-h, h]) {
      const corner = (u, v) => { const p = [0, 0, 0]; p[axis] = side; p[(axis + 1) % 3] = u; p[(axis + 2) % 3] = v; return p; };
      const normal = [0, 0, 0];
      normal[axis] = 2 * side;
      faces.push(...quad(corner(-h, -h), corner(h, -h), corner(h, h), corner(-h, h), normal));
    }
    for (const [u, v] of [[-h, -h], [-h, h], [h, -h], [h, h]]) {
      const end = (w) => { const p = [0, 0, 0]; p[axis] = w; p[(axis + 1) % 3] = u; p[(axis + 2) % 3] = v; return p; };
      edges.push(...line(end(-h), end(h)));
    }
  }
  return { faces, edges };
}

function cylinderSolid() {
  const faces = [], edges = [], round = ring(SIDES), h = 0.5;
  for (let k = 0; k < SIDES; k += 1) {
    const [[x, y], [u, v]] = [round[k], round[k + 1]];
    for (const [p, q, r] of [[[x, y, -h], [u, v, -h], [u, v, h]], [[x, y, -h], [u, v, h], [x, y, h]]]) {
      faces.push(...[p, q, r].flatMap((point) => [...point, point[0], point[1], 0, 0]));
    }
    for (const z of [-h, h]) {
      faces.push(...[[0, 0, z], [x, y, z], [u, v, z]].flatMap((point) => [...point, 0, 0, 2 * z, 0]));
      edges.push(...line([x, y, z], [u, v, z]));
    }
  }
  return { faces, edges };
}

function sphereSolid() {
  const faces = [], edges = [], round = ring(SIDES), half = SIDES / 2;
  const at = (k, m) => { const [c, s] = round[m % SIDES], up = Math.PI * (k / half - 0.5); return [c * Math.cos(up), s * Math.cos(up), Math.sin(up)]; };
  for (let k = 0; k < half; k += 1) {
    for (let m = 0; m < SIDES; m += 1) {
      const [a, b, c, d] = [at(k, m), at(k, m + 1), at(k + 1, m + 1), at(k + 1, m)];
      faces.push(...[a, b, c, a, c, d].flatMap((point) => [...point, ...point, 0]));
    }
  }
  for (const [one, other] of [[0, 1], [1, 2], [2, 0]]) {
    edges.push(...line(...round.map(([c, s]) => { const p = [0, 0, 0]; p[one] = c; p[other] = s; return p; })));
  }
  return { faces, edges };
}

/* An arrow of length 1 along x in the plane z = 0, and a cross of the same size. */
function arrowSolid() {
  const up = [0, 0, 1];
  const faces = quad([0, -0.12, 0], [0.55, -0.12, 0], [0.55, 0.12, 0], [0, 0.12, 0], up);
  faces.push(...[[0.55, -0.34, 0], [1, 0, 0], [0.55, 0.34, 0]].flatMap((point) => [...point, ...up, 0]));
  const outline = [[0, -0.12, 0], [0.55, -0.12, 0], [0.55, -0.34, 0], [1, 0, 0], [0.55, 0.34, 0], [0.55, 0.12, 0], [0, 0.12, 0]];
  return { faces, edges: line(...outline, outline[0]) };
}

function crossSolid() {
  const up = [0, 0, 1];
  const bar = (s) => quad([-0.45, -0.35 * s, 0], [-0.35, -0.45 * s, 0], [0.45, 0.35 * s, 0], [0.35, 0.45 * s, 0], up);
  return { faces: [...bar(1), ...bar(-1)], edges: [...line([-0.4, -0.4, 0], [0.4, 0.4, 0]), ...line([-0.4, 0.4, 0], [0.4, -0.4, 0])] };
}

function gridSolid() {
  const edges = [];
  for (let k = -10; k <= 10; k += 1) edges.push(...line([k / 10, -1, 0], [k / 10, 1, 0]), ...line([-1, k / 10, 0], [1, k / 10, 0]));
  return { faces: quad([-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1]), edges };
}

/* The distance at which a ray, in the frame of a solid, enters it; Infinity if it does not. */
const meeting = {
  box(start, way) {
    let near = -Infinity, far = Infinity;
    for (const k of [0, 1, 2]) {
      const one = (-0.5 - start[k]) / way[k], other = (0.5 - start[k]) / way[k];
      near = Math.max(near, Math.min(one, other));
      far = Math.min(far, Math.max(one, other));
    }
    return near <= far ? near : Infinity;
  },
  sphere: (start, way) => firstRoot(way, start, 3)[0],
  cylinder(start, way) {
    const [near, far] = firstRoot(way, start, 2), one = (-0.5 - start[2]) / way[2], other = (0.5 - start[2]) / way[2];
    const enter = Math.max(near, Math.min(one, other)), leave = Math.min(far, Math.max(one, other));
    return enter <= leave ? enter : Infinity;
  },
};

function firstRoot(way, start, size) {
  let a = 0, b = 0, c = -1;
  for (let k = 0; k < size; k += 1) { a += way[k] ** 2; b += way[k] * start[k]; c += start[k] ** 2; }
  const inside = b * b - a * c;
  if (inside < 0) return [Infinity, -Infinity];
  return a ? [(-b - Math.sqrt(inside)) / a, (-b + Math.sqrt(inside)) / a] : [-Infinity, Infinity];
}

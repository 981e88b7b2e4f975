"use strict";
// What the three views outline of the reference, as bodies in space. It is read from the drawing in
// the page, because the page must hold no more of the reference than the drawing shows.

/** @typedef {{u: number, v: number}} Point A point of a view in metres: to the right, and up. */
/** @typedef {{start: Point, end: Point}} Segment */
/**
 * A view: its element, and which axes of the frame point to the right and up.
 * @typedef {{element: Element, u: number, v: number, x: number, y: number}} View
 */
/** @typedef {{normal: Vector, limit: number}} HalfSpace The points with normal * point <= limit. */

const Ghost = {
  AXES: [
    [0, 1],
    [0, 2],
    [1, 2],
  ], // of the views from above, from the side and from the front
  PIXEL: 0.35, // how far a length may be off that two views show, which have tenths of a pixel
  MAX_BODIES: 60,

  /** Return the numbers in a text. @param {string | null} text */
  numbers(text) {
    return (text || "").match(/-?\d[\d.]*(?:e[-+]?\d+)?/g)?.map(Number) || [];
  },

  /** Return numbers as pairs. @param {number[]} values @returns {number[][]} */
  pairs(values) {
    return values.flatMap((value, i) => (i % 2 ? [[values[i - 1], value]] : []));
  },

  /** Return the least and the largest value. @param {number[]} values */
  extent(values) {
    const first = [Infinity, -Infinity];
    return values.reduce(([low, high], one) => [Math.min(low, one), Math.max(high, one)], first);
  },

  /**
   * Return the views of a drawing, and their pixels per metre; null if the robot is too small in it.
   * @param {Element} drawing
   * @param {Vector[]} points of the frame, whose extent is that of the shapes in the drawing
   * @returns {{views: View[], scale: number} | null}
   */
  views(drawing, points) {
    const elements = [...drawing.children].filter((one) => one.localName === "g").slice(0, 3);
    const sums = { pixels: 0, metres: 0 };
    const middles = elements.map((element, number) => {
      const shapes = [...element.querySelectorAll("polygon.edge")];
      const drawn = Ghost.pairs(shapes.flatMap((one) => Ghost.numbers(one.getAttribute("points"))));
      return Ghost.AXES[number].map((axis, k) => {
        const [left, right] = Ghost.extent(drawn.map((pair) => pair[k]));
        const [low, high] = Ghost.extent(points.map((point) => point[axis]));
        sums.pixels += right - left;
        sums.metres += high - low;
        return [(left + right) / 2, (low + high) / 2];
      });
    });
    const scale = sums.pixels / sums.metres;
    if (!(sums.pixels > 20 && scale < Infinity)) {
      return null;
    }
    const views = elements.map((element, number) => {
      const [[x, u], [y, v]] = middles[number];
      const [right, up] = Ghost.AXES[number];
      return { element, u: right, v: up, x: x - scale * u, y: y + scale * v };
    });
    return { views, scale };
  },

  /**
   * Return the points of a path of a view in metres.
   * @param {Element} path
   * @param {View} view
   * @param {number} scale
   * @returns {Point[]}
   */
  points(path, view, scale) {
    const pairs = Ghost.pairs(Ghost.numbers(path.getAttribute("d")));
    return pairs.map(([x, y]) => ({ u: (x - view.x) / scale, v: (view.y - y) / scale }));
  },

  /**
   * Return the bodies that have the outlines of the three views: the triangles of each, six numbers
   * a corner as in `Shapes`, its middle and its extents along x, y and z.
   * @param {View[]} views
   * @param {number} scale
   */
  bodies(views, scale) {
    const near = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
      Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) < (2 * Ghost.PIXEL) / scale;
    const [tops, sides, fronts] = views.map((view) =>
      [...view.element.querySelectorAll("path.reference")].map((path) => {
        const points = Ghost.points(path, view, scale);
        const [u, v] = [points.map((p) => p.u), points.map((p) => p.v)].map(Ghost.extent);
        return { points, u, v };
      }),
    );
    /** @type {{middle: Vector, triangles: number[], extents: number[][], corners: number}[]} */
    const bodies = [];
    for (const top of tops) {
      for (const side of sides.filter((one) => near(one.u, top.u))) {
        for (const front of fronts.filter((one) => near(one.u, top.v) && near(one.v, side.v))) {
          const extents = [top.u, top.v, side.v];
          const corners = top.points.length + side.points.length + front.points.length;
          // two parts of the reference whose outlines differ by a tenth of a pixel are shown once
          const isShown = bodies.some(
            (one) =>
              Math.abs(one.corners - corners) < 9 &&
              one.extents.every((extent, k) => near(extent, extents[k])),
          );
          if (bodies.length < Ghost.MAX_BODIES && !isShown) {
            const middle = extents.map(([low, high]) => (low + high) / 2);
            const outlines = [top.points, side.points, front.points];
            const triangles = Ghost.sphere(outlines, extents) || Ghost.hull(outlines, scale);
            bodies.push({ middle, triangles, extents, corners });
          }
        }
      }
    }
    return bodies;
  },

  /**
   * Return a sphere if three outlines are circles, else null.
   * @param {Point[][]} outlines
   * @param {number[][]} extents along x, y and z
   */
  sphere(outlines, extents) {
    const radii = extents.map(([low, high]) => (high - low) / 2);
    const isRound = outlines.every((points) => points.length > 20);
    if (!isRound || Math.max(...radii) > 1.05 * Math.min(...radii)) {
      return null;
    }
    return Shapes.sphere().map((value, i) => {
      const [low, high] = extents[i % 3];
      return i % 6 < 3 ? (low + high) / 2 + radii[0] * value : value;
    });
  },

  /**
   * Return the body whose outlines are those of the views, as large as it can be.
   * @param {Point[][]} outlines
   * @param {number} scale
   */
  hull(outlines, scale) {
    const spaces = outlines.flatMap((points, view) => Ghost.halfSpaces(points, view, scale));
    const reach = 10 * Math.max(1 / scale, ...spaces.map((one) => Math.abs(one.limit)));
    /** @type {number[]} */
    const numbers = [];
    spaces.forEach((space, i) => {
      let face = Ghost.square(space, reach);
      spaces.forEach((other, j) => {
        if (i !== j) {
          face = Ghost.clip(face, space, other, j < i);
        }
      });
      if (face.length > 2) {
        numbers.push(...Shapes.triangles([face], () => space.normal));
      }
    });
    return numbers;
  },

  /**
   * Return the half-spaces that a convex outline of a view leaves.
   * @param {Point[]} points
   * @param {number} view its number
   * @param {number} scale
   * @returns {HalfSpace[]}
   */
  halfSpaces(points, view, scale) {
    const [u, v] = Ghost.AXES[view];
    let corners = points;
    if (corners.length < 3) {
      // a plate that is seen edge-on: a third of a pixel makes it a rectangle
      const thin = Ghost.PIXEL / scale / 2;
      const [left, right] = Ghost.extent(points.map((p) => p.u));
      const [low, high] = Ghost.extent(points.map((p) => p.v));
      const [a, b, c, d] = [left - thin, right + thin, low - thin, high + thin];
      corners = [
        { u: a, v: c },
        { u: b, v: c },
        { u: b, v: d },
        { u: a, v: d },
      ];
    }
    const middle = { u: 0, v: 0 };
    for (const corner of corners) {
      middle.u += corner.u / corners.length;
      middle.v += corner.v / corners.length;
    }
    return corners.map((p, i) => {
      const q = corners[(i + 1) % corners.length];
      const length = Math.hypot(q.u - p.u, q.v - p.v) || 1;
      let [right, up] = [(q.v - p.v) / length, (p.u - q.u) / length];
      if (right * (middle.u - p.u) + up * (middle.v - p.v) > 0) {
        [right, up] = [-right, -up];
      }
      const normal = [0, 0, 0];
      normal[u] = right;
      normal[v] = up;
      return { normal, limit: right * p.u + up * p.v };
    });
  },

  /** Return a large square in the plane of a half-space. @param {HalfSpace} space @param {number} reach */
  square({ normal, limit }, reach) {
    const least = normal.map(Math.abs).indexOf(Math.min(...normal.map(Math.abs)));
    const other = [0, 0, 0];
    other[least] = 1;
    const zero = [0, 0, 0];
    const one = Shapes.across(zero, normal, other);
    const two = Shapes.across(zero, normal, one);
    return [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([a, b]) => normal.map((value, k) => value * limit + reach * (a * one[k] + b * two[k])));
  },

  /**
   * Return the part of a face of one half-space that is in another one. Of faces in the same plane
   * the first remains.
   * @param {Vector[]} face
   * @param {HalfSpace} own
   * @param {HalfSpace} other
   * @param {boolean} isLater
   */
  clip(face, own, other, isLater) {
    if (Transforms.dot(own.normal, other.normal) > 1 - 1e-6) {
      const excess = own.limit - other.limit;
      return excess > 1e-9 || (isLater && excess > -1e-9) ? [] : face;
    }
    /** @type {Vector[]} */
    const part = [];
    face.forEach((p, i) => {
      const q = face[(i + 1) % face.length];
      const a = Transforms.dot(other.normal, p) - other.limit;
      const b = Transforms.dot(other.normal, q) - other.limit;
      if (a <= 0) {
        part.push(p);
      }
      if (a * b < 0) {
        part.push(p.map((value, k) => value + ((q[k] - value) * a) / (a - b)));
      }
    });
    return part;
  },

  /**
   * Return the axes of the frames of the reference: their names and both ends.
   * @param {View[]} views
   * @param {number} scale
   */
  axes(views, scale) {
    const found = new Map();
    const tolerance = (2 * Ghost.PIXEL) / scale;
    const starts = views.map((view) =>
      [...view.element.querySelectorAll("path.dashed")].map(
        (path) => Ghost.points(path, view, scale)[0],
      ),
    );
    for (const name of ["x", "y", "z"]) {
      const segments = views.map((view) =>
        [...view.element.querySelectorAll(`path.axis-${name}.dashed`)].map((path) => {
          const [start, end] = Ghost.points(path, view, scale);
          return { start, end };
        }),
      );
      for (const [one, two, third] of [
        [0, 1, 2],
        [0, 2, 1],
        [1, 2, 0],
      ]) {
        for (const first of segments[one]) {
          for (const second of segments[two]) {
            const ends = Ghost.join(first, views[one], second, views[two], tolerance);
            if (ends && Ghost.hasStart(starts[third], ends[0], views[third], tolerance)) {
              found.set(name + ends.flat().map((value) => Math.round(value / tolerance / 2)), {
                name,
                ends,
              });
            }
          }
        }
      }
    }
    return [...found.values()];
  },

  /**
   * Return whether a view shows a frame at a point: it shows two axes of each frame at least.
   * @param {Point[]} starts
   * @param {Vector} point
   * @param {View} view
   * @param {number} tolerance
   */
  hasStart(starts, point, view, tolerance) {
    return starts.some(
      ({ u, v }) => Math.abs(u - point[view.u]) + Math.abs(v - point[view.v]) < 2 * tolerance,
    );
  },

  /**
   * Return the ends of a segment that two views show; null if they show different ones.
   * @param {Segment} first
   * @param {View} one
   * @param {Segment} second
   * @param {View} two
   * @param {number} tolerance
   * @returns {Vector[] | null}
   */
  join(first, one, second, two, tolerance) {
    const ends = [];
    for (const end of /** @type {const} */ (["start", "end"])) {
      const point = [NaN, NaN, NaN];
      point[one.u] = first[end].u;
      point[one.v] = first[end].v;
      for (const [axis, value] of [
        [two.u, second[end].u],
        [two.v, second[end].v],
      ]) {
        if (Math.abs(point[axis] - value) > tolerance) {
          return null;
        }
        point[axis] = value;
      }
      ends.push(point);
    }
    return ends;
  },

  /**
   * Return the points of the numbers in the views, in the order of the numbers.
   * @param {View[]} views
   * @param {number} scale
   */
  marks(views, scale) {
    const [tops, sides] = views.map((view) =>
      [...view.element.querySelectorAll("path.leader")].map(
        (path) => Ghost.points(path, view, scale)[0],
      ),
    );
    return tops.map((top, i) => [top.u, top.v, sides[i].v]);
  },
};

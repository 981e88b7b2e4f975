"use strict";
/* The motion of a base whose wheels turn by angles and roll without slip, in the frame of the ground, averaged over the wheels. */
function rolled(wheels, ground, angles) {
  const moving = wheels.map((wheel, k) => ({ ...wheel, angle: angles[k] })).filter((wheel) => wheel.travel), back = inverse(ground);
  if (!moving.length) return IDENTITY;
  const points = moving.map((wheel) => apply(back, wheel.centre));
  const ways = moving.map((wheel) => rotate(back, wheel.travel).map((value) => value * wheel.reach * wheel.angle));
  const mean = (vectors) => [0, 1].map((k) => vectors.reduce((sum, vector) => sum + vector[k], 0) / vectors.length);
  const middle = mean(points), motion = mean(ways);
  let spin = 0, spread = 0;
  points.forEach((point, k) => {
    const [x, y] = [point[0] - middle[0], point[1] - middle[1]];
    spin += x * ways[k][1] - y * ways[k][0];
    spread += x * x + y * y;
  });
  const step = turned([0, 0, 1], spread > 1e-9 ? spin / spread : 0), arm = rotate(step, [-middle[0], -middle[1], 0]);
  return [...step.slice(0, 9), arm[0] + middle[0] + motion[0], arm[1] + middle[1] + motion[1], 0];
}

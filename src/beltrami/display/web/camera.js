// A camera that turns around a point, for a mesh that fits into the unit ball around 0.

import { add, cross, lookAt, perspective, scaled, times } from "./vectors.js";

const ANGLE = 0.61; // of view, in radians
const NEAREST = 0.3;
const FARTHEST = 30;
const STEEPEST = 1.5; // elevation, in radians

// Right, up and towards the viewer at first: the same frames as framing.py.
const FRAMES = {
  x: [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
  y: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  z: [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
};

export function startCamera(up, planar) {
  const [azimuth, elevation] = planar ? [0, 0] : [Math.PI / 6, Math.PI / 9];
  return { up, azimuth, elevation, distance: 3.5, target: [0, 0, 0] };
}

function clamp(x, low, high) {
  return Math.min(Math.max(x, low), high);
}

export function turned(camera, right, up) {
  const elevation = clamp(camera.elevation + up, -STEEPEST, STEEPEST);
  return { ...camera, azimuth: camera.azimuth + right, elevation };
}

export function zoomed(camera, factor) {
  return { ...camera, distance: clamp(camera.distance * factor, NEAREST, FARTHEST) };
}

// Move the target by parts of the height of the picture.
export function panned(camera, right, up) {
  const { x, y } = axesOf(camera);
  const size = 2 * camera.distance * Math.tan(ANGLE / 2);
  const step = add(scaled(x, -right * size), scaled(y, -up * size));
  return { ...camera, target: add(camera.target, step) };
}

// Unit vectors to the right, up and towards the eye.
export function axesOf({ up, azimuth, elevation }) {
  const [right, top, front] = FRAMES[up];
  const level = Math.cos(elevation);
  const z = add(
    add(scaled(right, Math.sin(azimuth) * level), scaled(top, Math.sin(elevation))),
    scaled(front, Math.cos(azimuth) * level),
  );
  const x = add(scaled(right, Math.cos(azimuth)), scaled(front, -Math.sin(azimuth)));
  return { x, y: cross(z, x), z };
}

// A picture that is higher than wide gets a larger angle, so that the unit ball fits.
export function matrixOf(camera, aspect) {
  const { x, y, z } = axesOf(camera);
  const eye = add(camera.target, scaled(z, camera.distance));
  const angle = aspect < 1 ? 2 * Math.atan(Math.tan(ANGLE / 2) / aspect) : ANGLE;
  const near = Math.max(camera.distance / 100, camera.distance - 6);
  const lens = perspective(angle, aspect, near, camera.distance + 8);
  return { matrix: times(lens, lookAt(eye, camera.target, y)), eye, axes: { x, y, z } };
}

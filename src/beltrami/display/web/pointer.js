// Mouse, touch and keys on the picture: turn, move, zoom, and choose a point.

import { panned, turned, zoomed } from "./camera.js";

const STEP = Math.PI / 36;
const STILL = 5; // pixels that a finger may move in a tap

// act: {move(change of the camera), tap(x, y) in pixels of the page, middle(), reset()}
export function listen(canvas, act) {
  const held = new Map();
  let travelled = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    travelled = held.size === 1 ? 0 : Infinity;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    const height = canvas.clientHeight;
    if (held.size === 2) twoFingers(held, event.pointerId, now, height, act);
    else if (event.shiftKey || event.buttons & 6) {
      act.move((camera) => panned(camera, dx / height, -dy / height));
    } else act.move((camera) => turned(camera, (-4 * dx) / height, (4 * dy) / height));
    held.set(event.pointerId, now);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (held.size === 1 && travelled < STILL) act.tap(event.clientX, event.clientY);
    held.delete(event.pointerId);
  });
  canvas.addEventListener("pointercancel", (event) => held.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      act.move((camera) => zoomed(camera, Math.exp(event.deltaY * lines * 0.0012)));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => pressed(event, act));
}

function twoFingers(held, moving, now, height, act) {
  const [other] = [...held].filter(([id]) => id !== moving).map(([, place]) => place);
  const before = held.get(moving);
  const apart = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
  const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
  act.move((camera) => {
    const closer = zoomed(camera, apart(before) / apart(now));
    return panned(closer, dx / height / 2, -dy / height / 2);
  });
}

function pressed(event, act) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const [right, up] = arrows[event.key] ?? [0, 0];
  if (right || up) {
    if (event.shiftKey) act.move((camera) => panned(camera, right / 20, up / 20));
    else act.move((camera) => turned(camera, right * STEP, up * STEP));
  } else if (event.key === "+" || event.key === "=") act.move((c) => zoomed(c, 0.9));
  else if (event.key === "-") act.move((c) => zoomed(c, 1 / 0.9));
  else if (event.key === "0") act.reset();
  else if (event.key === "Enter") act.middle();
  else return;
  event.preventDefault();
}

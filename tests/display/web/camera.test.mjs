import assert from "node:assert/strict";
import { test } from "node:test";
import * as cameras from "../../../src/beltrami/display/web/camera.js";
import { cross, dot, projected } from "../../../src/beltrami/display/web/vectors.js";

const near = (a, b, tolerance = 1e-5) => assert.ok(Math.abs(a - b) <= tolerance, `${a} ${b}`);

for (const up of ["x", "y", "z"]) {
  test(`axes are right-handed, and ${up} is up`, () => {
    const { x, y, z } = cameras.axesOf(cameras.startCamera(up, false));
    cross(x, y).forEach((value, i) => near(value, z[i]));
    assert.ok(y["xyz".indexOf(up)] > 0.9);
    near(dot(x, y), 0);
  });
}

test("the unit ball fits, in any format", () => {
  for (const aspect of [0.4, 1, 2.5]) {
    const { matrix, axes } = cameras.matrixOf(cameras.startCamera("y", false), aspect);
    for (const axis of [axes.x, axes.y]) {
      const [x, y, depth] = projected(matrix, axis);
      assert.ok(Math.abs(x) < 1 && Math.abs(y) < 1 && Math.abs(depth) < 1);
    }
  }
});

test("the target is in the middle, also after moving", () => {
  const moved = cameras.panned(cameras.startCamera("z", false), 0.2, -0.1);
  const [x, y] = projected(cameras.matrixOf(moved, 1.3).matrix, moved.target);
  near(x, 0);
  near(y, 0);
  // what was in the middle follows the pointer: by parts of the height
  const [left, top] = projected(cameras.matrixOf(moved, 1).matrix, [0, 0, 0]);
  near(left / 2, 0.2);
  near(top / 2, -0.1);
});

test("it does not turn over, nor go through the mesh", () => {
  const start = cameras.startCamera("y", false);
  assert.ok(cameras.turned(start, 0, 9).elevation < Math.PI / 2);
  assert.ok(cameras.zoomed(start, 0).distance > 0);
  assert.ok(cameras.zoomed(start, 1e9).distance < 100);
  assert.equal(start.distance, cameras.startCamera("y", false).distance);
});

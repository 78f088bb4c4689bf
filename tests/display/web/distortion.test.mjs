import assert from "node:assert/strict";
import { test } from "node:test";
import {
  distortionAtVertices, singularValues,
} from "../../../src/beltrami/display/web/distortion.js";

const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-6, `${a} ${b}`);
const X = [[0, 0, 0], [1, 0, 0], [0.3, 0.8, 0.4]];

test("an isometry has the values 1, and a similarity its factor", () => {
  const height = Math.hypot(0.8, 0.4);
  for (const s of [1, 3]) {
    const [large, small] = singularValues(X, [[0, 0], [s, 0], [0.3 * s, height * s]]);
    near(large, s);
    near(small, s);
  }
});

test("a stretch by 2 along one axis, turned and mirrored", () => {
  const height = Math.hypot(0.8, 0.4);
  const u = [[0, 0], [2, 0], [0.6, height]].map(([x, y]) => [y, x]);
  const [large, small] = singularValues(X, u);
  near(large, 2);
  near(small, 1);
});

test("means at vertices: areas over their mean, in powers of two", () => {
  const positions = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0]);
  const uv = Float32Array.from([0, 0, 1, 0, 0, 1, 5, 0, 8, 0, 5, 1]);
  const { angle, area } = distortionAtVertices(positions, [0, 1, 2, 3, 4, 5], uv);
  near(angle[0], 0);
  near(angle[3], Math.log2(3));
  near(area[0], Math.log2(1 / 2));
  near(area[4], Math.log2(3 / 2));
});

import assert from "node:assert/strict";
import { test } from "node:test";
import * as spectral from "../../../src/beltrami/display/web/spectral.js";

const near = (a, b, tolerance = 1e-12) => assert.ok(Math.abs(a - b) <= tolerance, `${a} ${b}`);

test("kernels", () => {
  near(spectral.heat(2)(3), Math.exp(-6));
  near(spectral.wave(2)(9), Math.cos(6));
  near(spectral.tikhonov(2)(3), 1 / 7);
  near(spectral.exaggerate(-1, 2)(3), Math.exp(-6)); // β = -1 is heat
  near(spectral.exaggerate(0, 2)(3), 1);
  near(spectral.exaggerate(2, 1)(1e9), 3);
});

test("terms of the regulariser are those of its minimum", () => {
  const [values, f, t, outside] = [[0, 1, 5], [2, -1, 3], 0.7, 0.5];
  const at = (h) => {
    const { far, rough } = spectral.regularizerTerms(values, f, h, outside);
    return far + t * rough;
  };
  const least = at(spectral.tikhonov(t));
  for (const bump of [-0.01, 0.01]) {
    for (const chosen of values) {
      assert.ok(at((x) => spectral.tikhonov(t)(x) + (x === chosen ? bump : 0)) > least);
    }
  }
  near(spectral.regularizerTerms(values, f, () => 0, outside).far, 4 + 1 + 9 + 0.25);
});

test("the first terms", () => {
  assert.deepEqual([...spectral.firstTerms(3, 2)], [1, 1, 0]);
  assert.deepEqual([...spectral.product([1, 2], [3, 4])], [3, 8]);
});

test("the lowest frequency is not zero", () => {
  assert.equal(spectral.lowest([0, 1e-15, 2, 3]), 2);
  assert.equal(spectral.lowest([0]), 1);
});

test("a drawn response is linear between its places", () => {
  assert.equal(spectral.interpolated([0, 2, 1], 0.25), 1);
  assert.equal(spectral.interpolated([0, 2, 1], 1), 1);
  assert.equal(spectral.interpolated([0, 2, 1], -3), 0);
});

test("strokes go both ways, leave the rest, and do not change their input", () => {
  const flat = new Float64Array(5).fill(1);
  const ends = [{ place: 0.25, value: 0 }, { place: 0.75, value: 2 }];
  assert.deepEqual([...spectral.stroked(flat, ends[0], ends[1])], [1, 0, 1, 2, 1]);
  assert.deepEqual([...spectral.stroked(flat, ends[1], ends[0])], [1, 0, 1, 2, 1]);
  assert.deepEqual([...spectral.stroked(flat, ends[1], ends[1])], [1, 1, 1, 2, 1]);
  assert.deepEqual([...flat], [1, 1, 1, 1, 1]);
});

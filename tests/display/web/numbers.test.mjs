import assert from "node:assert/strict";
import { test } from "node:test";
import { pieces } from "../../../src/beltrami/display/web/formula.js";
import { scale } from "../../../src/beltrami/display/web/plot.js";
import { decades, ticks, unitOf, written } from "../../../src/beltrami/display/web/ticks.js";
import { chosenMap, tableOf } from "../../../src/beltrami/display/web/colours.js";

test("numbers as people read them", () => {
  const cases = [
    [0, "0"], [1.5, "1.5"], [-2, "−2"], [0.0123456, "0.0123"], [1234.56, "1235"],
    [1.5e-7, "1.5·10⁻⁷"], [1e-5, "10⁻⁵"], [2e9, "2·10⁹"], [-3.25e12, "−3.25·10¹²"], [100, "100"],
  ];
  for (const [x, text] of cases) assert.equal(written(x), text);
});

test("ticks are round and inside", () => {
  assert.deepEqual(ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(ticks(-0.5, 2, 5).map((x) => x.toFixed(1)), ["-0.5", "0.0", "0.5", "1.0", "1.5", "2.0"]);
  assert.deepEqual(ticks(3, 3), [3]);
  assert.deepEqual(decades(0.05, 200), [0.1, 1, 10, 100]);
  assert.deepEqual(decades(0.3, 30), [1, 10]);
  assert.deepEqual(decades(3, 30), [5, 10, 20]);
  assert.deepEqual(decades(0.003, 0.009).map((x) => x.toFixed(3)), ["0.005"]);
  assert.ok(decades(1e-30, 1e30).length <= 6);
});

test("units", () => {
  assert.equal(unitOf("mm", 2), "mm²");
  assert.equal(unitOf("", -2), "1/length²");
  assert.equal(unitOf("mm", 1), "mm");
});

test("scales there and back", () => {
  for (const [low, high, log] of [[0, 5, false], [1e-3, 10, true]]) {
    const { place, value } = scale(low, high, log);
    assert.ok(Math.abs(value(place(2)) - 2) < 1e-12);
    assert.equal(place(low), 0);
  }
});

test("formulas nest", () => {
  assert.deepEqual(pieces("e^{−λ_i t}"), [
    { text: "e", level: 0 },
    {
      group: [{ text: "−λ", level: 0 }, { group: [{ text: "i", level: 0 }], level: -1 }, { text: " t", level: 0 }],
      level: 1,
    },
  ]);
  assert.throws(() => pieces("a_{b"));
});

test("colours", () => {
  assert.deepEqual([...tableOf("00ff10")], [0, 255, 16]);
  assert.equal(chosenMap("auto", [-2, 2]), "diverging");
  assert.equal(chosenMap("auto", [-1, 2]), "sequential");
  assert.equal(chosenMap("gray", [-2, 2]), "gray");
});

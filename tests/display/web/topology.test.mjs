import assert from "node:assert/strict";
import { test } from "node:test";
import {
  edgesOf, forEachPair, guessesOf, normalsOf, ringsOf,
} from "../../../src/beltrami/display/web/topology.js";
import { signDomains } from "../../../src/beltrami/display/web/domains.js";

const SQUARE = Int32Array.from([0, 1, 2, 0, 2, 3]);

test("pairs and edges", () => {
  const pairs = [];
  forEachPair(SQUARE, 4, (...pair) => pairs.push(pair));
  assert.deepEqual(pairs, [[0, 2, 3, 1]].map(([a, b, c, d]) => [a, b, ...pairs[0].slice(2)]));
  assert.deepEqual([...pairs[0].slice(2)].sort(), [1, 3]);
  assert.equal(edgesOf(SQUARE, 4).length, 10);
});

test("three faces at an edge make two pairs, and one edge", () => {
  const faces = Int32Array.from([0, 1, 2, 1, 0, 3, 0, 1, 4]);
  const pairs = [];
  forEachPair(faces, 5, (a, b, c, d) => pairs.push([a, b, c, d]));
  assert.equal(pairs.length, 2);
  assert.equal(edgesOf(faces, 5).length / 2, 7);
});

test("each vertex but the first is guessed from earlier ones alone", () => {
  const { start, plus, other, minus, count } = guessesOf(SQUARE, 4);
  assert.equal(count[0], 0);
  for (let v = 1; v < 4; v++) {
    assert.ok(count[v] > 0);
    for (let p = start[v]; p < start[v + 1]; p++) {
      for (const source of [plus[p], other[p], minus[p]]) assert.ok(source < v);
    }
  }
});

test("rings list the faces of each vertex in their direction", () => {
  const { start, corners } = ringsOf(SQUARE, 4);
  assert.deepEqual([...start], [0, 2, 3, 5, 6]);
  assert.deepEqual([...corners.slice(0, 4)], [1, 2, 2, 3]);
});

test("normals of a flat square", () => {
  const x = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
  assert.deepEqual([...normalsOf(x, SQUARE)], [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]);
});

test("regions of one sign", () => {
  const path = Int32Array.from([0, 1, 1, 2, 2, 3, 3, 4]);
  assert.equal(signDomains([1, 2, -1, -1, 3], path), 3);
  assert.equal(signDomains([1, 0, 1, 0, 0], path), 2); // zeros belong to none
});

import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import {
  facesOf, fromBase85, guessed, inflate, placed, residuals, summed,
} from "../../../src/beltrami/display/web/codes.js";
import { guessesOf } from "../../../src/beltrami/display/web/topology.js";

test("base 85, as Python's b85encode with a safe alphabet", () => {
  // base64.b85encode(bytes(range(8)), pad=True) is b'009C61O)~M'
  assert.deepEqual([...fromBase85("009C61O)~M", 8)], [0, 1, 2, 3, 4, 5, 6, 7]);
  // four words whose digits are written otherwise: <, >, & and the accent as , . : and /
  assert.deepEqual([...fromBase85(":#,)Xf.w)/H-T:2_;?/{", 16)], [207, 176, 180, 235, 130, 86, 139, 150, 55, 129, 107, 221, 248, 120, 33, 20]);
  assert.equal(fromBase85("009C61O)~M", 3).length, 3);
});

test("deflated bytes are inflated", async () => {
  const bytes = Uint8Array.from({ length: 5000 }, (_, i) => (i * i) & 255);
  assert.deepEqual(await inflate(new Uint8Array(deflateRawSync(bytes))), bytes);
});

test("planes of bytes become signed numbers", () => {
  const entries = [
    { name: "first", rows: 2, columns: 2, planes: 1 },
    { name: "second", rows: 2, columns: 1, planes: 2 },
  ];
  const bytes = Uint8Array.from([0, 1, 2, 3, 255, 1, 0, 1]);
  const sections = placed(entries);
  assert.deepEqual([...residuals(bytes, sections.get("first"), 0)], [0, -1]);
  assert.deepEqual([...residuals(bytes, sections.get("first"), 1)], [1, -2]);
  assert.deepEqual([...residuals(bytes, sections.get("second"), 0)], [-128, -129]);
  assert.deepEqual([...summed(Int32Array.from([1, 2, -4]))], [1, 3, -1]);
});

test("faces name new vertices by 0", () => {
  // (2, 0, 1), (3, 2, 1)
  const faces = facesOf([[-2, 0], [2, 1], [-1, 1]].map((c) => Int32Array.from(c)));
  assert.deepEqual([...faces], [2, 0, 1, 3, 2, 1]);
});

test("guesses round down, and use parallelograms", () => {
  const faces = Int32Array.from([2, 0, 1, 3, 2, 1]);
  const guesses = guessesOf(faces, 5);
  // 1 from 0; 2 from 0 and 1; 3 is 2 + 1 - 0; 4, alone, from 3
  const left = Int32Array.from([10, 5, -3, 2, 1]);
  assert.deepEqual([...guessed(left, guesses)], [10, 15, 9, 16, 17]);
  assert.deepEqual([...guessed(Int32Array.from([-1, 0, 0, 0, 0]), guesses)], [-1, -1, -1, -1, -1]);
});

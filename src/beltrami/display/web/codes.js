// Bytes of a page back to numbers: the other half of page_codes.py.

const ALPHABET =
  "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%:()*+-;,=.?@^_/{|}~";

// Five characters of base 85 are four bytes.
export function fromBase85(text, length) {
  const digit = new Uint8Array(128);
  for (let i = 0; i < 85; i++) digit[ALPHABET.charCodeAt(i)] = i;
  const words = new DataView(new ArrayBuffer((text.length / 5) * 4));
  for (let i = 0, at = 0; i < text.length; i += 5, at += 4) {
    let word = 0;
    for (let j = 0; j < 5; j++) word = word * 85 + digit[text.charCodeAt(i + j)];
    words.setUint32(at, word);
  }
  return new Uint8Array(words.buffer, 0, length);
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Where each section starts among all bytes.
export function placed(entries) {
  let start = 0;
  const sections = new Map();
  for (const entry of entries) {
    sections.set(entry.name, { ...entry, start });
    start += entry.rows * entry.columns * entry.planes;
  }
  return sections;
}

// The residuals of one column: 0, 1, 2, 3 ... stand for 0, -1, 1, -2 ...
export function residuals(bytes, section, column) {
  const { rows, columns, planes, start } = section;
  const result = new Int32Array(rows);
  for (let plane = planes - 1; plane >= 0; plane--) {
    const at = start + plane * rows * columns + column * rows;
    for (let i = 0; i < rows; i++) result[i] = (result[i] << 8) | bytes[at + i];
  }
  for (let i = 0; i < rows; i++) {
    const folded = result[i] >>> 0;
    result[i] = folded & 1 ? -((folded + 1) / 2) : folded / 2;
  }
  return result;
}

// Running sums, in place.
export function summed(numbers) {
  for (let i = 1; i < numbers.length; i++) numbers[i] += numbers[i - 1];
  return numbers;
}

// Residuals to values, in place, by the guesses of topology.js.
export function guessed(numbers, guesses) {
  const { start, plus, other, minus, count } = guesses;
  for (let v = 0; v < numbers.length; v++) {
    if (!count[v]) continue;
    let sum = 0;
    for (let p = start[v]; p < start[v + 1]; p++) {
      sum += numbers[plus[p]];
      if (other[p] >= 0) sum += numbers[other[p]] - numbers[minus[p]];
    }
    numbers[v] += Math.floor(sum / count[v]);
  }
  return numbers;
}

// Three columns of residuals to the corners of faces.
export function facesOf([first, second, third]) {
  const faces = new Int32Array(3 * first.length);
  let seen = -1;
  for (let f = 0; f < first.length; f++) {
    const a = seen + 1 - first[f];
    const b = a - second[f];
    faces.set([a, b, b - third[f]], 3 * f);
    if (a > seen) seen = a;
  }
  return faces;
}

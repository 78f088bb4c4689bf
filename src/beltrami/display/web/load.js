// The data of the page: what is small from JSON, what is large decoded, the rest when asked for.

import { facesOf, fromBase85, guessed, inflate, placed, residuals, summed } from "./codes.js";
import { edgesOf, guessesOf, normalsOf } from "./topology.js";

export async function load(document) {
  const header = JSON.parse(document.getElementById("header").textContent);
  const packed = document.getElementById("data");
  const bytes = await inflate(fromBase85(packed.textContent, Number(packed.dataset.length)));
  packed.remove();
  return { ...decoded(header, bytes), picture: await pictureFrom(header, bytes) };
}

// The texture, as it is in its file.
async function pictureFrom({ picture, sections }, bytes) {
  if (!picture) return null;
  const { start, rows } = placed(sections).get("picture");
  const file = new Blob([bytes.subarray(start, start + rows)], { type: picture.kind });
  return createImageBitmap(file, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
}

export function decoded(header, bytes) {
  const sections = placed(header.sections);
  const columns = (name) => {
    const section = sections.get(name);
    return Array.from({ length: section.columns }, (_, c) => residuals(bytes, section, c));
  };
  const { n } = header;
  const faces = facesOf(columns("faces"));
  const guesses = guessesOf(faces, n);
  const raw = columns("positions").map((column) => guessed(column, guesses));
  const frame = frameOf(raw, header);
  const base = interleaved(raw.map((c, i) => Float32Array.from(c, (q) => frame.toView(q, i))));
  const functions = columns("functions").map((column, i) => ({
    ...header.functions[i],
    values: scaledBy(guessed(column, guesses), header.functions[i].step, header.functions[i].low),
  }));
  const levels = new Map();
  return {
    header, n, faces, frame, base, functions,
    edges: edgesOf(faces, n),
    normals: normalsOf(base, faces),
    numbers: summed(columns("numbers")[0]),
    spectra: header.spectra,
    levelsOf(spectrum) {
      if (!levels.has(spectrum.section)) {
        const decodedLevels = columns(spectrum.section).map((c) => guessed(c, guesses));
        levels.set(spectrum.section, decodedLevels);
      }
      return levels.get(spectrum.section);
    },
    moved: (name, step) => interleaved(columns(name).map((c) => scaledBy(c, step, 0))),
    maps: [["plane", ""], ["own", "own "]]
      .filter(([key]) => header[key] && !header[key].reason)
      .map(([key, prefix]) => ({
        key, ...header[key], decode: () => mapOf(header, key, prefix, columns, faces),
      })),
  };
}

function scaledBy(numbers, step, origin) {
  return Float32Array.from(numbers, (q) => origin + q * step);
}

// The mesh as it is seen fits into the unit ball around 0.
function frameOf(raw, { origin, step }) {
  const ends = raw.map((column) => {
    let [low, high] = [Infinity, -Infinity];
    for (const q of column) {
      if (q < low) low = q;
      if (q > high) high = q;
    }
    return [low, high];
  });
  const middle = ends.map(([low, high]) => (low + high) / 2);
  let square = 0;
  for (let v = 0; v < raw[0].length; v++) {
    const d = raw.reduce((sum, column, i) => sum + (column[v] - middle[i]) ** 2, 0);
    if (d > square) square = d;
  }
  const radius = Math.sqrt(square) || 1;
  return {
    unit: radius * step, // of length, in that of the mesh
    centre: middle.map((q, i) => origin[i] + q * step),
    toView: (q, i) => (q - middle[i]) / radius,
  };
}

export function interleaved(columns) {
  const width = columns.length;
  const all = new Float32Array(columns[0].length * width);
  columns.forEach((column, c) => column.forEach((x, v) => (all[v * width + c] = x)));
  return all;
}

// The mesh cut open: its faces, which vertex each copy belongs to, and coordinates in the plane.
function mapOf(header, key, prefix, columns, faces) {
  const { n } = header;
  const { step } = header[key];
  const column = (name) => summed(columns(prefix + name)[0] ?? []);
  const [corners, vertices, extra] = ["seam corners", "seam vertices", "seam copies"].map(column);
  const cut = faces.slice();
  corners.forEach((corner, i) => (cut[corner] = vertices[i]));
  const original = new Int32Array(n + extra.length);
  for (let v = 0; v < original.length; v++) original[v] = v < n ? v : extra[v - n];
  const guesses = guessesOf(cut, original.length);
  const uv = columns(`${prefix}plane`).map((c) => scaledBy(guessed(c, guesses), step, 0));
  const bare = new Set(prefix ? column("bare") : []); // copies without coordinates
  return { faces: cut, original, uv: interleaved(uv), bare, edges: edgesOf(cut, original.length) };
}

// Which meshes are drawn where: one, a surface beside its map, or three copies side by side.

import { axesOf } from "./camera.js";
import { buffer } from "./gl.js";
import { readPlaces, surfaceBuffers } from "./passes.js";
import { projected } from "./vectors.js";

const NOWHERE = -10; // the coordinates of corners that have none

export function viewsOf(app, look) {
  const { gl, panel } = app;
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  document.getElementById("captions").classList.toggle("stacked", width < height);
  const box = (i, count) => {
    if (width < height && count > 1) {
      const part = Math.floor(height / count); // one above the other on a phone
      return [0, height - (i + 1) * part, width, part];
    }
    const part = Math.floor(width / count);
    return [i * part, 0, part, height];
  };
  const view = (mesh, i, count, camera, more = {}) => {
    const place = box(i, count);
    const lens = app.lens(place[2] / place[3], camera);
    const light = app.lightFor(lens.axes);
    return { mesh, box: place, lens, look: { ...look, light, front: [0, 0, 1] }, ...more };
  };
  if (panel.views === "plane") return planeViews(app, look, view);
  if (panel.views === "compare") return app.copies.map((copy, i) => view(copy, i, 3));
  return [view(app.mesh, 0, 1)];
}

function planeViews(app, look, view) {
  const { recipe } = app;
  const flat = app.flat(recipe.mapped);
  if (flat.values !== recipe.flatValues) flat.setValues(recipe.flatValues);
  const front = { ...app.camera, azimuth: 0, elevation: 0, target: [0, 0, 0], distance: 3.5 };
  const right = view(flat.mesh, 1, 2, front, { unfold: 1 });
  const left = view(flat.mesh, 0, 2, undefined, { unfold: recipe.unfold });
  for (const one of [left, right]) one.look.front = flat.front;
  right.look.tint = 0;
  right.look.light = flat.front; // a drawing on paper, not a lit thing
  return [left, right];
}

// The cut mesh: the same places with copies at the seams, and coordinates in the plane.
export function flatMesh(app, map) {
  const { gl, data, painter } = app;
  const { faces, original, uv, bare, edges } = map.decode();
  const count = original.length;
  const pull = (values, width) => {
    const result = new Float32Array(count * width);
    for (let v = 0; v < count; v++) {
      for (let c = 0; c < width; c++) result[v * width + c] = values[original[v] * width + c];
    }
    return result;
  };
  const base = pull(data.base, 3);
  const { flat, front, unitUv, ends, size } = unfolded(uv, bare, data.header.up);
  const laid = onPicture(map, ends, size);
  const buffers = { n: count, places: null, normals: buffer(gl, pull(data.normals, 3)) };
  const places = new Float32Array(4 * count);
  for (let v = 0; v < count; v++) places.set(base.subarray(3 * v, 3 * v + 3), 4 * v);
  buffers.places = buffer(gl, places);
  return {
    base, uv, front,
    faces: bare.size ? withUv(faces, bare) : faces,
    mesh: painter.prepare(buffers, faces, edges, { flat, uv: unitUv, laid }),
    values: undefined,
    setValues(values) {
      for (let v = 0; v < count; v++) places[4 * v + 3] = values ? values[v] : 0;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers.places);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, places);
      gl.bindBuffer(gl.ARRAY_BUFFER, null);
      this.values = values;
    },
  };
}

// Coordinates in the plane that faces the viewer at first, as large as the mesh.
function unfolded(uv, bare, up) {
  const { x, y, z } = axesOf({ up, azimuth: 0, elevation: 0 });
  const ends = [0, 1].map((c) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = c; i < uv.length; i += 2) {
      if (bare.has((i - c) / 2)) continue;
      if (uv[i] < low) low = uv[i];
      if (uv[i] > high) high = uv[i];
    }
    return [low, high];
  });
  const size = Math.max(...ends.map(([low, high]) => high - low)) || 1;
  const flat = new Float32Array((uv.length / 2) * 3);
  const unitUv = new Float32Array(uv.length);
  for (let v = 0; v < uv.length / 2; v++) {
    if (bare.has(v)) {
      unitUv[2 * v] = NOWHERE; // and all in one point of the plane
      continue;
    }
    const [s, t] = [0, 1].map((c) => (uv[2 * v + c] - (ends[c][0] + ends[c][1]) / 2) / size);
    for (let i = 0; i < 3; i++) flat[3 * v + i] = 1.8 * (s * x[i] + t * y[i]);
    unitUv[2 * v] = s + 0.5;
    unitUv[2 * v + 1] = t + 0.5;
  }
  return { flat, front: z, unitUv, ends, size };
}

// Where the corner and the sides of the square that holds a map lie on the picture: as the
// coordinates of the mesh say, or such that the picture covers the map that was made once.
function onPicture(map, [[left, right], [low, high]], size) {
  if (map.key === "own") {
    const corner = [(left + right - size) / 2, (low + high - size) / 2];
    return [corner[0] + map.origin[0], 1 - (corner[1] + map.origin[1]), size, -size];
  }
  const [width, height] = [(right - left) / size || 1, (high - low) / size || 1];
  return [0.5 - 0.5 / width, 0.5 + 0.5 / height, 1 / width, -1 / height];
}

function withUv(faces, bare) {
  const starts = Array.from({ length: faces.length / 3 }, (_, f) => 3 * f);
  const kept = starts.filter((at) => !bare.has(faces[at]));
  return Int32Array.from(kept.flatMap((at) => [faces[at], faces[at + 1], faces[at + 2]]));
}

// Original, noisy and denoised.
export function comparisonMeshes(app) {
  const { gl, data, painter, normals } = app;
  const { step } = data.header.comparison;
  return [null, "noisy", "denoised"].map((name) => {
    const surface = surfaceBuffers(gl, data.n);
    const away = name ? data.moved(name, step / data.frame.unit) : null;
    const places = new Float32Array(4 * data.n);
    for (let v = 0; v < data.n; v++) {
      for (let i = 0; i < 3; i++) {
        places[4 * v + i] = data.base[3 * v + i] + (away ? away[3 * v + i] : 0);
      }
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, surface.places);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, places);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    normals.run(surface);
    return painter.prepare(surface, data.faces, data.edges);
  });
}

// The vertex nearest to a place of the page: of the face there, the corner that appears nearest;
// -1 where there is no face, or, if `anyway`, the vertex that appears nearest.
export function vertexAt(app, clientX, clientY, anyway = false) {
  const { canvas, gl, painter, data } = app;
  const bounds = canvas.getBoundingClientRect();
  const x = ((clientX - bounds.left) / bounds.width) * gl.drawingBufferWidth;
  const y = (1 - (clientY - bounds.top) / bounds.height) * gl.drawingBufferHeight;
  const [view] = app.views;
  const corner = painter.pick(view, Math.floor(x), Math.floor(y));
  if (corner < 0 && !anyway) return -1;
  const places = readPlaces(gl, app.surface);
  const [left, bottom, width, height] = view.box;
  const away = (v) => {
    const place = places.subarray(4 * v, 4 * v + 3);
    const [px, py] = projected(view.lens.matrix, place);
    return Math.hypot(((px + 1) / 2) * width + left - x, ((py + 1) / 2) * height + bottom - y);
  };
  const near = corner < 0 ? data.numbers.keys() : neighbours(data.edges, corner);
  return [...near].reduce((best, v) => (away(v) < away(best) ? v : best));
}

function neighbours(edges, vertex) {
  const found = [vertex];
  for (let e = 0; e < edges.length; e += 2) {
    if (edges[e] === vertex) found.push(edges[e + 1]);
    if (edges[e + 1] === vertex) found.push(edges[e]);
  }
  return found;
}

// What the faces tell: pairs of faces, edges, rings, and how values are guessed from earlier ones.

// For each edge a < b and each two faces that follow each other there: a, b and the corners c, d
// opposite to it. Calls pair(a, b, c, d), and edge(a, b) once for each edge. Linear time.
export function forEachPair(faces, n, pair, edge = () => {}) {
  const m = faces.length / 3;
  const start = new Int32Array(n + 1);
  for (let f = 0; f < m; f++) {
    for (let c = 0; c < 3; c++) {
      const [u, v] = ends(faces, f, c);
      start[Math.min(u, v) + 1]++;
    }
  }
  for (let v = 0; v < n; v++) start[v + 1] += start[v];
  const far = new Int32Array(3 * m);
  const opposite = new Int32Array(3 * m);
  const filled = start.slice(0, n);
  for (let c = 0; c < 3; c++) {
    for (let f = 0; f < m; f++) {
      const [u, v] = ends(faces, f, c);
      const at = filled[Math.min(u, v)]++;
      far[at] = Math.max(u, v);
      opposite[at] = faces[3 * f + c];
    }
  }
  for (let a = 0; a < n; a++) {
    for (let i = start[a]; i < start[a + 1]; i++) {
      let before = i - 1;
      while (before >= start[a] && far[before] !== far[i]) before--;
      if (before >= start[a]) pair(a, far[i], opposite[before], opposite[i]);
      else edge(a, far[i]);
    }
  }
}

function ends(faces, f, corner) {
  return [faces[3 * f + ((corner + 1) % 3)], faces[3 * f + ((corner + 2) % 3)]];
}

export function edgesOf(faces, n) {
  const found = [];
  forEachPair(faces, n, () => {}, (a, b) => found.push(a, b));
  return Int32Array.from(found);
}

// Rows of lists in two passes: fill(add) calls add(row, value) for all of them.
export function listed(rows, fill) {
  const start = new Int32Array(rows + 1);
  fill((row) => start[row + 1]++);
  for (let row = 0; row < rows; row++) start[row + 1] += start[row];
  const filled = start.slice(0, rows);
  const place = (row) => filled[row]++;
  return { start, place, total: start[rows] };
}

// How the value of each vertex is guessed: the mean of plus + other - minus (parallelograms), or
// of plus alone (neighbours before it, or the vertex before), rounded down.
export function guessesOf(faces, n) {
  const found = [];
  const edges = [];
  const count = new Int32Array(n);
  const note = (v, a, b, c) => {
    found.push(v, a, b, c);
    count[v]++;
  };
  const known = (a, b, c, d) => {
    if (c > b && c > d) note(c, a, b, d);
    if (d > b && d > c) note(d, a, b, c);
  };
  forEachPair(faces, n, known, (a, b) => edges.push(a, b));
  const lonely = count.map((c) => (c === 0 ? 1 : 0));
  for (let e = 0; e < edges.length; e += 2) {
    const [a, b] = [edges[e], edges[e + 1]];
    if (lonely[b] && a !== b) note(b, a, -1, -1);
  }
  for (let v = 1; v < n; v++) if (!count[v]) note(v, v - 1, -1, -1);
  const { start, place, total } = listed(n, (add) => {
    for (let i = 0; i < found.length; i += 4) add(found[i]);
  });
  const [plus, other, minus] = [0, 0, 0].map(() => new Int32Array(total));
  for (let i = 0; i < found.length; i += 4) {
    const at = place(found[i]);
    [plus[at], other[at], minus[at]] = [found[i + 1], found[i + 2], found[i + 3]];
  }
  return { start, plus, other, minus, count };
}

// For each vertex, the two other corners of each of its faces, in the direction of the face.
export function ringsOf(faces, n) {
  const each = (use) => {
    for (let i = 0; i < faces.length; i++) use(faces[i], i);
  };
  const { start, place, total } = listed(n, (add) => each(add));
  const corners = new Int32Array(2 * total);
  each((v, i) => {
    const f = i - (i % 3);
    const at = 2 * place(v);
    corners[at] = faces[f + ((i + 1) % 3)];
    corners[at + 1] = faces[f + ((i + 2) % 3)];
  });
  return { start, corners };
}

// Area-weighted unit normals of the vertices, (n, 3).
export function normalsOf(positions, faces) {
  const normals = new Float32Array(positions.length);
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]];
    const u = [0, 1, 2].map((i) => positions[b + i] - positions[a + i]);
    const v = [0, 1, 2].map((i) => positions[c + i] - positions[a + i]);
    for (let i = 0; i < 3; i++) {
      const part = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
      for (const corner of [a, b, c]) normals[corner + i] += part;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let j = 0; j < 3; j++) normals[i + j] /= length;
  }
  return normals;
}

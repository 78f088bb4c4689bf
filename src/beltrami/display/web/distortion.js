// What a map to the plane does to each face: singular values, and means at the vertices.

// Largest and smallest factor of length on the triangle x (three points in space) with image u.
export function singularValues(x, u) {
  const e = [0, 1, 2].map((i) => x[1][i] - x[0][i]);
  const f = [0, 1, 2].map((i) => x[2][i] - x[0][i]);
  const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const along = Math.sqrt(inner(e, e));
  const shift = inner(e, f) / along;
  const height = Math.sqrt(Math.max(inner(f, f) - shift * shift, 0));
  const [p, q] = [1, 2].map((i) => [u[i][0] - u[0][0], u[i][1] - u[0][1]]);
  // columns of the derivative, in the frame (e, its normal in the face)
  const s = [p[0] / along, p[1] / along];
  const t = [(q[0] - s[0] * shift) / height, (q[1] - s[1] * shift) / height];
  const sum = Math.hypot(s[0] + t[1], s[1] - t[0]);
  const difference = Math.hypot(s[0] - t[1], s[1] + t[0]);
  return [(sum + difference) / 2, Math.abs(sum - difference) / 2];
}

// Means over the faces around each vertex, weighted with areas, of log2 of the ratio of the
// singular values (angles) and log2 of their product over its mean (areas).
export function distortionAtVertices(positions, faces, uv) {
  const n = uv.length / 2;
  const angle = new Float32Array(n);
  const area = new Float32Array(n);
  const weight = new Float32Array(n);
  const perFace = [];
  let [grown, whole] = [0, 0];
  for (let f = 0; f < faces.length; f += 3) {
    const corners = [faces[f], faces[f + 1], faces[f + 2]];
    const x = corners.map((v) => positions.subarray(3 * v, 3 * v + 3));
    const u = corners.map((v) => uv.subarray(2 * v, 2 * v + 2));
    const [large, small] = singularValues(x, u);
    const size = areaOf(x);
    perFace.push({ corners, large, small, size });
    if (!Number.isFinite(large * small)) continue;
    grown += large * small * size;
    whole += size;
  }
  const mean = grown / whole;
  for (const { corners, large, small, size } of perFace) {
    const ratio = Math.log2(large / small);
    const growth = Math.log2((large * small) / mean);
    if (!Number.isFinite(ratio) || !Number.isFinite(growth)) continue;
    for (const v of corners) {
      angle[v] += size * ratio;
      area[v] += size * growth;
      weight[v] += size;
    }
  }
  for (let v = 0; v < n; v++) {
    angle[v] /= weight[v] || 1;
    area[v] /= weight[v] || 1;
  }
  return { angle, area };
}

function areaOf([a, b, c]) {
  const u = [0, 1, 2].map((i) => b[i] - a[i]);
  const v = [0, 1, 2].map((i) => c[i] - a[i]);
  return Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
}

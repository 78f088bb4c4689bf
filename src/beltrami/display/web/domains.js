// How many regions a function has in which it keeps its sign, by joining vertices along edges.

export function signDomains(values, edges) {
  const parent = Int32Array.from({ length: values.length }, (_, i) => i);
  const root = (v) => {
    while (parent[v] !== v) {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  };
  let count = values.reduce((sum, x) => sum + (x !== 0 ? 1 : 0), 0);
  for (let e = 0; e < edges.length; e += 2) {
    const [a, b] = [edges[e], edges[e + 1]];
    if (!(values[a] * values[b] > 0)) continue;
    const [p, q] = [root(a), root(b)];
    if (p !== q) {
      parent[p] = q;
      count--;
    }
  }
  return count;
}

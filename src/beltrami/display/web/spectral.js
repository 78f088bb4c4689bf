// Functions of the eigenvalue, and what follows from coefficients: no mesh, no screen.

// Kernels h(λ): the same as in beltrami.kernels.
export const heat = (time) => (lambda) => Math.exp(-time * lambda);
export const wave = (time) => (lambda) => Math.cos(time * Math.sqrt(lambda));
export const tikhonov = (weight) => (lambda) => 1 / (1 + weight * lambda);
export const exaggerate = (amount, time) => (lambda) => 1 + amount * (1 - Math.exp(-time * lambda));

export function product(a, b) {
  return Float64Array.from(a, (x, i) => x * b[i]);
}

// The first m factors are 1, the others 0.
export function firstTerms(k, m) {
  return Float64Array.from({ length: k }, (_, i) => (i < m ? 1 : 0));
}

// The eigenvalue that sets the scale of times: the smallest that is not zero.
export function lowest(eigenvalues) {
  const last = eigenvalues[eigenvalues.length - 1];
  return eigenvalues.find((lambda) => lambda > 1e-9 * last) ?? 1;
}

// Both terms of the regulariser, ‖f - g‖² and <Lg, g>, for g with the factors h; `outside` is the
// norm of what lies beyond the basis, which g leaves out.
export function regularizerTerms(eigenvalues, coefficients, h, outside) {
  let far = outside * outside;
  let rough = 0;
  for (let i = 0; i < eigenvalues.length; i++) {
    const factor = h(eigenvalues[i]);
    far += ((1 - factor) * coefficients[i]) ** 2;
    rough += eigenvalues[i] * (factor * coefficients[i]) ** 2;
  }
  return { far, rough };
}

// A response drawn by hand: values at places that ascend in [0, 1], linear between them.
export function interpolated(values, place) {
  const last = values.length - 1;
  const at = Math.min(Math.max(place, 0), 1) * last;
  const left = Math.min(Math.floor(at), last - 1);
  return values[left] + (at - left) * (values[left + 1] - values[left]);
}

// Set a drawn response along a stroke from one point (place, value) to another.
export function stroked(values, from, to) {
  const drawn = values.slice();
  const last = values.length - 1;
  const [a, b] = from.place <= to.place ? [from, to] : [to, from];
  const first = Math.max(0, Math.round(a.place * last));
  const end = Math.min(last, Math.round(b.place * last));
  for (let i = first; i <= end; i++) {
    const part = end === first ? 1 : (i - first) / (end - first);
    drawn[i] = a.value + part * (b.value - a.value);
  }
  if (end === first) drawn[first] = to.value;
  return drawn;
}

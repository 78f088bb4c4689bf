// The function that heat, waves and filters act on: a point that was clicked, or one of the page.

import { select } from "./controls.js";

export const POINT = "point";

export function sourceChoice(app, id, extra = []) {
  const options = [
    ...extra,
    [POINT, "a point: click the surface"],
    ...app.data.functions.map((f, i) => [String(i), f.name]),
  ];
  const choice = select({
    id,
    label: "Function f",
    options,
    value: app.source,
    change: (value) => {
      if (!extra.some(([key]) => key === value)) app.source = value;
      app.changed();
    },
  });
  return choice;
}

// Coefficients of f, what of it lies beyond the basis, and between which values it lies.
export function sourceOf(app) {
  const { spectrum, data } = app;
  if (app.source === POINT) {
    const coefficients = spectrum.eigenvalues.map((_, i) => app.mode(i, app.marked));
    return { point: true, name: "f", coefficients, outside: 0, functionIndex: -1 };
  }
  const index = Number(app.source);
  const { name, low, high } = data.functions[index];
  return { point: false, name, low, high, functionIndex: index, ...spectrum.functions[index] };
}

// The largest value of a sum of modes that begins at a point: its value there.
export function atPoint(app, coefficients, factor) {
  return coefficients.reduce((sum, c, i) => sum + factor(app.spectrum.eigenvalues[i]) * c * c, 0);
}

// Between which values h(L) f is shown: a point falls with time, other functions keep the scale.
export function rangeOf(app, source, factor) {
  if (source.point) return [0, atPoint(app, source.coefficients, factor) || 1];
  const { low, high } = source;
  if (!(low < high)) return [low - 1, low + 1];
  const top = Math.max(-low, high);
  return low < 0 && Math.min(-low, high) > 0.4 * top ? [-top, top] : [low, high];
}

// Stems of |f̂| beside a curve h: both over λ.
export function responsePlot(app, source, factor, low, high) {
  const { eigenvalues } = app.spectrum;
  const last = eigenvalues[eigenvalues.length - 1] || 1;
  const sizes = source.coefficients.map(Math.abs);
  const largest = Math.max(...sizes.slice(1), 1e-300);
  const curve = Array.from({ length: 161 }, (_, i) => [(i / 160) * last, factor((i / 160) * last)]);
  return {
    x: { label: app.lambdaLabel(), low: 0, high: last },
    y: { label: "factor h", low, high },
    curves: [
      {
        points: sizes.map((s, i) => [eigenvalues[i], Math.min(s / largest, 1) * high * 0.95]),
        stems: true,
        role: "third",
        name: "|f̂|, to scale",
      },
      { points: curve, name: "h(λ)" },
    ],
  };
}

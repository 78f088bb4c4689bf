// The quadratic regulariser: near to f, and smooth.

import { checkbox, logarithmic, readings, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { rangeOf, sourceChoice, sourceOf } from "./source.js";
import { lowest, product, regularizerTerms, tikhonov } from "./spectral.js";

export function regularizePanel(app) {
  const state = { weight: 1, original: false };
  const plot = new Plot("Both terms over the weight t");
  const told = readings();
  const limits = () => {
    const { eigenvalues } = app.spectrum;
    return [0.03 / (eigenvalues[app.k - 1] || 1), 30 / lowest(eigenvalues)];
  };
  const start = () => limits()[0] ** 0.6 * limits()[1] ** 0.4;
  state.weight = start();
  const weight = logarithmic({
    id: "weight",
    label: "Weight of smoothness t",
    min: limits()[0],
    max: limits()[1],
    value: state.weight,
    write: (t) => app.withUnit(t, 2),
    change: (t) => {
      state.weight = t;
      app.changed();
    },
  });
  const choice = sourceChoice(app, "regularize-source");
  const original = checkbox({
    id: "regularize-original",
    label: "Show f itself",
    value: false,
    change: (on) => {
      state.original = on;
      app.changed();
    },
  });
  return {
    id: "regularize",
    title: "Regularise",
    section: "3.3.5",
    spectral: true,
    picks: true,
    state,
    nodes: [
      words("Of all functions g, the one that is near to f and has little energy: a sum of squares."),
      formula("min_g ‖f − g‖_B^2 + t ⟨Lg, g⟩"),
      formula("g = Σ_i f̂_i φ_i / (1 + t λ_i)"),
      choice.node,
      weight.node,
      original.node,
      told.node,
      plot.canvas,
    ],
    enter() {
      if (app.source === "point") app.source = "0";
    },
    respectrum() {
      weight.limit(...limits());
      state.weight = start();
      weight.set(state.weight);
    },
    recipe() {
      const source = sourceOf(app);
      const h = tikhonov(state.weight);
      const range = rangeOf(app, source, h);
      const name = state.original ? "f" : "g";
      if (state.original && !source.point) {
        return { base: source.functionIndex, range, name: `${name}: ${source.name}` };
      }
      const factors = app.spectrum.eigenvalues.map(state.original ? () => 1 : h);
      return {
        value: product(factors, source.coefficients),
        range,
        name: source.point ? `${name} of a point, ${app.per("area")}` : `${name}: ${source.name}`,
        marked: source.point,
      };
    },
    update() {
      choice.input.value = app.source;
      const source = sourceOf(app);
      const { eigenvalues } = app.spectrum;
      const at = (t) => regularizerTerms(eigenvalues, source.coefficients, tikhonov(t), source.outside);
      const { far, rough } = at(state.weight);
      told.set("‖f − g‖²", app.written(far));
      told.set("⟨Lg, g⟩", app.written(rough));
      told.set("The sum", app.written(far + state.weight * rough));
      const [low, high] = limits();
      const times = Array.from({ length: 81 }, (_, i) => low * (high / low) ** (i / 80));
      const rows = times.map((t) => [t, at(t)]);
      const top = 1.15 * Math.max(...rows.map(([t, r]) => r.far + t * r.rough), 1e-300);
      plot.draw({
        x: { label: `t (${app.unit(2)})`, low, high, log: true },
        y: { label: "both terms", low: 0, high: top },
        curves: [
          { points: rows.map(([t, r]) => [t, r.far]), name: "‖f − g‖²" },
          { points: rows.map(([t, r]) => [t, t * r.rough]), role: "second", name: "t ⟨Lg, g⟩" },
          {
            points: rows.map(([t, r]) => [t, r.far + t * r.rough]),
            role: "third",
            dashed: true,
            name: "sum",
          },
        ],
        names: "left",
        mark: { x: state.weight, y: far + state.weight * rough },
      });
    },
  };
}

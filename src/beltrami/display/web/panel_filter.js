// A filter h(λ) drawn by hand, on the shape or on a function.

import { element, button, readings, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { rangeOf, sourceChoice, sourceOf } from "./source.js";
import { interpolated, product, stroked } from "./spectral.js";
import { written } from "./ticks.js";

const KNOTS = 97;
const [LOW, HIGH] = [-0.5, 2];
export const SHAPE = "shape";

const PRESETS = [
  ["all", "All pass", () => 1],
  ["low", "Low pass", (x) => 1 / (1 + Math.exp((x - 0.12) * 60))],
  ["high", "High pass", (x) => 1 - 1 / (1 + Math.exp((x - 0.1) * 60))],
  ["band", "Band", (x) => Math.exp(-(((x - 0.3) / 0.1) ** 2))],
  ["boost", "Boost", (x) => 1 + 0.9 * Math.exp(-(((x - 0.12) / 0.12) ** 2))],
];

export function filterPanel(app) {
  const state = { values: new Float64Array(KNOTS).fill(1), onShape: true, knot: 12 };
  const plot = new Plot("The filter");
  const told = readings();
  const choice = sourceChoice(app, "filter-source", [[SHAPE, "the shape: x, y and z"]]);
  choice.input.value = SHAPE;
  choice.input.addEventListener("change", () => {
    state.onShape = choice.input.value === SHAPE;
    app.changed();
  });
  const last = () => app.spectrum.eigenvalues[app.k - 1] || 1;
  const h = (lambda) => interpolated(state.values, lambda / last());
  const presets = PRESETS.map(([id, label, f]) =>
    button({
      id: `filter-${id}`,
      label,
      press: () => {
        state.values = Float64Array.from({ length: KNOTS }, (_, i) => f(i / (KNOTS - 1)));
        app.changed();
      },
    }),
  );
  listenToStrokes(plot, state, last, () => app.changed());
  return {
    id: "filter",
    title: "Draw a filter",
    section: "3.3.4",
    spectral: true,
    picks: true,
    state,
    nodes: [
      words("Draw the factor of each frequency into the plot, with the mouse, a finger, or arrow keys."),
      formula("h(B^{−1}L) f = Σ_i h(λ_i) f̂_i φ_i"),
      choice.node,
      plot.canvas,
      element("div", { class: "buttons" }, ...presets),
      told.node,
      words("What lies beyond the last mode takes the factor of the last one where f is the shape, 0 elsewhere."),
    ],
    picked() {
      state.onShape = false;
    },
    recipe() {
      const factors = app.spectrum.eigenvalues.map(h);
      if (state.onShape) {
        const rest = factors[app.k - 1];
        const change = factors.map((x) => x - rest);
        return { shape: app.spectrum.shape.map((c) => product(change, c)), keep: rest };
      }
      const source = sourceOf(app);
      const [low, high] = rangeOf(app, source, () => 1);
      return {
        value: product(factors, source.coefficients),
        range: source.point ? [-high / 3, high / 3] : [low, high],
        name: `h(B⁻¹L) f: ${source.point ? "a point" : source.name}`,
        marked: source.point,
      };
    },
    update() {
      choice.input.value = state.onShape ? SHAPE : app.source;
      const { eigenvalues, shape } = app.spectrum;
      const sizes = state.onShape
        ? Array.from(eigenvalues, (_, i) => Math.hypot(...shape.map((c) => c[i])))
        : sourceOf(app).coefficients.map(Math.abs);
      const largest = Math.max(...sizes.slice(1), 1e-300);
      const at = (state.knot / (KNOTS - 1)) * last();
      plot.draw({
        x: { label: app.lambdaLabel(), low: 0, high: last() },
        y: { label: "factor h", low: LOW, high: HIGH },
        curves: [
          {
            points: Array.from(eigenvalues, (x, i) => [x, LOW + Math.min(sizes[i] / largest, 1) * 2.3]),
            stems: true,
            role: "third",
            name: "|f̂|, to scale",
          },
          { points: [[0, 1], [last(), 1]], dashed: true, role: "line" },
          {
            points: Array.from(state.values, (y, i) => [(i / (KNOTS - 1)) * last(), y]),
            name: "h(λ)",
          },
        ],
        mark: { x: at, y: state.values[state.knot] },
      });
      const said = `λ = ${app.withUnit(at, -2)}, h = ${written(state.values[state.knot])}`;
      plot.canvas.setAttribute("aria-valuetext", said);
      plot.canvas.setAttribute("aria-valuenow", state.values[state.knot].toFixed(2));
      told.set("At the mark", said);
    },
  };
}

function listenToStrokes(plot, state, last, changed) {
  const { canvas } = plot;
  const role = { role: "slider", tabindex: 0, "aria-valuemin": LOW, "aria-valuemax": HIGH };
  for (const [name, value] of Object.entries({ id: "filter-plot", ...role })) {
    canvas.setAttribute(name, value);
  }
  canvas.classList.add("drawn");
  let from = null;
  const place = (event) => {
    const { x, y } = plot.under(event);
    return { place: Math.min(Math.max(x / last(), 0), 1), value: Math.min(Math.max(y, LOW), HIGH) };
  };
  const draw = (event) => {
    const to = place(event);
    state.values = stroked(state.values, from ?? to, to);
    state.knot = Math.round(to.place * (KNOTS - 1));
    from = to;
    changed();
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    from = null;
    draw(event);
  });
  canvas.addEventListener("pointermove", (event) => from && draw(event));
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, () => (from = null));
  }
  canvas.addEventListener("keydown", (event) => {
    const [right, up] =
      { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [];
    if (right === undefined) return;
    event.preventDefault();
    state.knot = Math.min(Math.max(state.knot + right, 0), KNOTS - 1);
    if (up) raise(state, 0.1 * up);
    changed();
  });
}

// Raise a bump around the mark.
function raise(state, amount) {
  state.values = state.values.map((y, i) => {
    const bump = amount * Math.exp(-(((i - state.knot) / 4) ** 2));
    return Math.min(Math.max(y + bump, LOW), HIGH);
  });
}

// Smooth the shape, or make more of what smoothing would take away.

import { logarithmic, readings, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { exaggerate, lowest, product } from "./spectral.js";
import { responsePlot } from "./source.js";
import { written } from "./ticks.js";

export function exaggeratePanel(app) {
  const state = { amount: 0.8, time: 1 };
  const plot = new Plot("Factors over the eigenvalues");
  const told = readings();
  const limits = () => {
    const { eigenvalues } = app.spectrum;
    return [0.3 / (eigenvalues[app.k - 1] || 1), 1 / lowest(eigenvalues)];
  };
  const start = () => Math.sqrt(limits()[0] * limits()[1]);
  state.time = start();
  const amount = slider({
    id: "amount",
    label: "Smooth ↔ exaggerate β",
    min: -1,
    max: 2,
    value: state.amount,
    write: (x) => (x < 0 ? `smooth ${written(x, 2)}` : `exaggerate ${written(x, 2)}`),
    change: (x) => {
      state.amount = x;
      app.changed();
    },
  });
  const time = logarithmic({
    id: "exaggerate-time",
    label: "Size of the features t",
    min: limits()[0],
    max: limits()[1],
    value: state.time,
    write: (t) => app.withUnit(t, 2),
    change: (t) => {
      state.time = t;
      app.changed();
    },
  });
  const h = (lambda) => exaggerate(state.amount, state.time)(lambda);
  return {
    id: "exaggerate",
    title: "Smooth & exaggerate",
    section: "3.3.4",
    spectral: true,
    state,
    nodes: [
      words(
        "β = −1 is heat for the time t, which smooths; β = 0 changes nothing; β > 0 adds once " +
          "more what heat would take away.",
      ),
      formula("h(λ) = 1 + β (1 − e^{−λ t})"),
      amount.node,
      time.node,
      told.node,
      plot.canvas,
    ],
    respectrum() {
      time.limit(...limits());
      state.time = start();
      time.set(state.time);
    },
    recipe() {
      const factors = app.spectrum.eigenvalues.map(h);
      const rest = factors[app.k - 1];
      const change = factors.map((x) => x - rest);
      return { shape: app.spectrum.shape.map((c) => product(change, c)), keep: rest };
    },
    update() {
      const { shape } = app.spectrum;
      const coefficients = shape[0].map((_, i) => Math.hypot(...shape.map((c) => c[i])));
      const top = Math.max(1.2, 1 + state.amount);
      plot.draw(responsePlot(app, { coefficients }, h, 0, top));
      told.set("Details finer than all modes", `× ${written(h(app.spectrum.eigenvalues[app.k - 1]))}`);
    },
  };
}

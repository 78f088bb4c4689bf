// The shape out of its first M Fourier coefficients, and the error that is left.

import { button, element, readings, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { firstTerms, product } from "./spectral.js";
import { written } from "./ticks.js";

export function termsPanel(app) {
  const state = { m: Math.min(24, app.k), playing: false, part: 0 };
  const plot = new Plot("Error of the shape over the number of terms");
  const told = readings();
  const terms = slider({
    id: "terms",
    label: "Terms M",
    min: 0,
    max: app.k,
    step: 1,
    value: state.m,
    write: (m) => `${m} of ${app.data.n}`,
    change: (m) => {
      state.m = m;
      app.changed();
    },
  });
  const play = button({ id: "terms-play", label: "Play", press: () => playing(!state.playing) });
  const playing = (on) => {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    if (on && state.m >= app.k) state.m = 0;
    app.animate(on ? step : null);
  };
  const step = (seconds) => {
    state.part += seconds * 6;
    if (state.part < 1) return;
    state.m = Math.min(state.m + Math.floor(state.part), app.k);
    state.part = 0;
    terms.set(state.m);
    if (state.m >= app.k) playing(false);
  };
  return {
    id: "terms",
    title: "M terms",
    section: "3.3.6",
    spectral: true,
    state,
    nodes: [
      words(
        "The three coordinates are functions on the surface. Their first coefficients alone " +
          "already draw its shape.",
      ),
      formula("x_M = Σ_{i<M} x̂_i φ_i"),
      terms.node,
      element("div", { class: "buttons" }, play),
      told.node,
      plot.canvas,
    ],
    leave: () => playing(false),
    recipe() {
      const factors = firstTerms(app.k, state.m);
      return { shape: app.spectrum.shape.map((c) => product(factors, c)), keep: 0 };
    },
    update() {
      const { decay, total } = app.spectrum;
      const size = Math.sqrt(total);
      const floor = Math.max(decay[app.k], decay[0] * 1e-4);
      told.set("Error beside the size", `${written((100 * decay[state.m]) / (decay[0] || 1))} %`);
      told.set("Root mean square distance", app.withLength(decay[state.m] / size));
      told.set("Numbers kept", `${3 * state.m} instead of ${3 * app.data.n}`);
      plot.draw({
        x: { label: "terms M", low: 0, high: app.k },
        y: {
          label: `distance (${app.lengthUnit()})`,
          low: (0.8 * floor) / size || 1e-3,
          high: (1.2 * decay[0]) / size || 1,
          log: true,
        },
        curves: [{ points: [...decay].map((e, m) => [m, e / size]) }],
        mark: { x: state.m, y: decay[state.m] / size },
      });
    },
  };
}

// Heat that spreads: each frequency decays by exp(-λ t).

import { button, checkbox, element, logarithmic, readings, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { atPoint, rangeOf, responsePlot, sourceChoice, sourceOf } from "./source.js";
import { heat, lowest, product } from "./spectral.js";

export function heatPanel(app) {
  const state = { time: 1, contours: false, playing: false };
  const plot = new Plot("Factors of heat over the eigenvalues");
  const told = readings();
  const limits = () => {
    const { eigenvalues } = app.spectrum;
    return [0.3 / (eigenvalues[app.k - 1] || 1), 3 / lowest(eigenvalues)];
  };
  const [low, high] = limits();
  state.time = Math.sqrt(low * high) / 3;
  const time = logarithmic({
    id: "heat-time",
    label: "Time t",
    min: low,
    max: high,
    value: state.time,
    write: (t) => app.withUnit(t, 2),
    change: (t) => {
      state.time = t;
      app.changed();
    },
  });
  const choice = sourceChoice(app, "heat-source");
  const contours = checkbox({
    id: "heat-contours",
    label: "Lines of equal heat",
    value: false,
    change: (on) => {
      state.contours = on;
      app.changed();
    },
  });
  const play = button({ id: "heat-play", label: "Play", press: () => playing(!state.playing) });
  const playing = (on) => {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    if (on && state.time >= limits()[1] * 0.98) state.time = limits()[0];
    app.animate(on ? step : null);
  };
  const step = (seconds) => {
    const [first, last] = limits();
    state.time = Math.min(state.time * (last / first) ** (seconds / 8), last);
    time.set(state.time);
    if (state.time >= last) playing(false);
  };
  return {
    id: "heat",
    title: "Heat",
    section: "3.3.1, 3.3.4",
    spectral: true,
    picks: true,
    nodes: [
      words("Heat flows from f. What oscillates decays first; at last only the mean is left."),
      formula("F_t = Σ_i e^{−λ_i t} f̂_i φ_i"),
      choice.node,
      time.node,
      element("div", { class: "buttons" }, play),
      contours.node,
      told.node,
      plot.canvas,
    ],
    leave: () => playing(false),
    respectrum() {
      time.limit(...limits());
      state.time = Math.sqrt(limits()[0] * limits()[1]) / 3;
      time.set(state.time);
    },
    state,
    recipe() {
      const source = sourceOf(app);
      const h = heat(state.time);
      const factors = app.spectrum.eigenvalues.map(h);
      const range = rangeOf(app, source, h);
      return {
        value: product(factors, source.coefficients),
        range,
        name: source.point ? `heat of one unit, ${app.per("area")}` : `F: ${source.name}`,
        spacing: state.contours ? (range[1] - range[0]) / 12 : 0,
        marked: source.point,
      };
    },
    update() {
      choice.input.value = app.source;
      const source = sourceOf(app);
      plot.draw(responsePlot(app, source, heat(state.time), 0, 1));
      told.set("Mean, which stays", app.written(app.mean(source.coefficients)));
      if (source.point) {
        told.set("At the point", app.written(atPoint(app, source.coefficients, heat(state.time))));
        told.set("Its number", String(app.numberOf(app.marked)));
      }
    },
    tell: ({ low: least, high: most }) =>
      told.set("Between", `${app.written(least)} and ${app.written(most)}`),
  };
}

// A wave from a point: each frequency swings as cos(√λ t).

import { button, element, readings, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { atPoint, responsePlot, sourceChoice, sourceOf } from "./source.js";
import { heat, lowest, product, wave } from "./spectral.js";

export function wavePanel(app) {
  const state = { time: 0, playing: false, lift: 0.2 };
  const plot = new Plot("Factors of the wave over the eigenvalues");
  const told = readings();
  const period = () => (2 * Math.PI) / Math.sqrt(lowest(app.spectrum.eigenvalues));
  // the bump that a wave from a point begins with: as narrow as the modes allow
  const width = () => 2.5 / (app.spectrum.eigenvalues[app.k - 1] || 1);
  const time = slider({
    id: "wave-time",
    label: "Time t",
    min: 0,
    max: period(),
    value: 0,
    write: (t) => app.withUnit(t, 1),
    change: (t) => {
      state.time = t;
      app.changed();
    },
  });
  const lift = slider({
    id: "wave-lift",
    label: "Push the surface out",
    min: 0,
    max: 1,
    value: state.lift,
    write: (x) => `${Math.round(100 * x)} %`,
    change: (x) => {
      state.lift = x;
      app.changed();
    },
  });
  const choice = sourceChoice(app, "wave-source");
  const play = button({ id: "wave-play", label: "Play", press: () => playing(!state.playing) });
  const again = button({
    id: "wave-again",
    label: "From the start",
    press: () => {
      state.time = 0;
      time.set(0);
      app.changed();
    },
  });
  const playing = (on) => {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    app.animate(on ? step : null);
  };
  const step = (seconds) => {
    state.time += (seconds * period()) / 12;
    if (state.time > period()) state.time -= period();
    time.set(state.time);
  };
  const factor = (lambda, point) => wave(state.time)(lambda) * (point ? heat(width())(lambda) : 1);
  const middle = (source) => (source.point ? 0 : app.mean(source.coefficients));
  return {
    id: "wave",
    title: "Waves",
    section: "3.3.1",
    spectral: true,
    picks: true,
    state,
    nodes: [
      words("Click the surface: a wave runs from there, at speed 1 where the Laplacian is cotangent."),
      formula("F_t = Σ_i cos(√λ_i t) f̂_i φ_i"),
      choice.node,
      element("div", { class: "buttons" }, play, again),
      time.node,
      lift.node,
      told.node,
      plot.canvas,
    ],
    leave: () => playing(false),
    picked() {
      state.time = 0;
      time.set(0);
      if (!state.playing) playing(true);
    },
    respectrum() {
      time.input.max = period();
      state.time = 0;
      time.set(0);
    },
    recipe() {
      const source = sourceOf(app);
      const factors = app.spectrum.eigenvalues.map((x) => factor(x, source.point));
      const value = product(factors, source.coefficients);
      const top = source.point
        ? 0.4 * atPoint(app, source.coefficients, heat(width()))
        : (source.high - source.low) / 2;
      const m = middle(source);
      return {
        value,
        range: [m - top || -1, m + top || 1],
        map: "diverging",
        name: source.point ? `height of the wave, ${app.per("area")}` : `F: ${source.name}`,
        lift: source.point ? (0.1 * state.lift) / (top || 1) : (0.05 * state.lift) / (top || 1),
        marked: source.point,
      };
    },
    update() {
      choice.input.value = app.source;
      const source = sourceOf(app);
      plot.draw(responsePlot(app, source, (x) => factor(x, source.point), -1, 1));
      told.set("Period of the lowest frequency", app.withUnit(period(), 1));
      if (source.point) told.set("Point", String(app.numberOf(app.marked)));
    },
    tell: ({ low, high }) => told.set("Between", `${app.written(low)} and ${app.written(high)}`),
  };
}

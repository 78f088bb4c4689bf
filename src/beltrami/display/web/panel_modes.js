// An eigenfunction, the line where it is zero, and the eigenvalues.

import { checkbox, readings, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { Plot } from "./plot.js";
import { lowest } from "./spectral.js";
import { written } from "./ticks.js";
import { signDomains } from "./domains.js";

export function modesPanel(app) {
  const first = app.spectrum.eigenvalues.indexOf(lowest(app.spectrum.eigenvalues));
  const state = { i: Math.min(Math.max(first, 0) + 6, app.k - 1), line: true, lift: 0 };
  const plot = new Plot("Eigenvalues over their number");
  const told = readings();
  const counted = new WeakMap(); // regions of the modes seen so far
  const regions = (levels) => {
    if (!counted.has(levels)) counted.set(levels, signDomains(levels, app.data.edges));
    return counted.get(levels);
  };
  const number = slider({
    id: "mode",
    label: "Eigenfunction",
    min: 0,
    max: app.k - 1,
    step: 1,
    value: state.i,
    write: (i) => `φ${subscript(i)}`,
    change: (i) => {
      state.i = i;
      app.changed();
    },
  });
  const line = checkbox({
    id: "nodal-line",
    label: "Nodal line, where φ = 0",
    value: state.line,
    change: (on) => {
      state.line = on;
      app.changed();
    },
  });
  const lift = slider({
    id: "mode-lift",
    label: "Push the surface out by φ",
    min: 0,
    max: 1,
    value: 0,
    write: (x) => `${Math.round(100 * x)} %`,
    change: (x) => {
      state.lift = x;
      app.changed();
    },
  });
  return {
    id: "modes",
    title: "Eigenfunctions",
    section: "3.3.2",
    spectral: true,
    nodes: [
      words(
        "They are to this surface what sines and cosines are to the circle: the larger λ, the " +
          "faster they oscillate.",
      ),
      formula("L φ_i = λ_i B φ_i"),
      number.node,
      line.node,
      lift.node,
      told.node,
      plot.canvas,
    ],
    recipe() {
      const value = new Float64Array(app.k);
      value[state.i] = 1;
      const largest = app.largest(state.i);
      return {
        value,
        range: [-largest, largest],
        name: `φ${subscript(state.i)}`,
        line: state.line,
        lift: (state.lift * 0.12) / largest,
      };
    },
    update() {
      const { eigenvalues, total, mass } = app.spectrum;
      told.set("λ", app.withUnit(eigenvalues[state.i], -2));
      told.set("√λ, its frequency", app.withUnit(Math.sqrt(eigenvalues[state.i]), -1));
      const levels = app.data.levelsOf(app.spectrum)[state.i];
      told.set("Regions of one sign", String(regions(levels)));
      told.set("Courant: at most", String(state.i + 1));
      const curves = [{ points: [...eigenvalues].map((x, i) => [i, x]), name: "λ" }];
      if (mass !== "degree" && mass !== "unit") {
        const weyl = [...eigenvalues].map((_, i) => [i, (4 * Math.PI * i) / total]);
        curves.unshift({ points: weyl, dashed: true, role: "third", name: "Weyl" });
        told.set("Weyl: 4π i / area", written(weyl[state.i][1]));
      } else told.set("Weyl: 4π i / area", "–");
      plot.draw({
        x: { label: "number i", low: 0, high: Math.max(app.k - 1, 1) },
        y: { label: app.lambdaLabel(), low: 0, high: eigenvalues[app.k - 1] || 1 },
        curves,
        names: "left",
        mark: { x: state.i, y: eigenvalues[state.i] },
      });
    },
  };
}

const subscript = (i) => String(i).replace(/\d/g, (d) => "₀₁₂₃₄₅₆₇₈₉"[d]);

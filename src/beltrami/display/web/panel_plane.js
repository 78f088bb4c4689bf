// The map to the plane: a checkerboard, and what it does to angles and areas.

import { checkbox, readings, select, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { distortionAtVertices } from "./distortion.js";
import { written } from "./ticks.js";

export function planePanel(app) {
  const { plane } = app.data.header;
  const state = { shown: "angle", checks: true, count: 24, unfold: 0 };
  if (plane.reason) {
    return {
      id: "plane",
      title: "Plane",
      section: "3.3.7",
      nodes: [words(`There is no map of this mesh to the plane: ${plane.reason}`)],
      recipe: () => ({}),
      update() {},
    };
  }
  const told = readings();
  const changed = (key) => (value) => {
    state[key] = value;
    app.changed();
  };
  const shown = select({
    id: "plane-shown",
    label: "Colour",
    options: [["angle", "distortion of angles"], ["area", "distortion of areas"], ["none", "none"]],
    value: state.shown,
    change: changed("shown"),
  });
  const checks = checkbox({
    id: "plane-checks", label: "Checkerboard", value: true, change: changed("checks"),
  });
  const count = slider({
    id: "plane-count", label: "Squares across", min: 4, max: 80, step: 1, value: state.count,
    write: String, change: changed("count"),
  });
  const unfold = slider({
    id: "plane-unfold", label: "Unfold", min: 0, max: 1, value: 0,
    write: (x) => `${Math.round(100 * x)} %`, change: changed("unfold"),
  });
  let distortion = null;
  return {
    id: "plane",
    title: "Plane",
    section: "3.3.7",
    state,
    nodes: [
      words(
        "Each inner vertex is a weighted mean of its neighbours, and the boundary goes to a " +
          "circle: by Tutte's theorem nothing folds. The surface beside its map.",
      ),
      formula("u_i = Σ_j w_{ij} u_j / Σ_j w_{ij}"),
      shown.node,
      checks.node,
      count.node,
      unfold.node,
      told.node,
    ],
    views: "plane",
    recipe() {
      distortion ??= distortionAtVertices(app.flat.base, app.flat.faces, app.flat.uv);
      const values = state.shown === "none" ? null : distortion[state.shown];
      const top = values ? Math.max(1, mostly(values)) : 1;
      const { range, name } = {
        angle: { range: [0, top], name: "log₂ σ₁/σ₂ (0: angles kept)" },
        area: { range: [-top, top], name: "log₂ σ₁σ₂ / mean (0: areas kept)" },
        none: { range: null, name: "" },
      }[state.shown];
      const checked = state.checks ? state.count : 0;
      return { flatValues: values, range, name, checks: checked, unfold: state.unfold };
    },
    update() {
      told.set("Method", plane.method);
      told.set("Bijection, decided exactly", plane.bijective ? "yes" : `no: ${plane.flipped} faces`);
      told.set("Edges cut", String(plane.cut));
      told.set("Angles: mean σ₁/σ₂", written(plane.conformal));
      told.set("Areas: mean ratio", written(plane.area));
      told.set("Symmetric Dirichlet energy", written(plane.dirichlet));
    },
  };
}

// What 95 % of the sizes do not pass.
function mostly(values) {
  const sizes = Float32Array.from(values, Math.abs).sort();
  return sizes[Math.floor(0.95 * (sizes.length - 1))];
}

// Maps to the plane: a checkerboard or a picture on them, and what they do to angles and areas.

import { readings, select, slider, words } from "./controls.js";
import { formula } from "./formula.js";
import { distortionAtVertices } from "./distortion.js";
import { written } from "./ticks.js";

const HOW = {
  plane:
    "Each inner vertex is a weighted mean of its neighbours, and the boundary goes to a circle: " +
    "by Tutte's theorem nothing folds. The surface beside its map.",
  own: "The texture coordinates of the mesh, as they were given. The surface beside its map.",
};

export function planePanel(app) {
  const { maps } = app.data;
  const { plane, picture, textured } = app.data.header;
  if (!maps.length) {
    return {
      id: "plane",
      title: "Plane",
      section: "3.3.7",
      nodes: [words(`There is no map of this mesh to the plane: ${plane.reason}`)],
      recipe: () => ({}),
      update() {},
    };
  }
  const state = {
    map: maps.length - 1, // the mesh's own, if there is one
    shown: textured ? "none" : "angle",
    pattern: picture ? "picture" : "checks",
    count: 24,
    unfold: 0,
  };
  const controls = planeControls(app, state);
  const how = words("");
  const sum = formula("u_i = Σ_j w_{ij} u_j / Σ_j w_{ij}");
  const told = readings();
  const distortions = new Map();
  const distortionOf = (index) => {
    const { base, faces, uv } = app.flat(index);
    if (!distortions.has(index)) distortions.set(index, distortionAtVertices(base, faces, uv));
    return distortions.get(index);
  };
  return {
    id: "plane",
    title: "Plane",
    section: "3.3.7",
    state,
    nodes: [how, sum, ...controls.nodes, told.node],
    views: "plane",
    recipe() {
      const values = state.shown === "none" ? null : distortionOf(state.map)[state.shown];
      const top = values ? Math.max(1, mostly(values)) : 1;
      const { range, name } = {
        angle: { range: [0, top], name: "log₂ σ₁/σ₂ (0: angles kept)" },
        area: { range: [-top, top], name: "log₂ σ₁σ₂ / mean (0: areas kept)" },
        none: { range: null, name: "" },
      }[state.shown];
      const checks = state.pattern === "checks" ? state.count : 0;
      const pictured = state.pattern === "picture";
      return {
        mapped: state.map, flatValues: values, range, name, checks, pictured, unfold: state.unfold,
      };
    },
    update() {
      const map = maps[state.map];
      how.textContent = HOW[map.key];
      sum.hidden = map.key === "own";
      controls.tell();
      told.set("Method", map.key === "own" ? "given with the mesh" : map.method);
      told.set("Bijection, decided exactly", verdict(map));
      told.set("Edges cut", String(map.cut));
      told.set("Angles: mean σ₁/σ₂", mean(map.conformal));
      told.set("Areas: mean ratio", mean(map.area));
      told.set("Symmetric Dirichlet energy", mean(map.dirichlet));
      if (maps.some(({ without }) => without)) {
        told.set("Faces without coordinates", String(map.without ?? 0));
      }
    },
  };
}

function planeControls(app, state) {
  const { maps } = app.data;
  const changed = (key, read = (x) => x) => (value) => {
    state[key] = read(value);
    app.changed();
  };
  const map = select({
    id: "plane-map",
    label: "Map",
    options: maps.map(({ key }, i) => [String(i), { plane: "made here", own: "of the mesh" }[key]]),
    value: String(state.map),
    change: changed("map", Number),
  });
  const shown = select({
    id: "plane-shown",
    label: "Colour",
    options: [["angle", "distortion of angles"], ["area", "distortion of areas"], ["none", "none"]],
    value: state.shown,
    change: changed("shown"),
  });
  const pictures = app.data.header.picture ? [["picture", "the picture"]] : [];
  const pattern = select({
    id: "plane-pattern",
    label: "Texture",
    options: [...pictures, ["checks", "checkerboard"], ["none", "none"]],
    value: state.pattern,
    change: changed("pattern"),
  });
  const count = slider({
    id: "plane-count", label: "Squares across", min: 4, max: 80, step: 1, value: state.count,
    write: String, change: changed("count"),
  });
  const unfold = slider({
    id: "plane-unfold", label: "Unfold", min: 0, max: 1, value: 0,
    write: (x) => `${Math.round(100 * x)} %`, change: changed("unfold"),
  });
  const choices = maps.length > 1 ? [map, shown] : [shown];
  return {
    nodes: [...choices, pattern, count, unfold].map(({ node }) => node),
    tell: () => (count.node.hidden = state.pattern !== "checks"),
  };
}

function verdict({ bijective, flipped, undecided }) {
  if (undecided) return `not decided: ${undecided}`;
  if (bijective) return "yes";
  return flipped ? `no: ${flipped} faces turn over` : "no: parts meet or overlap";
}

const mean = (value) => (value === null ? "∞" : written(value));

// What 95 % of the sizes do not pass.
function mostly(values) {
  const sizes = Float32Array.from(values, Math.abs).sort();
  return sizes[Math.floor(0.95 * (sizes.length - 1))];
}

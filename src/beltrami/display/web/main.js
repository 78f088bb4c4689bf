// Start: unpack, build the controls, listen.

import { App } from "./app.js";
import { element } from "./controls.js";
import { load } from "./load.js";
import { laplacianChoice, lookControls, pictureOf } from "./look.js";
import { comparePanel } from "./panel_compare.js";
import { exaggeratePanel } from "./panel_exaggerate.js";
import { filterPanel } from "./panel_filter.js";
import { heatPanel } from "./panel_heat.js";
import { modesPanel } from "./panel_modes.js";
import { planePanel } from "./panel_plane.js";
import { regularizePanel } from "./panel_regularize.js";
import { termsPanel } from "./panel_terms.js";
import { wavePanel } from "./panel_wave.js";
import { readPlaces } from "./passes.js";
import { listen } from "./pointer.js";
import { vertexAt } from "./views.js";

const PANELS = [
  modesPanel, heatPanel, wavePanel, termsPanel, filterPanel, exaggeratePanel, regularizePanel,
  planePanel, comparePanel,
];

function open(app, chosen) {
  const place = document.getElementById("panel");
  app.panel?.leave?.();
  app.animate(null);
  app.panel = chosen;
  chosen.enter?.();
  const head = element("h2", {}, chosen.title);
  const section = element("p", { class: "section" }, `Section ${chosen.section} of the chapter`);
  const laplacian = chosen.spectral && app.data.spectra.length > 1 ? [app.laplacian.node] : [];
  place.replaceChildren(head, section, ...laplacian, ...chosen.nodes);
  place.setAttribute("aria-labelledby", `tab-${chosen.id}`);
  for (const { id } of app.panels) {
    const tab = document.getElementById(`tab-${id}`);
    tab.setAttribute("aria-selected", String(id === chosen.id));
    tab.tabIndex = id === chosen.id ? 0 : -1;
    if (id === chosen.id) tab.scrollIntoView({ block: "nearest", inline: "center" });
  }
  const captions = (chosen.captions ?? []).map((text) => element("span", {}, text));
  document.getElementById("captions").replaceChildren(...captions);
  app.canvas.setAttribute("aria-label", `${app.data.header.title}: ${chosen.title}`);
  app.changed();
}

function buildTabs(app) {
  const tabs = document.getElementById("tabs");
  for (const panel of app.panels) {
    const press = () => open(app, panel);
    const attributes = { id: `tab-${panel.id}`, role: "tab", type: "button", onclick: press };
    tabs.append(element("button", { ...attributes, "aria-controls": "panel" }, panel.title));
  }
  tabs.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const count = app.panels.length;
    const next = app.panels[(app.panels.indexOf(app.panel) + step + count) % count];
    open(app, next);
    document.getElementById(`tab-${next.id}`).focus();
    event.preventDefault();
  });
}

function choose(app, x, y, anyway = false) {
  if (!app.panel.picks) return;
  const vertex = vertexAt(app, x, y, anyway);
  if (vertex < 0) return;
  app.marked = vertex;
  app.source = "point";
  app.panel.picked?.();
  app.changed();
}

// For the console, and for tests: the numbers behind the picture.
function exposed(app) {
  return {
    ready: true,
    app,
    open: (id) => open(app, app.panels.find((panel) => panel.id === id)),
    values() {
      if (app.stale) app.compute();
      return readPlaces(app.gl, app.surface).filter((_, i) => i % 4 === 3);
    },
    positions() {
      if (app.stale) app.compute();
      const places = readPlaces(app.gl, app.surface).filter((_, i) => i % 4 !== 3);
      return places.map((x, i) => x * app.data.frame.unit + app.data.frame.centre[i % 3]);
    },
    picture: () => pictureOf(app).toDataURL(),
    frameTimes: () => app.frames.slice(),
  };
}

async function start() {
  const waiting = document.getElementById("waiting");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  document.documentElement.classList.toggle("dark", dark.matches);
  try {
    const data = await load(document);
    const canvas = document.getElementById("view");
    const app = new App(data, canvas);
    app.panels = PANELS.map((build) => build(app));
    app.laplacian = laplacianChoice(app);
    document.getElementById("look").append(...lookControls(app));
    document.getElementById("legend").append(app.bar.node);
    const { n, m } = data.header;
    const modes = data.spectra.map((s) => s.eigenvalues.length);
    document.getElementById("facts").textContent =
      `${n} vertices, ${m} faces, ${Math.max(...modes)} eigenfunctions of each Laplacian`;
    if (window.innerWidth <= 760) document.getElementById("look").open = false;
    buildTabs(app);
    listen(canvas, {
      move: (change) => app.move(change),
      tap: (x, y) => choose(app, x, y),
      middle() {
        const box = canvas.getBoundingClientRect();
        choose(app, box.left + box.width / 2, box.top + box.height / 2, true);
      },
      reset: () => app.resetCamera(),
    });
    canvas.addEventListener("webglcontextlost", () => {
      waiting.hidden = false;
      waiting.textContent = "The graphics card was taken away: please load the page again.";
    });
    new ResizeObserver(() => app.redraw()).observe(canvas);
    dark.addEventListener("change", () => app.useTheme(dark.matches));
    // page.html#wave opens with waves
    const named = () => app.panels.find(({ id }) => location.hash === `#${id}`);
    const first = data.header.textured ? "plane" : app.panels[0].id;
    open(app, named() ?? app.panels.find(({ id }) => id === first));
    window.addEventListener("hashchange", () => named() && open(app, named()));
    waiting.hidden = true;
    window.beltrami = exposed(app);
  } catch (error) {
    waiting.textContent = `The page cannot be shown: ${error.message}`;
    waiting.classList.add("failed");
    throw error;
  }
}

start();

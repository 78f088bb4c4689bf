// The state of the page, and the way from a recipe (weights of modes) to a picture.

import { axesOf, matrixOf, startCamera } from "./camera.js";
import { ColourBar, chosenMap, tableOf } from "./colours.js";
import { isSoftware } from "./gl.js";
import { Painter } from "./painter.js";
import { NormalPass, SynthesisPass, modeTexture, readPlaces, surfaceBuffers } from "./passes.js";
import { Quantities } from "./quantities.js";
import { ringsOf } from "./topology.js";
import { add, scaled, unit } from "./vectors.js";
import { comparisonMeshes, flatMesh, viewsOf } from "./views.js";

const CALM = 250; // milliseconds between readings of least and largest values
const SLOW = 60; // milliseconds between frames from which on moving pictures are coarser
const COARSE = 0.6;

export class App extends Quantities {
  constructor(data, canvas) {
    super(data);
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", { antialias: !isSoftware(), alpha: false });
    if (!gl) throw new Error("This browser has no WebGL2, which the page needs to compute.");
    this.gl = gl;
    const { header, n } = data;
    this.state = { spectrum: 0, colours: "auto", wire: false, light: [-35, 40] };
    this.source = data.functions.length > 2 ? "2" : "point";
    this.camera = startCamera(header.up, header.planar);
    this.painter = new Painter(gl);
    this.normals = new NormalPass(gl, ringsOf(data.faces, n), n);
    this.surface = surfaceBuffers(gl, n);
    if (data.picture) this.painter.setPicture(data.picture);
    this.mesh = this.painter.prepare(this.surface, data.faces, data.edges);
    this.bar = new ColourBar(header.colours);
    this.marked = this.topmost();
    this.frames = [];
    this.loaded = new Map();
    this.flattened = new Map();
    this.pace = 0;
    this.useTheme();
    this.valuesOf = null;
    this.useSpectrum();
    this.stale = true;
  }

  // From a recipe to buffers.

  useSpectrum() {
    const { data, gl, spectrum } = this;
    this.levels = data.levelsOf(spectrum);
    if (!this.loaded.has(spectrum)) {
      const modes = modeTexture(gl, this.levels, data.n);
      const synthesis = new SynthesisPass(gl, this.k, data.base, data.normals);
      this.loaded.set(spectrum, { modes, synthesis });
    }
    Object.assign(this, this.loaded.get(spectrum));
    this.valuesOf = null;
  }

  setSpectrum(index) {
    this.state.spectrum = index;
    this.useSpectrum();
    for (const panel of this.panels) panel.respectrum?.();
    this.changed();
  }

  compute() {
    const recipe = this.panel.recipe();
    this.recipe = recipe;
    const { steps, centre } = this.spectrum;
    const { frame, functions } = this.data;
    const weigh = (weights, size = 1) => weights && steps.map((s, i) => (weights[i] * s) / size);
    if (recipe.base >= 0 && this.valuesOf !== recipe.base) {
      this.synthesis.setValues(functions[recipe.base].values);
      this.valuesOf = recipe.base;
    }
    this.synthesis.run(this.surface, this.modes, {
      shape: recipe.shape?.map((c) => weigh(c, frame.unit)) ?? null,
      value: weigh(recipe.value) ?? null,
      centre: centre.map((x, i) => (x - frame.centre[i]) / frame.unit),
      keep: recipe.keep ?? 1,
      keepValue: recipe.base >= 0 ? 1 : 0,
      lift: recipe.lift ?? 0,
    });
    this.normals.run(this.surface);
    this.stale = false;
  }

  // The mesh cut open for a map of `data.maps`.
  flat(index) {
    const { flattened, data } = this;
    if (!flattened.has(index)) flattened.set(index, flatMesh(this, data.maps[index]));
    return flattened.get(index);
  }

  get copies() {
    this.compared ??= comparisonMeshes(this);
    return this.compared;
  }

  // From buffers to pixels.

  draw() {
    if (this.stale) this.compute();
    const { recipe, painter } = this;
    const colored = recipe.range ? 1 : 0;
    const map = colored ? recipe.map ?? chosenMap(this.state.colours, recipe.range) : null;
    const shown = this.state.colours === "auto" || !map ? map : this.state.colours;
    if (shown && shown !== this.tabled) {
      painter.setColours(tableOf(this.data.header.colours[shown]));
      this.tabled = shown;
    }
    this.bar.show(shown, recipe.range ?? [0, 1], recipe.name ?? "");
    const { paper, clay } = this.theme;
    painter.clear(paper);
    this.views = viewsOf(this, {
      colored,
      range: recipe.range ?? [0, 1],
      line: recipe.line ? 1 : 0,
      spacing: recipe.spacing ?? 0,
      checks: recipe.checks ?? 0,
      pictured: recipe.pictured ? 1 : 0,
      clay,
      tint: this.data.header.planar ? 0 : 0.85,
      wire: this.state.wire,
      marked: recipe.marked ? this.marked : -1,
      size: 11 * this.ratio,
    });
    for (const view of this.views) painter.draw(view);
  }

  // Towards the light, in the frame of the camera.
  lightFor(axes) {
    const [azimuth, elevation] = this.state.light.map((x) => (x * Math.PI) / 180);
    const level = Math.cos(elevation);
    const sum = add(
      add(scaled(axes.x, Math.sin(azimuth) * level), scaled(axes.y, Math.sin(elevation))),
      scaled(axes.z, Math.cos(azimuth) * level),
    );
    return unit(sum);
  }

  lens(aspect, camera = this.camera) {
    return matrixOf(camera, aspect);
  }

  // Pixels of the picture for one of the page.
  get ratio() {
    return Math.min(window.devicePixelRatio || 1, 2) * (this.coarse ? COARSE : 1);
  }

  // Follow the page; while pictures that take long follow each other, they are coarser.
  resize(now) {
    const { canvas } = this;
    this.coarse = this.pace > SLOW && now !== undefined;
    const { ratio } = this;
    clearTimeout(this.settling);
    if (this.coarse) this.settling = setTimeout(() => this.settle(), 2 * CALM);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
  }

  settle() {
    this.pace = 0;
    this.shown = null;
    this.redraw();
  }

  // The loop: a frame is drawn when something changed, or something moves.

  changed() {
    this.stale = true;
    this.untold = true;
    this.redraw();
  }

  redraw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  animate(step) {
    this.step = step;
    this.before = null;
    this.changed();
  }

  frame(now) {
    const start = performance.now();
    this.asked = false;
    if (this.step) {
      const seconds = Math.min((now - (this.before ?? now)) / 1000, 0.1);
      this.before = now;
      this.step(seconds);
      this.stale = true;
      this.untold = true;
    }
    const fresh = this.untold;
    this.untold = false;
    const gap = now - (this.shown ?? now);
    this.shown = now;
    if (gap < 1000) this.pace = 0.7 * this.pace + 0.3 * gap;
    this.resize(now);
    this.draw();
    if (fresh) this.panel.update();
    if (this.step) this.redraw();
    this.frames.push(performance.now() - start);
    if (this.frames.length > 600) this.frames.shift();
    if (fresh && this.panel.tell && !this.telling) {
      this.telling = setTimeout(() => this.tell(), CALM);
    }
  }

  tell() {
    this.telling = null;
    let [low, high] = [Infinity, -Infinity];
    const places = readPlaces(this.gl, this.surface);
    for (let i = 3; i < places.length; i += 4) {
      if (places[i] < low) low = places[i];
      if (places[i] > high) high = places[i];
    }
    this.panel.tell?.({ low, high });
  }

  // Camera, point, theme.

  move(change) {
    this.camera = change(this.camera);
    this.redraw();
  }

  resetCamera() {
    this.camera = startCamera(this.data.header.up, this.data.header.planar);
    this.redraw();
  }

  // Colours of the style sheet, read once, since asking for them takes time.
  useTheme(dark = document.documentElement.classList.contains("dark")) {
    document.documentElement.classList.toggle("dark", dark);
    const style = getComputedStyle(document.documentElement);
    const part = (name) =>
      Array.from(tableOf(style.getPropertyValue(name).trim().slice(1)), (b) => b / 255);
    this.theme = { paper: part("--paper"), clay: part("--clay") };
    this.panel?.update();
    this.redraw();
  }

  topmost() {
    const { y } = axesOf({ ...this.camera, elevation: 0 });
    const { base, n } = this.data;
    let [best, top] = [0, -Infinity];
    for (let v = 0; v < n; v++) {
      const height = base[3 * v] * y[0] + base[3 * v + 1] * y[1] + base[3 * v + 2] * y[2];
      if (height > top) [best, top] = [v, height];
    }
    return best;
  }
}

// How things look: Laplacian, colours, edges, light, theme; and a picture to keep.

import { button, checkbox, element, select, slider } from "./controls.js";

export function lookControls(app) {
  const { state } = app;
  const set = (key) => (value) => {
    state[key] = value;
    app.redraw();
  };
  const map = select({
    id: "colours",
    label: "Colours",
    options: [
      ["auto", "as fits"], ["diverging", "blue to red"], ["sequential", "dark to light"],
      ["gray", "grey"],
    ],
    value: state.colours,
    change: set("colours"),
  });
  const wire = checkbox({ id: "wireframe", label: "Edges", value: false, change: set("wire") });
  const degrees = (x) => `${Math.round(x)}°`.replace("-", "−");
  const azimuth = slider({
    id: "light-azimuth", label: "Light from the side", min: -180, max: 180, value: state.light[0],
    write: degrees,
    change: (x) => {
      state.light = [x, state.light[1]];
      app.redraw();
    },
  });
  const elevation = slider({
    id: "light-elevation", label: "Light from above", min: -90, max: 90, value: state.light[1],
    write: degrees,
    change: (x) => {
      state.light = [state.light[0], x];
      app.redraw();
    },
  });
  const buttons = element(
    "div",
    { class: "buttons" },
    button({ id: "reset", label: "Reset view", press: () => app.resetCamera() }),
    button({ id: "screenshot", label: "Save picture", press: () => savePicture(app) }),
    button({ id: "theme", label: "Dark or light", press: () => app.useTheme(!isDark()) }),
  );
  return [map.node, wire.node, azimuth.node, elevation.node, buttons];
}

const isDark = () => document.documentElement.classList.contains("dark");

export function laplacianChoice(app) {
  const words = {
    cotangent: "cotangent, areas",
    combinatorial: "combinatorial, degrees",
    distance: "distance 1/|e|², degrees",
  };
  return select({
    id: "laplacian",
    label: "Laplacian",
    options: app.data.spectra.map(({ kind, mass }, i) => [
      String(i), words[kind] ?? `${kind}, ${mass}`,
    ]),
    value: String(app.state.spectrum),
    change: (value) => app.setSpectrum(Number(value)),
  });
}

// The picture with its colour bar and title, as PNG.
export function pictureOf(app) {
  app.resize(); // as fine as can be, even while it moves
  app.draw();
  const { canvas } = app;
  const picture = document.createElement("canvas");
  [picture.width, picture.height] = [canvas.width, canvas.height];
  const pen = picture.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
  const width = Math.min(360, picture.width * 0.35);
  pen.fillStyle = ink;
  app.bar.paint(pen, picture.width * 0.03, picture.height - width * 0.2, width, ink);
  const captions = app.panel.captions ?? [];
  pen.font = `600 ${Math.round(picture.width / 60)}px system-ui, sans-serif`;
  pen.textAlign = "center";
  captions.forEach((text, i) => {
    const [left, bottom, across, up] = app.views[i].box;
    pen.fillText(text, left + across / 2, picture.height - bottom - up + picture.width / 50);
  });
  return picture;
}

function savePicture(app) {
  pictureOf(app).toBlob((blob) => {
    const address = URL.createObjectURL(blob);
    const name = `${app.data.header.title.replace(/[^\p{L}\p{N}]+/gu, "-")}-${app.panel.id}.png`;
    element("a", { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  });
}

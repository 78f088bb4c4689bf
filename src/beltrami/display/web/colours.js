// Colour maps, and the bar that says what they mean.

import { element } from "./controls.js";
import { written } from "./ticks.js";

// "rrggbb" 256 times to bytes.
export function tableOf(text) {
  const bytes = new Uint8Array(text.length / 2);
  for (let i = 0; i < bytes.length; i++) bytes[i] = parseInt(text.slice(2 * i, 2 * i + 2), 16);
  return bytes;
}

// The map of a function: diverging if its range is symmetric around 0, unless one was chosen.
export function chosenMap(choice, [low, high]) {
  if (choice !== "auto") return choice;
  return low < 0 && Math.abs(low + high) < 1e-6 * high ? "diverging" : "sequential";
}

export class ColourBar {
  constructor(tables) {
    this.tables = tables;
    this.strip = element("div", { class: "strip" });
    this.name = element("div", { class: "bar-name" });
    this.numbers = [0, 1, 2].map(() => element("span"));
    const row = element("div", { class: "bar-numbers" }, ...this.numbers);
    this.node = element("div", { id: "bar" }, this.name, this.strip, row);
  }

  show(map, [low, high], name) {
    this.node.hidden = map === null;
    if (map === null) return;
    if (this.map !== map) {
      const stops = Array.from({ length: 17 }, (_, i) => {
        const at = Math.min(i * 16, 255);
        return `#${this.tables[map].slice(6 * at, 6 * at + 6)}`;
      });
      this.strip.style.background = `linear-gradient(to right, ${stops.join(",")})`;
      this.map = map;
    }
    this.words = { name, numbers: [low, (low + high) / 2, high].map((x) => written(x)) };
    this.name.textContent = name;
    this.words.numbers.forEach((text, i) => (this.numbers[i].textContent = text));
  }

  // Paint the bar into a picture of the screen.
  paint(pen, left, top, width, ink) {
    if (this.node.hidden) return;
    const table = tableOf(this.tables[this.map]);
    const height = width / 18;
    for (let x = 0; x < width; x++) {
      const at = 3 * Math.floor((x / width) * 256);
      pen.fillStyle = `rgb(${table[at]},${table[at + 1]},${table[at + 2]})`;
      pen.fillRect(left + x, top, 1, height);
    }
    pen.fillStyle = ink;
    pen.font = `${Math.round(width / 20)}px system-ui, sans-serif`;
    pen.textBaseline = "bottom";
    pen.textAlign = "left";
    pen.fillText(this.words.name, left, top - 4);
    pen.textBaseline = "top";
    ["left", "center", "right"].forEach((align, i) => {
      pen.textAlign = align;
      pen.fillText(this.words.numbers[i], left + (i * width) / 2, top + height + 3);
    });
  }
}

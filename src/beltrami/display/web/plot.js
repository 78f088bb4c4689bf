// A small plot on a canvas: axes with units, curves, stems, a mark.

import { decades, ticks, written } from "./ticks.js";

const MARGIN = { left: 30, right: 12, top: 10, bottom: 38 };

// Maps numbers to [0, 1] and back.
export function scale(low, high, logarithmic) {
  const [a, b] = logarithmic ? [Math.log(low), Math.log(high)] : [low, high];
  const span = b - a || 1;
  return {
    place: (x) => ((logarithmic ? Math.log(Math.max(x, low)) : x) - a) / span,
    value: (p) => (logarithmic ? Math.exp(a + p * span) : a + p * span),
    ticks: logarithmic ? decades(low, high) : ticks(low, high),
  };
}

export class Plot {
  constructor(label) {
    this.canvas = document.createElement("canvas");
    this.canvas.className = "plot";
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", label);
    this.contents = null;
    new ResizeObserver(() => this.contents && this.draw(this.contents)).observe(this.canvas);
  }

  // {x, y: {label, low, high, log}, curves: [{points, role, stems}], mark: {x, y}}
  draw(contents) {
    this.contents = contents;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [pixelWidth, pixelHeight] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== pixelWidth || this.canvas.height !== pixelHeight) {
      this.canvas.width = pixelWidth;
      this.canvas.height = pixelHeight;
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const style = getComputedStyle(document.documentElement);
    this.ink = (name) => style.getPropertyValue(`--${name}`).trim();
    pen.font = "11px system-ui, sans-serif";
    const { x, y } = contents;
    this.x = scale(x.low, x.high, x.log);
    this.y = scale(y.low, y.high, y.log);
    const widths = this.y.ticks.map((value) => pen.measureText(written(value)).width);
    const left = MARGIN.left + Math.max(...widths, 0);
    this.inner = {
      left,
      top: MARGIN.top,
      width: width - left - MARGIN.right,
      height: height - MARGIN.top - MARGIN.bottom,
    };
    this.drawAxes(pen, x, y);
    for (const curve of contents.curves) this.drawCurve(pen, curve);
    this.drawNames(pen, contents.curves.filter((curve) => curve.name));
    if (contents.mark) this.drawMark(pen, contents.mark);
  }

  at(x, y) {
    const { left, top, width, height } = this.inner;
    const up = Math.min(Math.max(this.y.place(y), -0.02), 1.02);
    return [left + this.x.place(x) * width, top + (1 - up) * height];
  }

  // The numbers at a place of the pointer.
  under(event) {
    const box = this.canvas.getBoundingClientRect();
    const { left, top, width, height } = this.inner;
    return {
      x: this.x.value((event.clientX - box.left - left) / width),
      y: this.y.value(1 - (event.clientY - box.top - top) / height),
    };
  }

  drawAxes(pen, x, y) {
    const { left, top, width, height } = this.inner;
    pen.strokeStyle = this.ink("line");
    pen.fillStyle = this.ink("quiet");
    pen.lineWidth = 1;
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    for (const value of this.y.ticks) {
      const [, at] = this.at(x.low, value);
      stroke(pen, [[left, Math.round(at) + 0.5], [left + width, Math.round(at) + 0.5]]);
      pen.fillText(written(value), left - 6, at);
    }
    pen.textBaseline = "top";
    pen.textAlign = "center";
    let free = -Infinity;
    for (const value of this.x.ticks) {
      const [at] = this.at(value, y.low);
      stroke(pen, [[at, top + height], [at, top + height + 4]]);
      const half = pen.measureText(written(value)).width / 2;
      if (at - half < free) continue;
      pen.fillText(written(value), at, top + height + 6);
      free = at + half + 6;
    }
    stroke(pen, [[left, top], [left, top + height], [left + width, top + height]]);
    pen.fillText(x.label, left + width / 2, top + height + 21);
    pen.save();
    pen.translate(11, top + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textBaseline = "middle";
    pen.fillText(y.label, 0, 0);
    pen.restore();
  }

  drawCurve(pen, { points, role = "accent", stems = false, dashed = false }) {
    pen.strokeStyle = this.ink(role);
    pen.lineWidth = stems ? 2 : 1.8;
    pen.setLineDash(dashed ? [5, 4] : []);
    if (stems) {
      const floor = this.contents.y.low;
      for (const [x, y] of points) stroke(pen, [this.at(x, floor), this.at(x, y)]);
    } else stroke(pen, points.map(([x, y]) => this.at(x, y)));
    pen.setLineDash([]);
  }

  // Names of the curves, in their colours, in the upper corner that is free (`names`).
  drawNames(pen, curves) {
    const { left, top, width } = this.inner;
    pen.textBaseline = "top";
    const corner = this.contents.names === "left" ? left + 8 : left + width - 4;
    pen.textAlign = this.contents.names === "left" ? "left" : "right";
    curves.forEach(({ name, role = "accent" }, i) => {
      pen.fillStyle = this.ink(role === "third" ? "quiet" : role);
      pen.fillText(name, corner, top + 2 + 14 * i);
    });
  }

  drawMark(pen, { x, y }) {
    const [left, top] = this.at(x, y);
    pen.fillStyle = this.ink("ink");
    pen.beginPath();
    pen.arc(left, top, 4.5, 0, 2 * Math.PI);
    pen.fill();
  }
}

function stroke(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

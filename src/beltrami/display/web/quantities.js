// The numbers of the chosen Laplacian, and how they are written: with their units.

import { unitOf, written } from "./ticks.js";

export class Quantities {
  constructor(data) {
    this.data = data;
  }

  get spectrum() {
    return this.data.spectra[this.state.spectrum];
  }

  get k() {
    return this.spectrum.eigenvalues.length;
  }

  mode(i, vertex) {
    return this.levels[i][vertex] * this.spectrum.steps[i];
  }

  largest(i) {
    return this.levels[i].reduce((top, x) => Math.max(top, Math.abs(x)), 0) * this.spectrum.steps[i];
  }

  mean(coefficients) {
    // the constant part: all modes of the eigenvalue 0 together, weighted with their own means
    const zero = this.spectrum.eigenvalues.filter((x) => x <= 1e-9 * this.spectrum.eigenvalues[this.k - 1]);
    if (zero.length !== 1) return NaN;
    return (coefficients[0] / Math.sqrt(this.spectrum.total)) * Math.sign(this.levels[0][0]);
  }

  numberOf(vertex) {
    return this.data.numbers[vertex];
  }

  written(x) {
    return Number.isNaN(x) ? "one for each component" : written(x);
  }

  get measured() {
    return !["degree", "unit"].includes(this.spectrum.mass);
  }

  unit(power) {
    return this.measured ? unitOf(this.data.header.unit, power) : "no unit";
  }

  withUnit(x, power) {
    return this.measured ? `${written(x)} ${unitOf(this.data.header.unit, power)}` : written(x);
  }

  lengthUnit() {
    return this.data.header.unit || "length";
  }

  withLength(x) {
    return `${written(x)} ${this.data.header.unit}`.trim();
  }

  lambdaLabel() {
    return this.measured ? `λ (${this.unit(-2)})` : "λ (no unit)";
  }

  per(what) {
    return this.measured ? `per ${this.data.header.unit ? this.unit(2) : what}` : "per degree";
  }
}

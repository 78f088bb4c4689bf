// The mesh, a noisy copy, and what denoising makes of it: one camera for the three.

import { readings, words } from "./controls.js";
import { formula } from "./formula.js";
import { written } from "./ticks.js";

export function comparePanel(app) {
  const { comparison } = app.data.header;
  if (comparison.reason) {
    return {
      id: "compare",
      title: "Denoise",
      section: "3.3.5",
      nodes: [words(`There is no noisy copy in this page: ${comparison.reason}`)],
      recipe: () => ({}),
      update() {},
    };
  }
  const told = readings();
  return {
    id: "compare",
    title: "Denoise",
    section: "3.3.5",
    nodes: [
      words(
        "Noise was added along the normals; denoise measured its level, and chose filters by an " +
          "unbiased estimate of the error. Turn one picture, and all turn.",
      ),
      formula("y_i = x_i + σ ε_i n_i"),
      told.node,
      ...comparison.warnings.map((text) => words(`Beware: ${text}.`)),
    ],
    views: "compare",
    captions: ["original", "with noise", "denoised"],
    recipe: () => ({}),
    update() {
      const { sigma, found, errors, mixture } = comparison;
      told.set("σ of the noise", app.withLength(sigma));
      told.set("σ that denoise found", app.withLength(found));
      told.set("Distance from the truth, noisy", app.withLength(errors.noisy));
      told.set("The same, denoised (both rms)", app.withLength(errors.denoised));
      told.set("Better by the factor", written(errors.noisy / (errors.denoised || 1)));
      told.set("Main filter", mixture[0] ?? "none");
    },
  };
}

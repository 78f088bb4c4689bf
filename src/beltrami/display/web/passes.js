// The sum of modes and the normals, on the graphics card, by transform feedback.

import { bindTexture, buffer, program, setUniforms, texture, vertexArray } from "./gl.js";
import { NOTHING, normals, synthesis } from "./shaders.js";

const WIDTH = 2048; // of the textures that hold one texel for each vertex
export const UNIT = { colours: 0, modes: 1, places: 2, corners: 3, picture: 4 };

const rowsFor = (count) => Math.max(1, Math.ceil(count / WIDTH));

// A buffer of places (x, y, z, value) and one of normals, for n vertices.
export function surfaceBuffers(gl, n) {
  return {
    n,
    places: buffer(gl, rowsFor(n) * WIDTH * 16),
    normals: buffer(gl, n * 12),
  };
}

function feedback(gl, run, output, n) {
  gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, output);
  gl.enable(gl.RASTERIZER_DISCARD);
  gl.beginTransformFeedback(gl.POINTS);
  run();
  gl.endTransformFeedback();
  gl.disable(gl.RASTERIZER_DISCARD);
  gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
  gl.bindVertexArray(null);
}

// Normals of any places over the faces whose rings are given.
export class NormalPass {
  constructor(gl, rings, n) {
    this.gl = gl;
    this.n = n;
    this.program = program(gl, normals, NOTHING, ["v_normal"]);
    this.places = texture(gl, gl.TEXTURE_2D, UNIT.places);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, WIDTH, rowsFor(n));
    this.corners = texture(gl, gl.TEXTURE_2D, UNIT.corners);
    const total = rings.corners.length / 2;
    const padded = new Int32Array(rowsFor(total) * WIDTH * 2);
    padded.set(rings.corners);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RG32I, WIDTH, rowsFor(total));
    gl.texSubImage2D(
      gl.TEXTURE_2D, 0, 0, 0, WIDTH, rowsFor(total), gl.RG_INTEGER, gl.INT, padded,
    );
    const ends = new Int32Array(2 * n);
    for (let v = 0; v < n; v++) ends.set([rings.start[v], rings.start[v + 1]], 2 * v);
    const ring = { buffer: buffer(gl, ends), size: 2, integer: true };
    this.array = vertexArray(gl, this.program, { a_ring: ring });
  }

  run(surface) {
    const gl = this.gl;
    bindTexture(gl, gl.TEXTURE_2D, UNIT.places, this.places);
    bindTexture(gl, gl.TEXTURE_2D, UNIT.corners, this.corners);
    gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, surface.places);
    gl.activeTexture(gl.TEXTURE0 + UNIT.places);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, WIDTH, rowsFor(this.n), gl.RGBA, gl.FLOAT, 0);
    gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
    gl.useProgram(this.program.made);
    setUniforms(gl, this.program, {
      u_places: { int: UNIT.places },
      u_corners: { int: UNIT.corners },
      u_width: { int: WIDTH },
    });
    gl.bindVertexArray(this.array);
    feedback(gl, () => gl.drawArrays(gl.POINTS, 0, this.n), surface.normals, this.n);
  }
}

// Levels of k modes, one Int16Array of n for each, four to a texel and one layer for four.
export function modeTexture(gl, levels, n) {
  const groups = Math.ceil(levels.length / 4);
  const rows = rowsFor(n);
  const made = texture(gl, gl.TEXTURE_2D_ARRAY, UNIT.modes);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16I, WIDTH, rows, groups);
  const layer = new Int16Array(WIDTH * rows * 4);
  for (let j = 0; j < groups; j++) {
    layer.fill(0);
    for (let c = 0; c < 4 && 4 * j + c < levels.length; c++) {
      const column = levels[4 * j + c];
      for (let v = 0; v < n; v++) layer[4 * v + c] = column[v];
    }
    gl.texSubImage3D(
      gl.TEXTURE_2D_ARRAY, 0, 0, 0, j, WIDTH, rows, 1, gl.RGBA_INTEGER, gl.SHORT, layer,
    );
  }
  return made;
}

export class SynthesisPass {
  constructor(gl, k, base, baseNormals) {
    this.gl = gl;
    this.n = base.length / 3;
    this.groups = Math.ceil(k / 4);
    this.program = program(gl, synthesis(this.groups), NOTHING, ["v_place"]);
    this.weights = new Float32Array(16 * this.groups);
    this.block = buffer(gl, this.weights.byteLength, gl.UNIFORM_BUFFER);
    const index = gl.getUniformBlockIndex(this.program.made, "Weights");
    gl.uniformBlockBinding(this.program.made, index, 0);
    this.values = buffer(gl, 4 * this.n);
    this.array = vertexArray(gl, this.program, {
      a_base: { buffer: buffer(gl, base), size: 3 },
      a_normal: { buffer: buffer(gl, baseNormals), size: 3 },
      a_value: { buffer: this.values, size: 1 },
    });
  }

  setValues(values) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.values);
    this.gl.bufferSubData(this.gl.ARRAY_BUFFER, 0, values);
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, null);
  }

  // Weights of the levels of each mode: {shape: three arrays of k or null, value: k or null,
  // centre, keep, keepValue, lift}.
  run(surface, modes, { shape, value, centre, keep, keepValue, lift }) {
    const gl = this.gl;
    const k = shape?.[0].length ?? value?.length ?? 0;
    this.weights.fill(0);
    let used = 0;
    for (let i = 0; i < k; i++) {
      for (let c = 0; c < 3; c++) this.weights[4 * i + c] = shape ? shape[c][i] : 0;
      this.weights[4 * i + 3] = value ? value[i] : 0;
      if (this.weights.subarray(4 * i, 4 * i + 4).some((w) => w !== 0)) used = i + 1;
    }
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.block);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, this.weights);
    bindTexture(gl, gl.TEXTURE_2D_ARRAY, UNIT.modes, modes);
    gl.useProgram(this.program.made);
    setUniforms(gl, this.program, {
      u_modes: { int: UNIT.modes },
      u_used: { int: Math.ceil(used / 4) },
      u_width: { int: WIDTH },
      u_centre: centre,
      u_keep: keep,
      u_keep_value: keepValue,
      u_lift: lift,
    });
    gl.bindVertexArray(this.array);
    feedback(gl, () => gl.drawArrays(gl.POINTS, 0, this.n), surface.places, this.n);
  }
}

// Read places back: (x, y, z, value) of each vertex.
export function readPlaces(gl, surface) {
  const read = new Float32Array(4 * surface.n);
  gl.bindBuffer(gl.ARRAY_BUFFER, surface.places);
  gl.getBufferSubData(gl.ARRAY_BUFFER, 0, read);
  gl.bindBuffer(gl.ARRAY_BUFFER, null);
  return read;
}

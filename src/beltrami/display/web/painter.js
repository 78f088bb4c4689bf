// What is seen: surfaces, their edges, a marked point, in one or more views of one canvas.

import { bindTexture, buffer, program, setUniforms, texture, vertexArray } from "./gl.js";
import { UNIT } from "./passes.js";
import {
  lineFragment, numberFragment, plainVertex, pointFragment, surfaceFragment, surfaceVertex,
} from "./shaders.js";

const PLAIN = [0, 0, 1, 1];

export class Painter {
  constructor(gl) {
    this.gl = gl;
    this.surface = program(gl, surfaceVertex, surfaceFragment);
    this.lines = program(gl, plainVertex, lineFragment);
    this.points = program(gl, plainVertex, pointFragment);
    this.numbers = program(gl, plainVertex, numberFragment);
    this.colours = texture(gl, gl.TEXTURE_2D, UNIT.colours);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    this.picture = texture(gl, gl.TEXTURE_2D, UNIT.picture);
    this.fill(new ImageData(1, 1));
    gl.enable(gl.DEPTH_TEST);
  }

  // Faces and edges to be drawn with the buffers of a surface; flat and uv if it has a map, and
  // where uv 0 is on a picture and how far uv 1 is from there.
  prepare({ places, normals }, faces, edges, { flat = null, uv = null, laid = PLAIN } = {}) {
    const gl = this.gl;
    const attributes = {
      a_place: { buffer: places, size: 4 },
      a_normal: { buffer: normals, size: 3 },
      ...(flat && { a_flat: { buffer: buffer(gl, flat), size: 3 } }),
      ...(uv && { a_uv: { buffer: buffer(gl, uv), size: 2 } }),
    };
    const filled = buffer(gl, faces, gl.ELEMENT_ARRAY_BUFFER);
    const drawn = buffer(gl, edges, gl.ELEMENT_ARRAY_BUFFER);
    return {
      laid,
      faces: faces.length,
      edges: edges.length,
      filled: vertexArray(gl, this.surface, attributes, filled),
      wired: vertexArray(gl, this.lines, attributes, drawn),
      pointed: vertexArray(gl, this.points, attributes),
      numbered: vertexArray(gl, this.numbers, attributes, filled),
    };
  }

  setColours(table) {
    const gl = this.gl;
    bindTexture(gl, gl.TEXTURE_2D, UNIT.colours, this.colours);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, table);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
  }

  // A picture that goes on periodically, and its halves; the card turns sRGB into light.
  setPicture(picture) {
    const gl = this.gl;
    this.fill(picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    for (const [key, value] of [
      [gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR],
      [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.REPEAT],
      [gl.TEXTURE_WRAP_T, gl.REPEAT],
    ]) {
      gl.texParameteri(gl.TEXTURE_2D, key, value);
    }
  }

  fill(picture) {
    const gl = this.gl;
    bindTexture(gl, gl.TEXTURE_2D, UNIT.picture, this.picture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  }

  clear([r, g, b]) {
    const gl = this.gl;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(r, g, b, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  // view: {mesh, box (pixels from the lower left), lens (of matrixOf), ...what is in `look`}.
  draw(view) {
    const gl = this.gl;
    const { mesh, box, lens, look } = view;
    gl.viewport(...box);
    bindTexture(gl, gl.TEXTURE_2D, UNIT.colours, this.colours);
    bindTexture(gl, gl.TEXTURE_2D, UNIT.picture, this.picture);
    gl.useProgram(this.surface.made);
    setUniforms(gl, this.surface, {
      u_matrix: lens.matrix,
      u_eye: lens.eye,
      u_front: look.front,
      u_unfold: view.unfold ?? 0,
      u_colours: { int: UNIT.colours },
      u_light: look.light,
      u_range: look.range,
      u_colored: view.plain ? 0 : look.colored,
      u_line: look.line,
      u_spacing: look.spacing,
      u_checks: look.checks,
      u_picture: { int: UNIT.picture },
      u_pictured: look.pictured,
      u_laid: mesh.laid,
      u_clay: look.clay,
      u_tint: look.tint,
    });
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.bindVertexArray(mesh.filled);
    gl.drawElements(gl.TRIANGLES, mesh.faces, gl.UNSIGNED_INT, 0);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (look.wire) this.drawWire(view);
    if (look.marked >= 0) this.drawPoint(view);
    gl.bindVertexArray(null);
  }

  drawWire({ mesh, lens, unfold = 0 }) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(this.lines.made);
    setUniforms(gl, this.lines, {
      u_matrix: lens.matrix, u_unfold: unfold, u_size: 1, u_ink: [0.05, 0.05, 0.1, 0.45],
    });
    gl.bindVertexArray(mesh.wired);
    gl.drawElements(gl.LINES, mesh.edges, gl.UNSIGNED_INT, 0);
    gl.disable(gl.BLEND);
  }

  drawPoint({ mesh, lens, look, unfold = 0 }) {
    const gl = this.gl;
    gl.useProgram(this.points.made);
    setUniforms(gl, this.points, {
      u_matrix: lens.matrix, u_unfold: unfold, u_size: look.size, u_ink: [0.1, 0.1, 0.12, 1],
    });
    gl.bindVertexArray(mesh.pointed);
    gl.drawArrays(gl.POINTS, look.marked, 1);
  }

  // The number of a corner of the face at a pixel of a view, or -1.
  pick({ mesh, box, lens, unfold = 0 }, x, y) {
    const gl = this.gl;
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const stores = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT]];
    const made = stores.map(([format, attachment]) => {
      const store = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, store);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, store);
      return store;
    });
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(x, y, 1, 1);
    gl.viewport(...box);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.numbers.made);
    setUniforms(gl, this.numbers, { u_matrix: lens.matrix, u_unfold: unfold, u_size: 1 });
    gl.bindVertexArray(mesh.numbered);
    gl.drawElements(gl.TRIANGLES, mesh.faces, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
    const bytes = new Uint8Array(4);
    gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(frame);
    made.forEach((store) => gl.deleteRenderbuffer(store));
    return (bytes[0] | (bytes[1] << 8) | (bytes[2] << 16) | (bytes[3] << 24)) - 1;
  }
}

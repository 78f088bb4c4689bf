// A thin layer over WebGL2: programs, buffers, textures.

export function program(gl, vertex, fragment, outputs = []) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.attachShader(made, shader);
  }
  if (outputs.length) gl.transformFeedbackVaryings(made, outputs, gl.SEPARATE_ATTRIBS);
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return { made, places: new Map() };
}

// Set uniforms by name: numbers as floats, {int} as integers, arrays by their length.
export function setUniforms(gl, { made, places }, values) {
  for (const [name, value] of Object.entries(values)) {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
    const at = places.get(name);
    if (typeof value === "number") gl.uniform1f(at, value);
    else if ("int" in value) gl.uniform1i(at, value.int);
    else if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
    else gl[`uniform${value.length}fv`](at, value);
  }
}

export function buffer(gl, data, target = gl.ARRAY_BUFFER) {
  const made = gl.createBuffer();
  gl.bindBuffer(target, made);
  gl.bufferData(target, data, typeof data === "number" ? gl.DYNAMIC_COPY : gl.STATIC_DRAW);
  gl.bindBuffer(target, null);
  return made;
}

// A vertex array of {name: {buffer, size, integer}} for a program, and of indices if there are any.
export function vertexArray(gl, { made }, attributes, indices = null) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  for (const [name, { buffer: source, size, integer }] of Object.entries(attributes)) {
    const at = gl.getAttribLocation(made, name);
    if (at < 0) continue;
    gl.bindBuffer(gl.ARRAY_BUFFER, source);
    gl.enableVertexAttribArray(at);
    if (integer) gl.vertexAttribIPointer(at, size, gl.INT, 0, 0);
    else gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
  }
  if (indices) gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
  gl.bindVertexArray(null);
  gl.bindBuffer(gl.ARRAY_BUFFER, null);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, null);
  return array;
}

export function texture(gl, target, unit) {
  const made = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(target, made);
  for (const [key, value] of [
    [gl.TEXTURE_MIN_FILTER, gl.NEAREST],
    [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
    [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
  ]) {
    gl.texParameteri(target, key, value);
  }
  return made;
}

export function bindTexture(gl, target, unit, made) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(target, made);
}

// Graphics without a card: smooth edges would cost half of the speed.
export function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const told = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? gl.getParameter(told.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

// The programs of the graphics card, in GLSL ES 3.00.

const HEAD = "#version 300 es\nprecision highp float;\nprecision highp int;\n";

export const NOTHING = `${HEAD}void main() {}`;

// A vertex of the sum of modes: place (x, y, z) and value. Four modes share a texel, as integers;
// their steps are in the weights.
export const synthesis = (groups) => `${HEAD}
uniform highp isampler2DArray u_modes;
layout(std140) uniform Weights { vec4 u_weights[${4 * groups}]; };
uniform int u_used;
uniform int u_width;
uniform vec3 u_centre;
uniform float u_keep;
uniform float u_keep_value;
uniform float u_lift;
in vec3 a_base;
in vec3 a_normal;
in float a_value;
out vec4 v_place;
void main() {
  vec4 sum = vec4(0.0);
  ivec2 at = ivec2(gl_VertexID % u_width, gl_VertexID / u_width);
  for (int j = 0; j < u_used; j++) {
    vec4 phi = vec4(texelFetch(u_modes, ivec3(at, j), 0));
    sum += phi.x * u_weights[4 * j] + phi.y * u_weights[4 * j + 1]
      + phi.z * u_weights[4 * j + 2] + phi.w * u_weights[4 * j + 3];
  }
  float value = sum.w + u_keep_value * a_value;
  vec3 x = u_centre + u_keep * (a_base - u_centre) + sum.xyz;
  v_place = vec4(x + u_lift * value * a_normal, value);
}`;

// The normal of a vertex: the sum of those of its faces, weighted with their areas.
export const normals = `${HEAD}
uniform sampler2D u_places;
uniform highp isampler2D u_corners;
uniform int u_width;
in ivec2 a_ring;
out vec3 v_normal;
vec3 place(int v) { return texelFetch(u_places, ivec2(v % u_width, v / u_width), 0).xyz; }
void main() {
  vec3 x = place(gl_VertexID);
  vec3 sum = vec3(0.0);
  for (int i = a_ring.x; i < a_ring.y; i++) {
    ivec2 pair = texelFetch(u_corners, ivec2(i % u_width, i / u_width), 0).xy;
    sum += cross(place(pair.x) - x, place(pair.y) - x);
  }
  float size = length(sum);
  v_normal = size > 0.0 ? sum / size : vec3(0.0, 0.0, 1.0);
}`;

// The surface; on the way to its map, places are mixed with those in the plane.
export const surfaceVertex = `${HEAD}
uniform mat4 u_matrix;
uniform float u_unfold;
uniform vec3 u_front;
in vec4 a_place;
in vec3 a_normal;
in vec3 a_flat;
in vec2 a_uv;
out vec3 v_normal;
out vec3 v_position;
out vec2 v_uv;
out float v_value;
void main() {
  vec3 x = mix(a_place.xyz, a_flat, u_unfold);
  v_normal = mix(a_normal, u_front, u_unfold);
  v_position = x;
  v_uv = a_uv;
  v_value = a_place.w;
  gl_Position = u_matrix * vec4(x, 1.0);
}`;

// Colour times light, as display/shade.py has it; lines are drawn where f passes a level.
export const surfaceFragment = `${HEAD}
uniform sampler2D u_colours;
uniform vec3 u_light;
uniform vec3 u_eye;
uniform vec2 u_range;
uniform float u_colored;
uniform float u_line;
uniform float u_spacing;
uniform float u_checks;
uniform sampler2D u_picture;
uniform float u_pictured;
uniform vec4 u_laid;
uniform vec3 u_clay;
uniform float u_tint;
in vec3 v_normal;
in vec3 v_position;
in vec2 v_uv;
in float v_value;
out vec4 colour;
float covered(float value) {
  float step = fwidth(value);
  if (step < 1e-6 * (u_range.y - u_range.x)) return 0.0; // zero on a whole piece is no line
  return 1.0 - smoothstep(0.6, 1.6, abs(value) / step);
}
void main() {
  vec3 n = normalize(v_normal);
  bool outside = dot(n, u_eye - v_position) >= 0.0;
  vec3 seen = outside ? n : -n;
  float fill = max(dot(seen, normalize(u_eye - v_position)), 0.0);
  float light = 0.38 + 0.50 * max(dot(seen, u_light), 0.0) + 0.16 * fill;
  float t = clamp((v_value - u_range.x) / (u_range.y - u_range.x), 0.0, 1.0);
  bool mapped = v_uv.x >= -1.0; // corners without coordinates are far to the left
  float colored = mapped ? u_colored : 0.0; // what a map does is not known there
  vec3 paint = mix(u_clay, texture(u_colours, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb, colored);
  if (u_pictured > 0.0) {
    vec3 light = texture(u_picture, u_laid.xy + v_uv * u_laid.zw).rgb;
    vec3 bright = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    vec3 shown = mix(12.92 * light, bright, step(0.0031308, light));
    // under a function it is grey
    if (mapped) paint = mix(shown, paint * dot(shown, vec3(0.2126, 0.7152, 0.0722)), u_colored);
  }
  if (u_checks > 0.0 && mapped) {
    vec2 cell = floor(v_uv * u_checks);
    paint *= mod(cell.x + cell.y, 2.0) < 0.5 ? 1.0 : 0.62;
  }
  if (!outside) paint = mix(paint, vec3(0.58, 0.65, 0.74), u_tint);
  float line = u_line * covered(v_value);
  if (u_spacing > 0.0) {
    float level = v_value / u_spacing;
    float away = abs(fract(level + 0.5) - 0.5) / max(fwidth(level), 1e-20);
    if (abs(level) > 0.5) line = max(line, 0.55 * (1.0 - smoothstep(0.4, 1.2, away)));
  }
  colour = vec4(mix(min(paint * light, 1.0), vec3(0.05, 0.05, 0.07), line), 1.0);
}`;

export const plainVertex = `${HEAD}
uniform mat4 u_matrix;
uniform float u_unfold;
uniform float u_size;
in vec4 a_place;
in vec3 a_flat;
flat out int v_id;
void main() {
  v_id = gl_VertexID;
  gl_Position = u_matrix * vec4(mix(a_place.xyz, a_flat, u_unfold), 1.0);
  gl_Position.z -= 3e-4 * gl_Position.w;
  gl_PointSize = u_size;
}`;

export const lineFragment = `${HEAD}
uniform vec4 u_ink;
out vec4 colour;
void main() { colour = u_ink; }`;

export const pointFragment = `${HEAD}
uniform vec4 u_ink;
out vec4 colour;
void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5) discard;
  colour = r > 0.34 ? vec4(1.0) : u_ink;
}`;

// The number of a vertex as a colour: which one is under the pointer.
export const numberFragment = `${HEAD}
flat in int v_id;
out vec4 colour;
void main() {
  int id = v_id + 1;
  colour = vec4(ivec4(id, id >> 8, id >> 16, id >> 24) & 255) / 255.0;
}`;

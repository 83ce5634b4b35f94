#include "studio/render/shaders.h"

namespace ctpm {
namespace {

const char* const kVersion = "#version 330 core\n";

// Studio backdrop, brightest behind the scene; the dither hides bands in the video.
const char* const kBackdrop = R"(
uniform vec2 picture_size;
vec3 backdrop() {
  vec2 q = gl_FragCoord.xy / picture_size;
  float r = length((q - vec2(0.5, 0.56)) * vec2(1.0, 0.8));
  vec3 c = mix(vec3(0.70, 0.75, 0.79), vec3(0.23, 0.28, 0.335), smoothstep(0.05, 0.85, r));
  return c * mix(0.86, 1.04, smoothstep(0.0, 1.0, q.y));
}
vec3 dither(vec3 c) {
  float h = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
  return c + (h - 0.5) / 255.0;
}
)";

// Key light from the upper left, cool fill from the right, rim from behind; a room to be mirrored in wet
// tissue.
const char* const kLight = R"(
uniform vec3 eye, up, key_light, fill_light, rim_light;
uniform vec3 tool_tip, tool_heel;
uniform float tool_radius;
uniform float ground_height, scene_size;

float tool_shade(vec3 p, vec3 n) {
  if (tool_radius <= 0.0) return 1.0;
  vec3 along = tool_heel - tool_tip;
  float t = clamp(dot(p - tool_tip, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
  vec3 d = tool_tip + t * along - p;
  float square = max(dot(d, d), 1e-12);
  float facing = max(dot(n, d) * inversesqrt(square) + 0.15, 0.0);
  return 1.0 - min(0.85, 1.5 * facing * tool_radius * tool_radius / square);
}
float ground_shade(vec3 p, vec3 n) {
  float h = (dot(p, up) - ground_height) / scene_size;
  float down = 0.5 - 0.5 * dot(n, up);
  return 1.0 - 0.6 * down * exp(-7.0 * max(h, 0.0));
}
vec3 room(vec3 r) {
  float height = dot(r, up);
  vec3 c = mix(vec3(0.10, 0.09, 0.09), vec3(0.34, 0.38, 0.42), smoothstep(-0.35, 0.55, height));
  c += vec3(5.5, 5.2, 4.9) * smoothstep(0.955, 0.988, dot(r, key_light));
  c += vec3(0.75, 0.85, 1.0) * smoothstep(0.80, 0.97, dot(r, fill_light));
  c += vec3(1.1) * smoothstep(0.86, 0.97, dot(r, rim_light));
  return c;
}
// Light that wraps around the edge of shadow, in red furthest, as light does that passes through tissue.
vec3 wrapped(float c, vec3 wrap) { vec3 w = clamp((c + wrap) / (1.0 + wrap), 0.0, 1.0); return w * w; }
vec3 diffuse_light(vec3 n, vec3 wrap, float shade) {
  vec3 ambient = mix(vec3(0.30, 0.22, 0.20), vec3(0.50, 0.54, 0.58), 0.5 + 0.5 * dot(n, up)) * shade;
  vec3 key = vec3(1.55, 1.47, 1.38) * wrapped(dot(n, key_light), wrap) * mix(1.0, shade, 0.7);
  vec3 fill = vec3(0.26, 0.30, 0.36) * wrapped(dot(n, fill_light), wrap) * shade;
  vec3 rim = vec3(0.38) * wrapped(dot(n, rim_light), vec3(0.05));
  return ambient + key + fill + rim;
}
float fresnel(float c) { float m = 1.0 - clamp(c, 0.0, 1.0); float m2 = m * m; return 0.035 + 0.55 * m2 * m2 * m; }
vec3 to_srgb(vec3 c) {
  c = c * (1.0 + 0.16 * c) / (1.0 + 0.62 * c);
  return pow(max(c, vec3(0.0)), vec3(1.0 / 2.2));
}
)";

const char* const kFullScreenVertex = R"(
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * place - 1.0, 0.0, 1.0);
}
)";

const char* const kOrganVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 3) in float crevice;
uniform mat4 clip_from_world;
centroid out vec3 p, n, q;
centroid out float hollow;
void main() {
  p = position; n = normal; q = rest; hollow = crevice;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

const char* const kOrganFragment = R"(
centroid in vec3 p, n, q;
centroid in float hollow;
uniform sampler3D noise;
uniform vec3 outer_colour, inner_colour;
uniform float wetness;
uniform int is_wall;
uniform int is_glassy;
out vec4 colour;
void main() {
  if (is_glassy == 1 && !gl_FrontFacing) discard;
  vec3 v = normalize(eye - p);
  vec3 m = normalize(n);
  bool inside = is_wall == 1 || !gl_FrontFacing;
  if (is_wall == 1 ? dot(m, v) < 0.0 : !gl_FrontFacing) m = -m;
  // Noise is fixed to the tissue: cells of some 4 mm for its relief, of some 25 mm for its colour.
  vec4 fine = texture(noise, q * 62.0) * 2.0 - 1.0;
  vec4 broad = texture(noise, q * 9.0) * 2.0 - 1.0;
  vec3 bumped = normalize(m - (inside ? 0.20 : 0.07) * (fine.xyz - m * dot(m, fine.xyz)) - 0.05 * broad.xyz);
  float shade = tool_shade(p, m) * ground_shade(p, m) * clamp(1.0 - 1.6 * max(-hollow, 0.0), 0.35, 1.0);
  vec3 base;
  if (inside) {
    base = inner_colour * (1.0 + 0.30 * fine.a + 0.16 * broad.a);
    if (is_wall == 0) shade *= 0.45;
  } else {
    base = outer_colour * (1.0 + 0.20 * broad.a + 0.09 * fine.a);
    base = mix(base, base * vec3(1.12, 0.86, 0.80), smoothstep(0.0, 0.8, broad.a));
    base *= 1.0 + 0.6 * clamp(hollow, 0.0, 0.3);
  }
  vec3 c = base * diffuse_light(bumped, vec3(0.38, 0.16, 0.12), shade);
  float facing = dot(bumped, v);
  // Glow at grazing angles, where light has passed a thin layer.
  c += base * vec3(0.35, 0.10, 0.08) * pow(1.0 - clamp(facing, 0.0, 1.0), 3.0) * shade;
  vec3 mirrored = reflect(-v, normalize(mix(m, bumped, 0.55)));
  c += wetness * (inside ? 0.55 : 1.0) * fresnel(facing) * room(mirrored) * mix(0.3, 1.0, shade);
  float broad_spot = max(dot(normalize(key_light + v), bumped), 0.0);
  c += wetness * vec3(0.10, 0.095, 0.09) * pow(broad_spot, 28.0) * shade;
  float edge = 1.0 - clamp(facing, 0.0, 1.0);
  colour = vec4(dither(to_srgb(c)), is_glassy == 1 ? mix(0.16, 0.85, edge * edge) : 1.0);
}
)";

const char* const kToolVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float part;
uniform mat4 clip_from_world, world_from_tool;
out vec3 p, n;
flat out float piece;
void main() {
  vec4 w = world_from_tool * vec4(position, 1.0);
  p = w.xyz; n = mat3(world_from_tool) * normal; piece = part;
  gl_Position = clip_from_world * w;
}
)";

const char* const kToolFragment = R"(
in vec3 p, n;
flat in float piece;
out vec4 colour;
void main() {
  vec3 v = normalize(eye - p);
  vec3 m = normalize(n);
  if (dot(m, v) < 0.0) m = -m;
  vec3 mirrored = room(reflect(-v, m));
  vec3 c;
  if (piece < 0.5)
    c = vec3(0.62, 0.65, 0.69) * (0.30 * diffuse_light(m, vec3(0.0), 1.0) + 0.85 * mirrored);
  else
    c = vec3(0.055, 0.075, 0.10) * diffuse_light(m, vec3(0.0), 1.0) + 1.3 * fresnel(dot(m, v)) * mirrored;
  colour = vec4(dither(to_srgb(c)), 1.0);
}
)";

// A sphere is a square that faces the eye; the fragment meets it exactly.
const char* const kSphereVertex = R"(
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec3 tint;
uniform mat4 clip_from_world;
uniform vec3 eye, up;
out vec3 on_square;
flat out vec4 ball;
flat out vec3 paint;
void main() {
  vec3 d = sphere.xyz - eye;
  float square = dot(d, d);
  vec3 forward = d * inversesqrt(square);
  vec3 side = normalize(cross(forward, abs(dot(forward, up)) < 0.99 ? up : vec3(up.y, up.z, up.x)));
  vec3 top = cross(side, forward);
  float size = 1.08 * sphere.w * inversesqrt(max(1.0 - sphere.w * sphere.w / square, 0.01));
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  on_square = sphere.xyz + size * (corner.x * side + corner.y * top);
  ball = sphere; paint = tint;
  gl_Position = clip_from_world * vec4(on_square, 1.0);
}
)";

const char* const kSphereFragment = R"(
in vec3 on_square;
flat in vec4 ball;
flat in vec3 paint;
uniform mat4 clip_from_world;
out vec4 colour;
void main() {
  vec3 d = normalize(on_square - eye);
  vec3 to_ball = ball.xyz - eye;
  float along = dot(to_ball, d);
  float miss = length(to_ball - along * d);
  float cover = clamp((ball.w - miss) / max(fwidth(miss), 1e-9) + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec3 p = eye + (along - sqrt(max(ball.w * ball.w - miss * miss, 0.0))) * d;
  vec3 m = (p - ball.xyz) / ball.w;
  float shade = tool_shade(p, m) * ground_shade(p, m);
  vec3 c = paint * diffuse_light(m, vec3(0.1), shade) + fresnel(dot(m, -d)) * room(reflect(d, m)) * 0.8;
  vec4 clip = clip_from_world * vec4(p, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  colour = vec4(dither(to_srgb(c)), cover);
}
)";

const char* const kGroundVertex = R"(
uniform mat4 clip_from_world;
uniform vec3 ground_centre, ground_x, ground_y;
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = corner;
  vec2 s = 2.0 * corner - 1.0;
  gl_Position = clip_from_world * vec4(ground_centre + s.x * ground_x + s.y * ground_y, 1.0);
}
)";

const char* const kGroundFragment = R"(
in vec2 place;
uniform sampler2D contact, wide;
out vec4 colour;
void main() {
  float shadow = 0.42 * texture(contact, place).r + 0.34 * texture(wide, place).r;
  vec2 s = abs(2.0 * place - 1.0);
  shadow *= 1.0 - smoothstep(0.85, 1.0, max(s.x, s.y));
  colour = vec4(dither(backdrop() * (1.0 - vec3(0.96, 1.0, 1.0) * min(shadow, 0.8))), 1.0);
}
)";

const char* const kShadowVertex = R"(
layout(location = 0) in vec3 position;
uniform vec3 ground_centre, ground_x, ground_y, up;
uniform float reach;
out float closeness;
void main() {
  vec3 d = position - ground_centre;
  closeness = dot(d, up) / reach;
  gl_Position = vec4(dot(d, ground_x) / dot(ground_x, ground_x), dot(d, ground_y) / dot(ground_y, ground_y), 0.0, 1.0);
}
)";

const char* const kShadowFragment = R"(
in float closeness;
out vec4 colour;
void main() { colour = vec4(exp(-max(closeness, 0.0))); }
)";

const char* const kBlurFragment = R"(
in vec2 place;
uniform sampler2D picture;
uniform vec2 stride;
out vec4 colour;
void main() {
  float sum = 0.0, total = 0.0;
  for (int i = -6; i <= 6; ++i) {
    float w = exp(-float(i * i) / 14.0);
    sum += w * texture(picture, place + float(i) * stride).r;
    total += w;
  }
  colour = vec4(sum / total);
}
)";

std::string join(const char* a, const char* b = "", const char* c = "") {
  return std::string(kVersion) + a + b + c;
}

}  // namespace

ShaderSource background_shader() {
  return {join(kFullScreenVertex),
          join(kBackdrop, "out vec4 colour;\nvoid main() { colour = vec4(dither(backdrop()), 1.0); }\n")};
}
ShaderSource organ_shader() { return {join(kOrganVertex), join(kBackdrop, kLight, kOrganFragment)}; }
ShaderSource tool_shader() { return {join(kToolVertex), join(kBackdrop, kLight, kToolFragment)}; }
ShaderSource sphere_shader() { return {join(kSphereVertex), join(kBackdrop, kLight, kSphereFragment)}; }
ShaderSource ground_shader() { return {join(kGroundVertex), join(kBackdrop, kGroundFragment)}; }
ShaderSource shadow_shader() { return {join(kShadowVertex), join(kShadowFragment)}; }
ShaderSource shadow_blur_shader() { return {join(kFullScreenVertex), join(kBlurFragment)}; }

}  // namespace ctpm

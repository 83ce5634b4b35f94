#include "studio/render/shaders.h"

#include <initializer_list>

namespace ctpm::render {
namespace {

const char* const kVersion = "#version 330 core\n";

// Key light from the upper left, cool fill from the right, rim from behind; a room to be mirrored in wet
// tissue.
const char* const kLight = R"(
uniform vec3 eye, up, key_light, fill_light, rim_light;
vec3 soft_room(vec3 r) {
  float height = dot(r, up);
  vec3 c = mix(vec3(0.10, 0.09, 0.09), vec3(0.34, 0.38, 0.42), smoothstep(-0.35, 0.55, height));
  return c + vec3(0.75, 0.85, 1.0) * smoothstep(0.80, 0.97, dot(r, fill_light));
}
vec3 key_in_room(float towards) { return vec3(6.0, 5.7, 5.4) * smoothstep(0.925, 1.0, towards); }
float rim_in_room(float towards) { return 1.1 * smoothstep(0.86, 0.97, towards); }
vec3 room(vec3 r) { return soft_room(r) + key_in_room(dot(r, key_light)) + rim_in_room(dot(r, rim_light)); }
// Light that wraps around the edge of shadow, in red furthest, as light does that passes through tissue.
vec3 wrapped(float c, vec3 wrap) { vec3 w = clamp((c + wrap) / (1.0 + wrap), 0.0, 1.0); return w * w; }
const vec3 kKey = vec3(1.55, 1.47, 1.38);
vec3 diffuse_light(vec3 n, vec3 wrap, float shade) {
  vec3 ambient = mix(vec3(0.30, 0.22, 0.20), vec3(0.50, 0.54, 0.58), 0.5 + 0.5 * dot(n, up)) * shade;
  vec3 key = kKey * wrapped(dot(n, key_light), wrap) * mix(1.0, shade, 0.7);
  vec3 fill = vec3(0.26, 0.30, 0.36) * wrapped(dot(n, fill_light), wrap) * shade;
  float rim = clamp((dot(n, rim_light) + 0.05) / 1.05, 0.0, 1.0);
  return ambient + key + fill + 0.38 * rim * rim;
}
float fresnel(float c) { float m = 1.0 - clamp(c, 0.0, 1.0); float m2 = m * m; return 0.035 + 0.55 * m2 * m2 * m; }
// Soft shoulder, then gamma 2, which is close to sRGB and one square root.
vec3 to_srgb(vec3 c) { return sqrt(max(c * (1.0 + 0.16 * c) / (1.0 + 0.62 * c), vec3(0.0))); }
)";

// Soft shadows of the tools and of the ground nearby.
const char* const kShade = R"(
uniform vec3 tool_tip, tool_heel, second_tip, second_heel;
uniform float tool_radius, second_radius;
uniform float ground_height, scene_size;

float shade_of(vec3 p, vec3 n, vec3 tip, vec3 heel, float radius) {
  if (radius <= 0.0) return 1.0;
  vec3 along = heel - tip;
  float t = clamp(dot(p - tip, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
  vec3 d = tip + t * along - p;
  float square = max(dot(d, d), 1e-12);
  float facing = max(dot(n, d) * inversesqrt(square) + 0.15, 0.0);
  return 1.0 - min(0.85, 1.5 * facing * radius * radius / square);
}
float tool_shade(vec3 p, vec3 n) {
  return shade_of(p, n, tool_tip, tool_heel, tool_radius) * shade_of(p, n, second_tip, second_heel, second_radius);
}
float ground_shade(vec3 p, vec3 n) {
  float h = (dot(p, up) - ground_height) / scene_size;
  float down = 0.5 - 0.5 * dot(n, up);
  return 1.0 - 0.6 * down * exp(-7.0 * max(h, 0.0));
}
)";

// Where the fine relief is looked up, bent so that nothing repeats visibly.
const char* const kBend = R"(
vec3 wave(vec3 x) { x = fract(x) * 2.0 - 1.0; return 4.0 * x * (abs(x) - 1.0); }
vec3 bend(vec3 rest) { return rest + 0.0021 * wave(rest.yzx * 47.0) + 0.0011 * wave(rest.zxy * 97.0); }
)";

// What changes slowly over tissue, and how it follows small turns of the normal. Worked out at the vertices
// of the outer surface: its triangles are so small that most of the work on their pixels would be done in
// vain.
const char* const kSmooth = R"(
uniform float wetness;
struct Smooth {
  vec3 body;                // light out of the tissue
  vec3 key_side, eye_side;  // parts of the ways to key light and eye along the surface
  vec4 turn;                // normal towards eye and key light; share that body gains by a turn to the key; film's strength
  vec3 mirror;              // the mirrored way towards key and rim; normal towards rim
  float film;               // what the wet film mirrors of the room, without key and rim, in kFilm
};
const vec3 kFilm = vec3(0.86, 0.95, 1.06);
Smooth smooth_light(vec3 p, vec3 n, vec3 base, float shade, float mirror) {
  const vec3 kWrap = vec3(0.38, 0.16, 0.12), kLuma = vec3(0.3, 0.6, 0.1);
  vec3 v = normalize(eye - p);
  float facing = dot(n, v), key = dot(n, key_light);
  float edge = 1.0 - clamp(facing, 0.0, 1.0), strength = wetness * mirror * mix(0.3, 1.0, shade);
  vec3 r = 2.0 * facing * n - v, light = diffuse_light(n, kWrap, shade);
  vec3 gain = 2.0 * kKey * clamp((key + kWrap) / (1.0 + kWrap), 0.0, 1.0) / (1.0 + kWrap) * mix(1.0, shade, 0.7);
  Smooth s;
  // Glow at grazing angles, where light has passed a thin layer.
  s.body = base * (light + vec3(0.35, 0.10, 0.08) * (edge * edge * edge * shade));
  s.film = strength * dot(soft_room(r), vec3(0.35));
  s.key_side = key_light - key * n, s.eye_side = v - facing * n;
  s.turn = vec4(facing, key, dot(base * gain, kLuma) / dot(s.body, kLuma), strength);
  s.mirror = vec3(dot(r, key_light), dot(r, rim_light), dot(n, rim_light));
  // A broad highlight. Its half vector is key_light + v; what remains is the square of its cosine.
  float spot2 = max(key + facing, 0.0) * max(key + facing, 0.0) / max(2.0 + 2.0 * dot(key_light, v), 0.01);
  float spot4 = spot2 * spot2, spot8 = spot4 * spot4;
  s.body += vec3(0.10, 0.095, 0.09) * (strength * spot8 * spot8 * spot8);
  return s;
}
)";

// What the outside's pixels get from its vertices, in few slots: with thousands of small triangles, what each carries
// costs as much as what is done with it.
const char* const kCarried = R"(
#ifndef INSIDE
CARRIED vec4 body_film, key_side_mirror, eye_side_mirror, turn, place_mirror;
#ifdef OOZES
CARRIED float lip;
#endif
#endif
)";

const char* const kOrganVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 3) in vec4 crevice_stain_lip_rind;
uniform mat4 clip_from_world;
uniform vec3 outer_colour;
out vec3 p;
#ifdef INSIDE
out vec3 n, at_rest;
out vec3 shadow_stain_rind;
#endif
void main() {
  float hollow = crevice_stain_lip_rind.x, stain = crevice_stain_lip_rind.y;
  float shade = tool_shade(position, normal) * ground_shade(position, normal) *
                clamp(1.0 + 1.6 * min(hollow, 0.0), 0.35, 1.0);
  p = position;
#ifdef INSIDE
  n = normal; at_rest = rest; shadow_stain_rind = vec3(shade, stain, crevice_stain_lip_rind.w);
#else
  vec3 base = outer_colour * (1.0 + 0.20 * stain);
  base = mix(base, base * vec3(1.12, 0.86, 0.80), clamp(stain, 0.0, 1.0));
  base *= 1.0 + 0.6 * clamp(hollow, 0.0, 0.3);
  // At the outline and beyond it a normal turns away, and would mirror the dark floor along it.
  vec3 v = normalize(eye - position);
  Smooth slow = smooth_light(position, normalize(normal + max(0.15 - dot(normal, v), 0.0) * v), base, shade, 1.0);
  body_film = vec4(slow.body, slow.film);
  key_side_mirror = vec4(slow.key_side, slow.mirror.x), eye_side_mirror = vec4(slow.eye_side, slow.mirror.y);
  turn = slow.turn, place_mirror = vec4(bend(rest), slow.mirror.z);
#ifdef OOZES
  lip = crevice_stain_lip_rind.z;
#endif
#endif
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

// Small relief that is fixed to the tissue: where two gyroids, turned against each other, meet in bumps.
// Parabolas stand for sines. Gradient, and height.
const char* const kRelief = R"(
vec4 gyroid(vec3 x) {
  x = fract(x) * 2.0 - 1.0;
  vec3 a = abs(x), z = a - 0.5;
  vec3 s = x * (a - 1.0), c = z * (1.0 - abs(z));  // a quarter of sine and cosine
  return vec4(c.xyz * c.yzx - s.zxy * s.xyz, dot(s, c.yzx));
}
vec4 relief(vec3 x) {
  const mat3 turn = mat3(0.36, 0.48, -0.80, -0.80, 0.60, 0.0, 0.48, 0.64, 0.60);
  vec4 one = gyroid(x * 141.0), other = gyroid(turn * x * 197.0);
  return 192.0 * vec4(one.xyz * other.w + 1.35 * (other.xyz * turn) * one.w, one.w * other.w);
}
)";

// The inside of an organ: of its outermost spheres and below, or of its layers of tissue by their depth at rest.
const char* const kTissue = R"(
uniform vec3 inner_colour, rind_colour;
uniform int layer_count;
uniform float layer_end[8];  // [m], ascending
uniform vec3 layer_colour[8];
uniform sampler3D depth_at_rest;
uniform vec3 depth_low, depth_size;
uniform float relief_width;  // [m] of the shades in a section; 0: none, as on a wall
float depth_of(vec3 rest) { return texture(depth_at_rest, (rest - depth_low) / depth_size).r; }
vec3 tissue_colour(float depth, float rind) {
  if (layer_count == 0) return mix(inner_colour, rind_colour, rind);
  float soft = 0.7 * fwidth(depth) + 1e-5;
  vec3 c = inner_colour;
  for (int i = layer_count - 1; i >= 0; --i)
    c = mix(layer_colour[i], c, smoothstep(layer_end[i] - soft, layer_end[i] + soft, depth));
  return c;
}
// A section is no flat picture: its rim turns away, and each layer lies a little below the one around it, whose edge
// catches the light.
float fall(float depth, float width) {
  float left = max(1.0 - depth / width, 0.0);
  return left * left;
}
float section_shade(float depth) {
  float soft = 0.7 * fwidth(depth) + 1e-5, shade = 1.0 - 0.5 * fall(max(depth, 0.0), relief_width);
  for (int i = 0; i < layer_count; ++i) {
    float below = depth - layer_end[i], is_below = smoothstep(-soft, soft, below);
    shade *= 1.0 + mix(0.18, -0.45, is_below) * fall(abs(below), relief_width * mix(0.5, 1.0, is_below));
  }
  return shade;
}
)";

const char* const kOrganFragment = R"(
in vec3 p;
#ifdef INSIDE
in vec3 n, at_rest;
in vec3 shadow_stain_rind;
uniform float blood;  // 0: none, as in a section; 1: a fresh wall
#elif defined OOZES
uniform vec3 lip_tint;
uniform float blood;  // 0: none oozes
#endif
uniform vec3 cutaway_point, cutaway_normal;
out vec4 colour;
void main() {
#ifdef CUTAWAY
  if (dot(p - cutaway_point, cutaway_normal) > 0.0) discard;
#endif
#ifdef INSIDE
  const float kRough = 0.05, kStained = 0.05;
  vec3 q = bend(at_rest), m = normalize(n);
  if (dot(m, eye - p) < 0.0) m = -m;
  float depth = depth_of(at_rest);
  vec3 base = tissue_colour(depth, shadow_stain_rind.z) * (1.0 + 0.16 * shadow_stain_rind.y);
  // A fresh wall bleeds: a wet film of blood, here thicker, there thinner.
  vec4 fine = relief(q);
  float film = blood * clamp(0.34 - 0.06 * fine.a + 0.35 * shadow_stain_rind.y, 0.15, 0.8);
  base = mix(base, vec3(0.34, 0.0, 0.006), film);
  float mirror = 0.55 + 0.6 * film;
  if (relief_width > 0.0) base *= section_shade(depth), mirror = 0.25;  // cut flat, it would shine all over
  Smooth slow = smooth_light(p, m, base, shadow_stain_rind.x, mirror);
#else
  const float kRough = 0.017, kStained = 0.035;
  vec4 fine = relief(place_mirror.xyz);
  Smooth slow = Smooth(body_film.rgb, key_side_mirror.xyz, eye_side_mirror.xyz, turn,
                       vec3(key_side_mirror.w, eye_side_mirror.w, place_mirror.w), body_film.a);
#endif
  float to_key = -kRough * dot(fine.xyz, slow.key_side), to_eye = -kRough * dot(fine.xyz, slow.eye_side);
  float facing = slow.turn.x + to_eye;
  vec3 c = slow.body * (1.0 + kStained * fine.a + slow.turn.z * to_key);
#ifdef OOZES
  // Blood oozes out of a cut, here a little further than there, and runs out softly; a closed cut stays visible.
  float reached = lip + 1.1 * gyroid(place_mirror.xyz * 61.0).w;
  c *= mix(vec3(1.0), vec3(0.72, 0.20, 0.18), 0.8 * blood * smoothstep(0.36, 0.84, reached));
  c *= mix(vec3(1.0), lip_tint, 0.9 * smoothstep(0.62, 0.92, lip));
#endif
  // The mirrored way turns by twice as much; the film is half as rough as the tissue below.
  float mirrored_key = slow.mirror.x + 1.1 * (to_eye * slow.turn.y + slow.turn.x * to_key);
  float mirrored_rim = slow.mirror.y + 1.1 * to_eye * slow.mirror.z;
  c += fresnel(facing) * (kFilm * slow.film + slow.turn.w * (key_in_room(mirrored_key) + rim_in_room(mirrored_rim)));
#ifdef GLASSY
  float edge = 1.0 - clamp(abs(facing), 0.0, 1.0), cover = mix(0.4, 0.9, edge * edge);
  colour = vec4(cover * to_srgb(c + 0.3 * edge * edge * edge * edge), cover);
#else
  colour = vec4(to_srgb(c), 1.0);
#endif
}
)";

// Counts how often a ray leaves an organ beyond the plane of a cutaway more than it enters it.
const char* const kCountFragment = R"(
in vec3 p;
uniform vec3 cutaway_point, cutaway_normal;
void main() {
  if (dot(p - cutaway_point, cutaway_normal) > 0.0) discard;
}
)";

const char* const kCountVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
out vec3 p;
void main() { p = position; gl_Position = clip_from_world * vec4(position, 1.0); }
)";

const char* const kToolVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float part;
uniform mat4 clip_from_world, world_from_tool;
out vec3 p, n;
out float piece;
void main() {
  vec4 w = world_from_tool * vec4(position, 1.0);
  p = w.xyz; n = mat3(world_from_tool) * normal; piece = part;
  gl_Position = clip_from_world * w;
}
)";

const char* const kToolFragment = R"(
in vec3 p, n;
in float piece;
uniform float ghost;  // 0: a tool; 1: another session's, which is shown through
out vec4 colour;
void main() {
  vec3 v = normalize(eye - p);
  vec3 m = normalize(n);
  if (dot(m, v) < 0.0) m = -m;
  vec3 mirrored = room(reflect(-v, m));
  vec3 c;
  if (piece < 0.5)
    c = vec3(0.62, 0.65, 0.69) * (0.30 * diffuse_light(m, vec3(0.0), 1.0) + 0.85 * mirrored);
  else if (piece > 1.5) {
    float lit = clamp(3.0 - piece, 0.0, 1.0);  // of the picture's colour, which is the root of the light
    c = lit * lit * vec3(0.09, 0.20, 0.22) * diffuse_light(m, vec3(0.0), 1.0);
  }
  else
    c = vec3(0.055, 0.075, 0.10) * diffuse_light(m, vec3(0.0), 1.0) + 1.3 * fresnel(dot(m, v)) * mirrored;
  // Blue, whatever it is made of; denser at its outline.
  float edge = 1.0 - abs(dot(m, v)), cover = 1.0 - ghost * (0.72 - 0.4 * edge * edge);
  c = mix(c, vec3(0.06, 0.30, 0.80) * (0.6 + 0.6 * dot(c, vec3(0.33))), ghost);
  colour = vec4(cover * to_srgb(c), cover);
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
  if (miss > ball.w) discard;
  vec3 p = eye + (along - sqrt(max(ball.w * ball.w - miss * miss, 0.0))) * d;
  vec3 m = (p - ball.xyz) / ball.w;
  float shade = tool_shade(p, m) * ground_shade(p, m);
  vec3 c = paint * diffuse_light(m, vec3(0.1), shade) + fresnel(dot(m, -d)) * room(reflect(d, m)) * 0.8;
  vec4 clip = clip_from_world * vec4(p, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  colour = vec4(to_srgb(c), 1.0);
}
)";

// A rod between two spheres is a ribbon that faces the eye, shaded as a cylinder.
const char* const kRodVertex = R"(
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in float radius;
layout(location = 3) in vec3 tint;
uniform mat4 clip_from_world;
uniform vec3 eye;
out vec3 p, across, towards;
out float place;
flat out vec3 paint;
void main() {
  vec3 end = (gl_VertexID >> 1) == 0 ? from : to;
  towards = normalize(eye - end);
  across = cross(to - from, towards);
  across = across / max(length(across), 1e-9);
  towards = normalize(cross(across, to - from));
  place = float(gl_VertexID & 1) * 2.0 - 1.0;
  p = end + place * radius * across;
  paint = tint;
  gl_Position = clip_from_world * vec4(p, 1.0);
}
)";

const char* const kRodFragment = R"(
in vec3 p, across, towards;
in float place;
flat in vec3 paint;
out vec4 colour;
void main() {
  vec3 m = normalize(place * across + sqrt(max(1.0 - place * place, 0.0)) * towards);
  vec3 c = paint * diffuse_light(m, vec3(0.2), ground_shade(p, m));
  colour = vec4(to_srgb(c), 1.0);
}
)";

std::string join(std::initializer_list<const char*> parts) {
  std::string source = kVersion;
  for (const char* part : parts) source += part;
  return source;
}

}  // namespace

ShaderSource organ_shader(OrganPass pass, bool has_cutaway) {
  const char* const side = pass == OrganPass::inside     ? "#define INSIDE\n"
                           : pass == OrganPass::near_cut ? "#define OOZES\n"
                           : pass == OrganPass::glassy   ? "#define OOZES\n#define GLASSY\n"
                                                         : "";
  const char* const cutaway = has_cutaway ? "#define CUTAWAY\n" : "";
  return {join({side, cutaway, "#define CARRIED out\n", kLight, kShade, kSmooth, kBend, kCarried, kOrganVertex}),
          join({side, cutaway, "#define CARRIED in\n", kLight, kShade, kSmooth, kBend, kRelief, kTissue, kCarried,
                kOrganFragment})};
}
ShaderSource count_shader() { return {join({kCountVertex}), join({kCountFragment})}; }
ShaderSource tool_shader() { return {join({kToolVertex}), join({kLight, kToolFragment})}; }
ShaderSource sphere_shader() { return {join({kSphereVertex}), join({kLight, kShade, kSphereFragment})}; }
ShaderSource rod_shader() { return {join({kRodVertex}), join({kLight, kShade, kRodFragment})}; }

}  // namespace ctpm::render

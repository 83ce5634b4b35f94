#include "scenes/places.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scenes/json_text.h"

namespace ctpm::scenes {
namespace {

constexpr const char* kForms =
    "places are written like \"top of liver\", \"bottom of liver\", \"centre of liver\", \"surface of liver at 20 "
    "-30\" or "
    "the name of a probe, with \" + 0 0 5\" or \" out 5\" behind it, in mm; directions like \"into top of liver\" or "
    "\"out of surface of liver at 20 -30\"";

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// `count` numbers separated by spaces [mm as m]; none if the text is anything else.
std::optional<std::vector<double>> lengths_of(std::string_view text, std::size_t count) {
  std::vector<double> lengths;
  while (!text.empty()) {
    if (take_prefix(text, " ")) continue;
    const std::size_t end = std::min(text.find(' '), text.size());
    double value = 0;
    const auto [next, trouble] = std::from_chars(text.data(), text.data() + end, value);
    if (trouble != std::errc() || next != text.data() + end || !(std::abs(value) <= 1e5)) return std::nullopt;
    lengths.push_back(decimal_to_double(text.substr(0, end), -3));
    text.remove_prefix(end);
  }
  return lengths.size() == count ? std::optional(lengths) : std::nullopt;
}

/// Cuts " WORD numbers" off the end of a text and returns the numbers.
std::optional<std::vector<double>> take_behind(std::string_view& text, std::string_view word, std::size_t count) {
  const auto at = text.rfind(word);
  if (at == std::string_view::npos) return std::nullopt;
  auto lengths = lengths_of(text.substr(at + word.size()), count);
  if (lengths) text = text.substr(0, at);
  return lengths;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::optional<Vec3> surface_above(const Surface& surface, Vec3 point, Vec3 up) {
  std::optional<double> highest;
  for (const auto& t : surface.triangle) {
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    const Vec3 normal = cross(b - a, c - a);
    const double facing = dot(normal, up);
    if (facing <= 0) continue;
    const double height = dot(normal, a - point) / facing;
    const Vec3 hit = point + height * up;
    const bool is_inside = dot(cross(b - a, hit - a), normal) >= 0 && dot(cross(c - b, hit - b), normal) >= 0 &&
                           dot(cross(a - c, hit - c), normal) >= 0;
    if (is_inside && (!highest || height > *highest)) highest = height;
  }
  if (!highest) return std::nullopt;
  return point + *highest * up;
}

Result<PlacePhrase> parse_place(std::string_view text, bool is_direction) {
  PlacePhrase phrase;
  phrase.is_direction = is_direction;
  const Error error{"", "got the text " + in_quotes(text.substr(0, 80)) + ", which is no place", kForms};
  if (is_direction) {
    const bool is_in = take_prefix(text, "into ");
    if (!is_in && !take_prefix(text, "out of "))
      return Error{"", error.message.substr(0, error.message.size() - 5) + "direction", kForms};
    phrase.sign = is_in ? -1 : 1;
  }
  if (const auto shift = take_behind(text, " + ", 3)) phrase.shift = {(*shift)[0], (*shift)[1], (*shift)[2]};
  if (const auto out = take_behind(text, " out ", 1)) phrase.out = out->front();
  using Kind = PlacePhrase::Kind;
  if (take_prefix(text, "top of "))
    phrase.kind = Kind::top;
  else if (take_prefix(text, "bottom of "))
    phrase.kind = Kind::bottom;
  else if (take_prefix(text, "centre of "))
    phrase.kind = Kind::centre;
  else if (take_prefix(text, "surface of ")) {
    phrase.kind = Kind::surface;
    const auto line = take_behind(text, " at ", 2);
    if (!line) return error;
    phrase.x = (*line)[0], phrase.y = (*line)[1];
  }
  phrase.name = std::string(text);
  if (phrase.name.empty()) return error;
  return phrase;
}

PlaceFinder::PlaceFinder(std::vector<Organ> organs, Vec3 gravity)
    : organs_(std::move(organs)), up_(norm(gravity) > 0 ? -1.0 * gravity / norm(gravity) : Vec3{0, 0, 1}) {}

/// Mean of the normals within a twentieth of the size of the organ whose surface is nearest, each by its area.
Vec3 PlaceFinder::normal_at(Vec3 point) const {
  const Surface* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest_triangle = 0;
  const auto centre = [](const Surface& surface, std::size_t t) {
    const auto& corner = surface.triangle[t];
    return (surface.vertex[std::size_t(corner[0])] + surface.vertex[std::size_t(corner[1])] +
            surface.vertex[std::size_t(corner[2])]) /
           3.0;
  };
  const auto normal = [](const Surface& surface, std::size_t t) {
    const auto& corner = surface.triangle[t];
    const Vec3 a = surface.vertex[std::size_t(corner[0])];
    return cross(surface.vertex[std::size_t(corner[1])] - a, surface.vertex[std::size_t(corner[2])] - a);
  };
  for (const Organ& organ : organs_)
    for (std::size_t t = 0; organ.surface != nullptr && t < organ.surface->triangle.size(); ++t)
      if (const double distance = norm(centre(*organ.surface, t) - point); distance < least)
        least = distance, nearest = organ.surface, nearest_triangle = t;
  if (nearest == nullptr) return up_;
  Vec3 low = nearest->vertex.front(), high = low;
  for (const Vec3& p : nearest->vertex) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double reach = least + norm(high - low) / 20;
  const Vec3 facing = normal(*nearest, nearest_triangle);
  Vec3 sum;
  // A thin organ's other side looks the other way.
  for (std::size_t t = 0; t < nearest->triangle.size(); ++t)
    if (norm(centre(*nearest, t) - point) <= reach && dot(normal(*nearest, t), facing) > 0) sum += normal(*nearest, t);
  return norm(sum) > 0 ? sum / norm(sum) : up_;
}

Result<std::optional<Vec3>> PlaceFinder::find(const PlacePhrase& phrase) const {
  using Kind = PlacePhrase::Kind;
  Vec3 place;
  if (phrase.kind == Kind::probe) {
    const auto probe = probes_.find(phrase.name);
    if (probe == probes_.end()) {
      std::vector<std::string> known;
      for (const auto& [name, at] : probes_) known.push_back(name);
      return Error{"", "there is no place " + in_quotes(phrase.name),
                   known.empty() ? std::string(kForms) : "probes: " + list_of(known) + "; " + kForms};
    }
    if (!probe->second) return std::optional<Vec3>();
    place = *probe->second;
  } else {
    const auto organ =
        std::find_if(organs_.begin(), organs_.end(), [&](const Organ& o) { return o.name == phrase.name; });
    if (organ == organs_.end()) {
      std::vector<std::string> known;
      for (const Organ& o : organs_) known.push_back(o.name);
      return Error{"", "there is no organ " + in_quotes(phrase.name), "organs: " + list_of(known)};
    }
    if (organ->surface == nullptr) return std::optional<Vec3>();
    if (organ->surface->vertex.empty()) return Error{"", "the organ " + in_quotes(phrase.name) + " has no surface", ""};
    const std::vector<Vec3>& vertex = organ->surface->vertex;
    const auto lower = [&](Vec3 p, Vec3 q) { return dot(p, up_) < dot(q, up_); };
    if (phrase.kind == Kind::top) place = *std::max_element(vertex.begin(), vertex.end(), lower);
    if (phrase.kind == Kind::bottom) place = *std::min_element(vertex.begin(), vertex.end(), lower);
    if (phrase.kind == Kind::centre) {
      Vec3 low = vertex.front(), high = low;
      for (const Vec3& p : vertex) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
      place = 0.5 * (low + high);
    }
    if (phrase.kind == Kind::surface) {
      const std::optional<Vec3> hit = surface_above(*organ->surface, {phrase.x, phrase.y, 0}, {0, 0, 1});
      if (!hit)
        return Error{"",
                     "no part of " + in_quotes(phrase.name) + " is over " + double_to_decimal(phrase.x, -3) + " " +
                         double_to_decimal(phrase.y, -3),
                     ""};
      place = *hit;
    }
  }
  const auto to_micrometre = [](double x) { return std::round(x * 1e6) / 1e6 + 0.0; };
  const auto rounded = [&](Vec3 p) { return Vec3{to_micrometre(p.x), to_micrometre(p.y), to_micrometre(p.z)}; };
  if (phrase.is_direction) return std::optional(rounded(phrase.sign * normal_at(place)));
  if (phrase.out) place = place + *phrase.out * normal_at(place);
  return std::optional(rounded(place + phrase.shift));
}

PlaceFinder finder_of(const Model& model, const SceneSpec& scene) {
  std::vector<PlaceFinder::Organ> organs;
  for (std::size_t o = 0; o < model.organs.size(); ++o)
    organs.push_back({model.organs[o].name, o < model.surfaces.size() ? &model.surfaces[o] : nullptr});
  PlaceFinder finder(std::move(organs), model.gravity);
  for (const ProbeSpec& probe : scene.probes) finder.add_probe(probe.name, probe.at);
  return finder;
}

PlaceFinder names_in(const SceneSpec& scene) {
  std::vector<PlaceFinder::Organ> organs;
  for (const OrganSpec& organ : scene.organs) organs.push_back({organ.name, nullptr});
  PlaceFinder finder(std::move(organs), scene.gravity);
  for (const ProbeSpec& probe : scene.probes) finder.add_probe(probe.name, std::nullopt);
  return finder;
}

}  // namespace ctpm::scenes

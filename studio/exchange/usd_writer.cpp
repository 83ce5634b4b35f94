#include <algorithm>
#include <cctype>

#include "studio/exchange/writers.h"
#include "studio/output/number_text.h"

// USD's text format with the schemas UsdGeomMesh, UsdGeomSphere and UsdGeomBasisCurves.
namespace ctpm::exchange {
namespace {

std::string number(double value) { return output::short_number(value, 7); }

std::string tuple(Vec3 p) { return "(" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + ")"; }

/// A name that USD allows: letters, digits and underscores, no digit first.
std::string identifier(const std::string& name) {
  std::string text;
  for (const unsigned char c : name) text += (c < 0x80 && std::isalnum(c)) || c == '_' ? char(c) : '_';
  return text.empty() || (text[0] >= '0' && text[0] <= '9') ? "_" + text : text;
}

/// Visible from time code `from` to `to`, of `count`.
std::string visibility(std::int64_t from, std::int64_t to, std::int64_t count) {
  std::string text = "        token visibility.timeSamples = {\n";
  if (from > 0) text += "            0: \"invisible\",\n";
  text += "            " + std::to_string(from) + ": \"inherited\",\n";
  if (to + 1 < count) text += "            " + std::to_string(to + 1) + ": \"invisible\",\n";
  return text + "        }\n";
}

}  // namespace

void UsdWriter::add(const Moment& moment) {
  const std::int64_t now = moments_++;
  inputs_.push_back(moment.state.last_inputs);
  current_.resize(moment.organs.size());
  for (std::size_t o = 0; o < moment.organs.size(); ++o) {
    const OrganShape& shape = moment.organs[o];
    if (now == 0 || pieces_[current_[o]].revision != shape.revision) {
      current_[o] = pieces_.size();
      Piece& piece = pieces_.emplace_back();
      piece.organ = shape.name;
      // Two organs may have names that become one.
      piece.name = identifier(shape.name) + "_" + std::to_string(o) + "_" + std::to_string(now);
      piece.colour = shape.colour, piece.revision = shape.revision, piece.from = now;
      piece.triangle = shape.triangle;
      piece.least = piece.most = shape.vertex.front();
    }
    Piece& piece = pieces_[current_[o]];
    piece.to = now;
    std::string& points = piece.points.emplace_back();
    for (const Vec3& p : shape.vertex) {
      points += (points.empty() ? "" : ", ") + tuple(p);
      piece.least = {std::min(piece.least.x, p.x), std::min(piece.least.y, p.y), std::min(piece.least.z, p.z)};
      piece.most = {std::max(piece.most.x, p.x), std::max(piece.most.y, p.y), std::max(piece.most.z, p.z)};
    }
  }
}

std::string UsdWriter::text() const {
  const std::string rate = number(per_second_);
  std::string text =
      "#usda 1.0\n(\n    defaultPrim = \"Session\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n    startTimeCode = 0\n"
      "    endTimeCode = " +
      std::to_string(moments_ - 1) + "\n    timeCodesPerSecond = " + rate + "\n    framesPerSecond = " + rate +
      "\n)\n\ndef Xform \"Session\"\n{\n";
  for (const Piece& piece : pieces_) {
    text += "    def Mesh \"" + piece.name + "\"\n    {\n        int[] faceVertexCounts = [";
    for (std::size_t t = 0; t < piece.triangle.size(); ++t) text += t == 0 ? "3" : ", 3";
    text += "]\n        int[] faceVertexIndices = [";
    for (std::size_t t = 0; t < piece.triangle.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) text += (t + c == 0 ? "" : ", ") + std::to_string(piece.triangle[t][c]);
    text += "]\n        float3[] extent = [" + tuple(piece.least) + ", " + tuple(piece.most) +
            "]\n        color3f[] primvars:displayColor = [" +
            tuple({piece.colour[0], piece.colour[1], piece.colour[2]}) +
            "]\n        uniform token subdivisionScheme = \"none\"\n        point3f[] points.timeSamples = {\n";
    for (std::size_t n = 0; n < piece.points.size(); ++n)
      text += "            " + std::to_string(piece.from + std::int64_t(n)) + ": [" + piece.points[n] + "],\n";
    text += "        }\n" + visibility(piece.from, piece.to, moments_) + "    }\n";
  }
  for (std::size_t tool = 0; tool < model_.tools.size(); ++tool) {
    const Tool& own = model_.tools[tool];
    std::string moved, turned, seen;
    bool was_held = false, is_used = false;
    for (std::size_t n = 0; n < inputs_.size(); ++n) {
      const Hand& hand = inputs_[n].hand(inputs_[n].second.tool == std::int32_t(tool) ? 1 : 0);
      const bool is_held = hand.tool == std::int32_t(tool);
      const std::string code = "            " + std::to_string(n) + ": ";
      if (n == 0 || is_held != was_held) seen += code + (is_held ? "\"inherited\",\n" : "\"invisible\",\n");
      was_held = is_held, is_used = is_used || is_held;
      if (!is_held) continue;
      const Quat q = hand.world_from_tool;
      moved += code + tuple(hand.position) + ",\n";
      turned += code + "(" + number(q.w) + ", " + number(q.x) + ", " + number(q.y) + ", " + number(q.z) + "),\n";
    }
    if (!is_used) continue;
    text += "    def Xform \"" + identifier(own.name) + "_tool\"\n    {\n        token visibility.timeSamples = {\n" +
            seen + "        }\n        double3 xformOp:translate.timeSamples = {\n" + moved +
            "        }\n        quatf xformOp:orient.timeSamples = {\n" + turned +
            "        }\n        uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n";
    if (own.blade_length > 0)
      text +=
          "        def BasisCurves \"edge\"\n        {\n            uniform token type = \"linear\"\n"
          "            int[] curveVertexCounts = [2]\n            point3f[] points = [(0, 0, 0), (0, 0, " +
          number(own.blade_length) + ")]\n            float[] widths = [0.001, 0.001]\n        }\n";
    else
      text += "        def Sphere \"tip\"\n        {\n            double radius = " +
              number(own.radius > 0 ? own.radius : 0.002) + "\n        }\n";
    text += "    }\n";
  }
  return text + "}\n";
}

}  // namespace ctpm::exchange

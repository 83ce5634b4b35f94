#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "importers/mesh.h"

namespace ctpm::importers {
namespace {

/// Calls `take(text)` with one piece of the text after the other, each of about a megabyte.
template <class Take>
void write_pieces(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, const Take& take) {
  constexpr std::size_t kPiece = 1 << 20;
  std::string piece = "# unit: mm\n";
  std::array<char, 400> number;  // room for every double without exponent
  // Avoid "-0.000000": the sign of a rounded zero carries no information.
  const auto mm = [](double metres) {
    const double value = 1000 * metres;
    return value > -0.5e-6 && value < 0 ? 0.0 : value;
  };
  const auto add = [&](auto... value) {
    const auto end = std::to_chars(number.data(), number.data() + number.size(), value...).ptr;
    piece += ' ';
    piece.append(number.data(), end);
  };
  const auto end_line = [&] {
    piece += '\n';
    if (piece.size() > kPiece) take(piece), piece.clear();
  };
  for (const Vec3& p : vertex) {
    piece += 'v';
    for (const double metres : {p.x, p.y, p.z}) add(mm(metres), std::chars_format::fixed, 6);
    end_line();
  }
  for (const Triangle& t : triangle) {
    piece += 'f';
    for (const std::int32_t v : t) add(v + 1);
    end_line();
  }
  take(piece);
}

}  // namespace

std::string to_obj(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  std::string text;
  write_pieces(vertex, triangle, [&](const std::string& piece) { text += piece; });
  return text;
}

Result<Done> write_obj(const std::string& path, const std::vector<Vec3>& vertex,
                       const std::vector<Triangle>& triangle) {
  const std::string temporary = path + ".part";
  const auto failed = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return Error{path, "cannot be written: " + why, "check that the folder exists and may be written to"};
  };
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    if (!file) return failed(std::strerror(errno));
    write_pieces(vertex, triangle,
                 [&](const std::string& piece) { file.write(piece.data(), std::streamsize(piece.size())); });
    file.close();
    if (!file) return failed("the disk may be full");
  }
  std::error_code trouble;
  std::filesystem::rename(temporary, path, trouble);
  if (trouble) return failed(trouble.message());
  return Done{};
}

}  // namespace ctpm::importers

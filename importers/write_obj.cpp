#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "importers/mesh.h"

namespace ctpm::importers {

std::string to_obj(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  std::string text = "# unit: mm\n";
  char line[128];
  // Avoid "-0.000000": the sign of a rounded zero carries no information.
  const auto mm = [](double metres) {
    const double value = 1000 * metres;
    return value > -0.5e-6 && value < 0 ? 0.0 : value;
  };
  for (const Vec3& p : vertex) {
    std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", mm(p.x), mm(p.y), mm(p.z));
    text += line;
  }
  for (const Triangle& t : triangle) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
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
    const std::string text = to_obj(vertex, triangle);
    file.write(text.data(), std::streamsize(text.size()));
    file.close();
    if (!file) return failed("the disk may be full");
  }
  std::error_code trouble;
  std::filesystem::rename(temporary, path, trouble);
  if (trouble) return failed(trouble.message());
  return Done{};
}

}  // namespace ctpm::importers

// Proves the folder rules of the project from its own #include lines: studio -> {recordings, scenes,
// importers} -> core, siblings never include each other, and a package's headers are seen by its owner alone,
// also through other headers.
//   layering SOURCE_DIR       prints one line `file:line: error: ...` per broken rule; exit code 1 if there
//   is any

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  int line;
  std::string path;
};

const std::map<std::string, std::set<std::string>> kMayInclude{
    {"core", {"core"}},
    {"importers", {"importers", "core"}},
    {"scenes", {"scenes", "core"}},
    {"recordings", {"recordings", "core"}},
    {"studio", {"studio", "recordings", "scenes", "importers", "core"}},
};

struct Package {
  std::string_view prefix, owner;
};
constexpr std::array<Package, 13> kPackages{{{"Eigen/", "core"},
                                             {"assimp/", "importers"},
                                             {"CGAL/", "importers"},
                                             {"boost/", "importers"},
                                             {"nlohmann/", "scenes"},
                                             {"sqlite3", "recordings"},
                                             {"zstd", "recordings"},
                                             {"xxhash", "recordings"},
                                             {"CLI/", "studio"},
                                             {"GL/", "studio"},
                                             {"opencv2/", "studio"},
                                             {"openigtlink/", "studio"},
                                             {"gtest/", "tests"}}};

std::string folder_of(const std::string& path) { return path.substr(0, path.find('/')); }

std::vector<Include> read_includes(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  std::ifstream in(file);
  std::string text;
  for (int line = 1; std::getline(in, text); ++line)
    if (std::smatch match; std::regex_search(text, match, pattern)) includes.push_back({line, match[1]});
  return includes;
}

class Sources {
 public:
  explicit Sources(const fs::path& root) {
    for (const auto& [folder, allowed] : kMayInclude)
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
        if (const fs::path ending = entry.path().extension();
            ending == ".h" || ending == ".cpp" || ending == ".inl")
          files_[fs::relative(entry.path(), root).generic_string()] = read_includes(entry.path());
  }

  std::size_t size() const { return files_.size(); }

  int count_broken_rules() const {
    int broken = 0;
    for (const auto& [file, includes] : files_)
      for (const Include& include : includes) {
        broken += check_direction(file, include);
        std::set<std::string> seen;
        broken += check_packages(file, include, include.path, seen);
      }
    return broken;
  }

 private:
  static int report(const std::string& file, const Include& include, const std::string& why) {
    std::printf("%s:%d: error: includes %s: %s\n", file.c_str(), include.line, include.path.c_str(),
                why.c_str());
    return 1;
  }

  int check_direction(const std::string& file, const Include& include) const {
    const std::string from = folder_of(file), to = folder_of(include.path);
    if (to != "tests" && !kMayInclude.contains(to)) return 0;
    if (kMayInclude.at(from).contains(to)) return 0;
    return report(file, include, from + " may not know " + to);
  }

  /// Follows `path` through the project's headers and reports packages that `file`'s folder does not own.
  int check_packages(const std::string& file, const Include& include, const std::string& path,
                     std::set<std::string>& seen) const {
    if (!seen.insert(path).second) return 0;
    for (const Package& package : kPackages)
      if (path.starts_with(package.prefix) && folder_of(file) != package.owner)
        return report(file, include,
                      "brings in " + path + ", which only " + std::string(package.owner) + " may include");
    const auto it = files_.find(path);
    if (it == files_.end()) return 0;
    int broken = 0;
    for (const Include& next : it->second) broken += check_packages(file, include, next.path, seen);
    return broken;
  }

  std::map<std::string, std::vector<Include>> files_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: layering SOURCE_DIR\n"), 2;
  const Sources sources(argv[1]);
  if (sources.size() < 5) return std::fprintf(stderr, "%s: error: no sources found there\n", argv[1]), 2;
  const int broken = sources.count_broken_rules();
  std::printf("%zu files, %d broken rules\n", sources.size(), broken);
  return broken == 0 ? 0 : 1;
}

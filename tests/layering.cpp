// Proves the folder rules of the project from its own #include lines: studio -> {recordings, scenes,
// importers} -> core, siblings never include each other, and a package's headers are seen by its owner alone,
// also through other headers. And that no two types of the program have the same name: the linker would take either
// one's constructors for both.
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
        if (const fs::path ending = entry.path().extension(); ending == ".h" || ending == ".cpp" || ending == ".inl") {
          const std::string file = fs::relative(entry.path(), root).generic_string();
          files_[file] = read_includes(entry.path());
          // A program of its own.
          if (!file.starts_with("importers/make_organs/")) add_types(entry.path(), file);
        }
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
    for (const auto& [name, places] : types_)
      if (places.size() > 1) {
        for (const auto& [file, line] : places)
          std::printf("%s:%d: error: %s is defined in %zu files\n", file.c_str(), line, name.c_str(), places.size());
        ++broken;
      }
    return broken;
  }

 private:
  /// Types that are defined at the beginning of a line, outside of unnamed namespaces.
  void add_types(const fs::path& path, const std::string& file) {
    static const std::regex space(R"(^(?:inline )?namespace ([\w:]*) ?\{)"),
        type(R"(^(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: :[^:].*)?\s*\{)");
    std::ifstream in(path);
    std::string text;
    std::vector<std::string> spaces;
    for (int line = 1; std::getline(in, text); ++line) {
      std::smatch match;
      if (std::regex_search(text, match, space)) {
        spaces.push_back(match[1]);
      } else if (text.starts_with("}  // namespace")) {
        if (!spaces.empty()) spaces.pop_back();
      } else if (std::regex_search(text, match, type)) {
        if (std::find(spaces.begin(), spaces.end(), "") != spaces.end()) continue;
        std::string name;
        for (const std::string& part : spaces) name += part + "::";
        types_[name + match[1].str()].emplace(file, line);
      }
    }
  }

  static int report(const std::string& file, const Include& include, const std::string& why) {
    std::printf("%s:%d: error: includes %s: %s\n", file.c_str(), include.line, include.path.c_str(), why.c_str());
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
  std::map<std::string, std::map<std::string, int>>
      types_;  ///< file and line of each definition, by the type's full name
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

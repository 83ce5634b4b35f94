// Proves the rules of the rooms from the sources themselves; rooms.h declares them.
//   - Every source file lies in a room, and a room includes only rooms that are declared before it.
//   - Only the owner of a package sees its headers, also through other headers.
//   - No two types of the program have the same name: the linker would take either one's constructors for both.
//   - Only commands print, and only commands know the names of flags.
//   - No source file has more than kMostLines lines.
//   - Every file declares its room's namespace (kNamespacesAreRooms, or --namespaces).
//
//   layering [--namespaces] SOURCE_DIR    prints one line `file:line: error: ...` per broken rule; exit code 1 if there
//   is any

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/layering/rooms.h"

namespace layering {
namespace {

namespace fs = std::filesystem;

struct Include {
  int line;
  std::string path;
};

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string join(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& word : list) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The room of a file; nullptr if it lies in none.
const Room* room_of(const std::string& file) {
  for (const Room& room : kRooms)
    if (file == room.path || file.starts_with(room.path + "/")) return &room;
  return nullptr;
}

/// A program of its own, which may print and has its own types.
bool is_tool(const std::string& file) { return file.starts_with("importers/make_organs/"); }

bool is_source(const fs::path& path) {
  const fs::path ending = path.extension();
  return ending == ".h" || ending == ".cpp" || ending == ".inl";
}

class Sources {
 public:
  Sources(const fs::path& root, bool check_namespaces) : check_namespaces_(check_namespaces) {
    for (const char* folder : {"core", "importers", "scenes", "recordings", "studio"}) read_folder(root, folder);
    // Tests have no rooms; only their length counts.
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "tests"))
      if (is_source(entry.path())) check_length(fs::relative(entry.path(), root).generic_string(), read(entry.path()));
  }

  std::size_t size() const { return files_.size(); }

  int count_broken_rules() {
    check_order();
    for (const auto& [file, includes] : files_)
      for (const Include& include : includes) {
        check_direction(file, include);
        std::set<std::string> seen;
        check_packages(file, include, include.path, seen);
      }
    for (const auto& [name, places] : types_)
      if (places.size() > 1)
        for (const auto& [file, line] : places)
          report(file, line, name + " is defined in " + std::to_string(places.size()) + " files");
    return broken_;
  }

 private:
  void report(const std::string& file, int line, const std::string& what) {
    std::printf("%s:%d: error: %s\n", file.c_str(), line, what.c_str());
    ++broken_;
  }

  static std::vector<std::string> read(const fs::path& path) {
    std::vector<std::string> lines;
    std::ifstream in(path);
    for (std::string text; std::getline(in, text);) lines.push_back(text);
    return lines;
  }

  void read_folder(const fs::path& root, const char* folder) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!is_source(entry.path())) continue;
      const std::string file = fs::relative(entry.path(), root).generic_string();
      const std::vector<std::string> lines = read(entry.path());
      add_includes(file, lines);
      check_length(file, lines);
      const Room* room = room_of(file);
      if (!room) {
        report(file, 1, "lies in no room: move it into a folder that tests/layering/rooms.h declares");
        continue;
      }
      if (is_tool(file)) continue;
      add_types(file, lines);
      if (check_namespaces_) check_namespace(file, *room, lines);
      if (room->path != "studio/commands" && room->path != "studio/main.cpp") check_words(file, lines);
    }
  }

  void add_includes(const std::string& file, const std::vector<std::string>& lines) {
    static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<Include>& includes = files_[file];
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (std::smatch match; std::regex_search(lines[i], match, pattern)) includes.push_back({int(i) + 1, match[1]});
  }

  /// Types that are defined at the beginning of a line, outside of unnamed namespaces.
  void add_types(const std::string& file, const std::vector<std::string>& lines) {
    static const std::regex space(R"(^(?:inline )?namespace ([\w:]*) ?\{)"),
        type(R"(^(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: :[^:].*)?\s*\{)");
    std::vector<std::string> spaces;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (std::regex_search(lines[i], match, space)) {
        spaces.push_back(match[1]);
      } else if (lines[i].starts_with("}  // namespace")) {
        if (!spaces.empty()) spaces.pop_back();
      } else if (std::regex_search(lines[i], match, type)) {
        if (has(spaces, "")) continue;
        std::string name;
        for (const std::string& part : spaces) name += part + "::";
        types_[name + match[1].str()].emplace(file, int(i) + 1);
      }
    }
  }

  void check_length(const std::string& file, const std::vector<std::string>& lines) {
    if (lines.size() > std::size_t(kMostLines))
      report(file, kMostLines + 1,
             "has " + std::to_string(lines.size()) + " lines, at most " + std::to_string(kMostLines) +
                 " are allowed: split it by meaning");
  }

  /// The outermost namespaces of a file are its room's, or lie in it.
  void check_namespace(const std::string& file, const Room& room, const std::vector<std::string>& lines) {
    static const std::regex space(R"(^(?:inline )?namespace (\w[\w:]*) ?\{)");
    std::string open;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (!open.empty()) {
        if (lines[i] == "}  // namespace " + open) open.clear();
      } else if (std::regex_search(lines[i], match, space)) {
        const std::string name = match[1];
        if (lines[i].find('}') == std::string::npos) open = name;
        if (name != room.name_space && !name.starts_with(room.name_space + "::"))
          report(file, int(i) + 1, "declares namespace " + name + ", its room's is " + room.name_space);
      }
    }
  }

  /// Libraries return what there is to say, and name options by their fields.
  void check_words(const std::string& file, const std::vector<std::string>& lines) {
    static const std::regex print(R"((^|[^\w])(printf|puts|putchar|fputs|fprintf)\s*\(|std::(cout|cerr|clog)\b)"),
        flag(R"re("([^"]*[^"\w])?(--[a-z][a-z-]+|-o)\b[^"]*")re"), ranges(R"(\bstd::(ranges|views)::)");
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string& text = lines[i];
      // An internal error prints where it is before it aborts.
      if (file != "core/model/result.h" && std::regex_search(text, print))
        report(file, int(i) + 1, "prints, which only studio/commands may");
      if (std::regex_search(text, flag))
        report(file, int(i) + 1, "names a flag, which only studio/commands may: name the option's field");
      if (file.starts_with("core/") && std::regex_search(text, ranges))
        report(file, int(i) + 1, "uses ranges, which clang 14 cannot compile with the library of gcc 12");
    }
  }

  /// A room may include only what is declared before it: then there are no cycles.
  void check_order() {
    std::vector<std::string> declared;
    for (const Room& room : kRooms) {
      for (const std::string& other : room.before)
        if (!has(declared, other))
          report("tests/layering/rooms.h", 1,
                 room.path + " may include " + other + ", which is not declared before it");
      declared.push_back(room.path);
    }
  }

  void check_direction(const std::string& file, const Include& include) {
    const Room *from = room_of(file), *to = room_of(include.path);
    if (!from) return;
    const auto refuse = [&](const std::string& other) {
      report(file, include.line, "includes " + include.path + ": " + from->path + " may not know " + other);
    };
    if (include.path.starts_with("tests/")) return refuse("tests");
    if (to && to != from && !has(from->before, to->path)) refuse(to->path);
  }

  /// Follows `path` through the project's headers and reports packages that the room of `file` does not own.
  void check_packages(const std::string& file, const Include& include, const std::string& path,
                      std::set<std::string>& seen) {
    if (!seen.insert(path).second) return;
    const Room* room = room_of(file);
    for (const Package& package : kPackages)
      if (path.starts_with(package.prefix) && !(room && has(package.owners, room->path)))
        return report(file, include.line,
                      "includes " + include.path + ": brings in " + path + ", which only " +
                          (package.owners.empty() ? "tests" : join(package.owners)) + " may include");
    const auto it = files_.find(path);
    if (it == files_.end()) return;
    for (const Include& next : it->second) check_packages(file, include, next.path, seen);
  }

  bool check_namespaces_;
  int broken_ = 0;
  std::map<std::string, std::vector<Include>> files_;
  std::map<std::string, std::map<std::string, int>> types_;  ///< file and line of each definition, by full name
};

}  // namespace
}  // namespace layering

int main(int argc, char** argv) {
  const bool asks_for_namespaces = argc == 3 && std::string_view(argv[1]) == "--namespaces";
  if (argc != 2 && !asks_for_namespaces) return std::fprintf(stderr, "usage: layering [--namespaces] SOURCE_DIR\n"), 2;
  const char* root = argv[argc - 1];
  layering::Sources sources(root, layering::kNamespacesAreRooms || asks_for_namespaces);
  if (sources.size() < 5) return std::fprintf(stderr, "%s: error: no sources found there\n", root), 2;
  const int broken = sources.count_broken_rules();
  std::printf("%zu files, %d broken rules\n", sources.size(), broken);
  return broken == 0 ? 0 : 1;
}

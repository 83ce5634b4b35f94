#include "studio/output/files.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "studio/output/option_name.h"

namespace ctpm::output {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Between a file's name and the process that writes it.
constexpr std::string_view kPart = ".part-";

/// Removes unfinished files of `path` whose process is gone.
void remove_left_behind(const std::string& path) {
  const std::string prefix = fs::path(path).filename().string().append(kPart);
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(path), failure)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    pid_t process = 0;
    const char* const end = name.data() + name.size();
    const auto [last, problem] = std::from_chars(name.data() + prefix.size(), end, process);
    if (problem == std::errc() && last == end && process > 0 && kill(process, 0) != 0 && errno == ESRCH)
      fs::remove(entry.path(), failure);
  }
}

}  // namespace

Result<Done> check_readable(const std::string& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::not_found) return Error{path, "does not exist", ""};
  if (status.type() == fs::file_type::directory) return Error{path, "is a folder, not a file", ""};
  if (!failure && access(path.c_str(), R_OK) != 0) failure = std::error_code(errno, std::generic_category());
  if (failure) return Error{path, "cannot be read: " + failure.message(), ""};
  return Done{};
}

Result<std::string> read_text_file(const std::string& path) {
  if (const Result<Done> readable = check_readable(path); !readable) return readable.errors();
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.good() && !in.eof()) return Error{path, std::string("cannot be read: ") + std::strerror(errno), ""};
  return text.str();
}

Result<Done> check_writable(const std::string& path) {
  std::error_code ignored;
  const std::string folder = folder_of(path);
  if (!fs::is_directory(folder, ignored))
    return Error{path, "the folder " + folder + " does not exist", "create it first"};
  if (fs::is_directory(path, ignored)) return Error{path, "is a folder, not a file", ""};
  if (access(folder.c_str(), W_OK) != 0) return Error{path, "the folder " + folder + " cannot be written", ""};
  return Done{};
}

Result<Done> check_new(const std::string& path, bool overwrite) {
  if (Result<Done> writable = check_writable(path); !writable) return writable;
  std::error_code ignored;
  if (!overwrite && fs::exists(fs::symlink_status(path, ignored)))
    return Error{path, "exists already", option_name("overwrite") + " replaces it"};
  return Done{};
}

Result<Done> write_text_file(const std::string& path, const std::string& text) {
  if (Result<Done> writable = check_writable(path); !writable) return writable;
  remove_left_behind(path);
  const std::string temporary = std::string(path).append(kPart) + std::to_string(getpid());
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code failure;
  if (out.good()) fs::rename(temporary, path, failure);
  if (out.good() && !failure) return Done{};
  const std::string why = failure ? failure.message() : std::strerror(errno);
  fs::remove(temporary, failure);
  return Error{path, "cannot be written: " + why, ""};
}

}  // namespace ctpm::output

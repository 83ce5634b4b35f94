#include "studio/output/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace ctpm::output {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

Result<std::string> read_text_file(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return Error{path, "does not exist", ""};
  if (fs::is_directory(path, ignored)) return Error{path, "is a folder, not a file", ""};
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

Result<Done> write_text_file(const std::string& path, const std::string& text) {
  if (Result<Done> writable = check_writable(path); !writable) return writable;
  const std::string temporary = path + ".part-" + std::to_string(getpid());
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

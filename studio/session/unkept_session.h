#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ctpm::session {

/// A place for a session that nobody keeps: it goes with the object.
class UnkeptSession {
 public:
  UnkeptSession() {
    std::string name = (std::filesystem::temp_directory_path() / "ctpm-try-XXXXXX").string();
    if (mkdtemp(name.data())) folder_ = name;
  }
  ~UnkeptSession() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  UnkeptSession(const UnkeptSession&) = delete;
  UnkeptSession& operator=(const UnkeptSession&) = delete;
  std::string file() const { return (folder_ / "try.ctpm").string(); }

 private:
  std::filesystem::path folder_;
};

}  // namespace ctpm::session

#include "studio/server/upload_list.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <vector>

#include "studio/output/files.h"
#include "studio/server/access.h"
#include "studio/server/naming_files.h"

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

constexpr const char* kBegin = ".ctpm-uploads-";

struct ListedUpload {
  std::string path;   ///< from the folder
  std::string stamp;  ///< empty: it grew still
};

std::string text_of(const KnownFiles::Stamp& stamp) {
  return std::to_string(stamp.bytes) + " " + std::to_string(stamp.modified.time_since_epoch().count());
}

/// Each field ends in a zero byte, which no name holds. A line that a killed run did not finish is left out.
std::vector<ListedUpload> read_list(const std::string& text) {
  std::vector<std::string> fields;
  std::istringstream in(text.substr(0, text.rfind('\0') + 1));
  for (std::string field; std::getline(in, field, '\0');) fields.push_back(field);
  std::vector<ListedUpload> uploads;
  for (std::size_t i = 0; i + 1 < fields.size(); i += 2) uploads.push_back({fields[i], fields[i + 1]});
  return uploads;
}

/// Whether a file is what a list names as it was left. A list from a stranger may name any file without a stamp; only
/// what is no whole file is taken for one that grew still.
bool is_as_left(const std::string& file, const std::string& stamp) {
  if (stamp.empty()) return fs::path(file).filename().string().find(kPart) != std::string::npos;
  const std::optional<KnownFiles::Stamp> now = KnownFiles::stamp_of(file);
  return now && stamp == text_of(*now);
}

/// Removes what a list names. False: which files name others is not known, so that all stays.
bool remove_listed(const Folder& folder, const std::string& list) {
  const Result<std::string> text = output::read_text_file(list);
  const Result<std::vector<NamingFile>> all = naming_files(folder);
  if (!text || !all) return false;
  for (const ListedUpload& upload : read_list(*text)) {
    const Result<std::string> file = folder.find(upload.path);
    std::error_code ignored;
    if (file && is_as_left(*file, upload.stamp) && user_of_mesh(*file, *all).empty()) fs::remove(*file, ignored);
  }
  return true;
}

}  // namespace

UploadList::~UploadList() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

/// It takes its name when it is locked: another run would take one that is not for that of a killed run.
void UploadList::open() {
  const std::string name = make_token().substr(0, 8), unlocked = (folder_.root() / (".ctpm-new-" + name)).string();
  path_ = (folder_.root() / (kBegin + name)).string();
  file_ = ::open(unlocked.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_APPEND | O_CLOEXEC, 0600);
  if (file_ < 0) return;
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 && ::rename(unlocked.c_str(), path_.c_str()) == 0) return;
  ::unlink(unlocked.c_str());
  ::close(file_), file_ = -1;
}

void UploadList::add(const std::string& path, const std::optional<KnownFiles::Stamp>& stamp) {
  if (file_ < 0) open();
  if (file_ < 0) return;
  const std::string fields = folder_.relative(path) + '\0' + (stamp ? text_of(*stamp) : "") + '\0';
  [[maybe_unused]] const ssize_t written = ::write(file_, fields.data(), fields.size());
}

void UploadList::remove_left(const Folder& folder) {
  std::error_code failure;
  std::vector<std::string> lists;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.root(), failure))
    if (entry.path().filename().string().starts_with(kBegin)) lists.push_back(entry.path().string());
  for (const std::string& list : lists) {
    const int file = ::open(list.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0 && remove_listed(folder, list)) ::unlink(list.c_str());
    ::close(file);
  }
}

}  // namespace ctpm::server

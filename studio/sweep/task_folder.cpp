#include "studio/sweep/task_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "studio/output/files.h"
#include "studio/output/json_writer.h"

namespace ctpm::sweep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "ctpm-sweep-result";

/// Of a task's folder: locked while a process works there, written last.
constexpr const char* kResult = "/result.json";

std::string unfinished_folder(const std::string& sweep_folder, const std::string& id) {
  return (fs::path(sweep_folder) / "tasks" / ("." + id)).string();
}

/// Whether the open file is still the one at `path`: its folder may have been renamed in between.
bool is_still_at(int file, const std::string& path) {
  struct stat open_one {
  }, named{};
  return ::fstat(file, &open_one) == 0 && ::stat(path.c_str(), &named) == 0 && open_one.st_ino == named.st_ino &&
         open_one.st_dev == named.st_dev;
}

std::string result_json(const TaskResult& result) {
  output::JsonWriter json;
  json.begin_object().member("format", kFormat).member("version", 1);
  json.member("good", result.is_good).member("error", std::string_view(result.error));
  json.member("ticks_hash", std::string_view(result.ticks_hash)).member("processor_s", result.processor_s);
  json.key("values").begin_object();
  for (const auto& [name, value] : result.values) json.member(name, value);
  return json.end_object().end_object().text();
}

}  // namespace

const char* to_word(TaskState state) {
  static constexpr const char* words[] = {"waiting", "running", "killed", "failed", "done"};
  return words[int(state)];
}

std::string task_folder(const std::string& sweep_folder, const std::string& id) {
  return (fs::path(sweep_folder) / "tasks" / id).string();
}

bool is_finished(const std::string& sweep_folder, const std::string& id) {
  return ::access((task_folder(sweep_folder, id) + kResult).c_str(), F_OK) == 0;
}

Result<std::optional<Claim>> Claim::take(const std::string& sweep_folder, const std::string& id) {
  const std::string folder = unfinished_folder(sweep_folder, id), lock_path = folder + kResult;
  std::error_code failure;
  const bool is_new = ::mkdir(folder.c_str(), 0777) == 0;
  if (!is_new && errno != EEXIST) fs::create_directories(folder, failure);
  const int lock = failure ? -1 : ::open(lock_path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0) {
    // The one that had it may have finished in between.
    if (is_finished(sweep_folder, id)) return std::optional<Claim>();
    return Error{folder, "cannot be written: " + (failure ? failure.message() : std::strerror(errno)), ""};
  }
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0 || !is_still_at(lock, lock_path)) {
    ::close(lock);
    return std::optional<Claim>();
  }
  std::optional<Claim> claim(Claim(folder, task_folder(sweep_folder, id), lock));
  if (is_finished(sweep_folder, id)) return std::optional<Claim>();
  if (!is_new)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
      if (entry.path() != lock_path) fs::remove_all(entry.path(), failure);
  return claim;
}

Claim::Claim(Claim&& other) noexcept
    : unfinished_(std::move(other.unfinished_)),
      finished_(std::move(other.finished_)),
      lock_(std::exchange(other.lock_, -1)) {}

Claim::~Claim() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
  ::close(lock_);
}

Result<Done> Claim::finish(const TaskResult& result) {
  const std::string text = result_json(result);
  // A file that is cut to nothing is written to the disk when it is closed (ext4), which costs more than all else here.
  struct stat before {};
  const bool is_empty = ::fstat(lock_, &before) == 0 && before.st_size == 0;
  const bool is_written =
      (is_empty || ::ftruncate(lock_, 0) == 0) && ::pwrite(lock_, text.data(), text.size(), 0) == ssize_t(text.size());
  if (!is_written || ::rename(unfinished_.c_str(), finished_.c_str()) != 0)
    return Error{finished_, std::string("cannot be made: ") + std::strerror(errno), ""};
  ::close(std::exchange(lock_, -1));
  return Done{};
}

TaskReport look_at(const std::string& sweep_folder, const std::string& id) {
  TaskReport report;
  const Result<std::string> text = output::read_text_file(task_folder(sweep_folder, id) + kResult);
  if (!text) {
    const std::string lock_path = unfinished_folder(sweep_folder, id) + kResult;
    const int lock = ::open(lock_path.c_str(), O_RDWR | O_CLOEXEC);
    if (lock < 0) return report;
    report.state = ::flock(lock, LOCK_SH | LOCK_NB) == 0 ? TaskState::killed : TaskState::running;
    ::close(lock);
    return report;
  }
  // Values keep their order.
  const auto json = nlohmann::ordered_json::parse(*text, nullptr, false);
  try {
    if (json.at("format") != kFormat) throw std::invalid_argument("format");
    report.result.is_good = json.at("good"), report.result.error = json.at("error");
    report.result.ticks_hash = json.at("ticks_hash"), report.result.processor_s = json.at("processor_s");
    for (const auto& [name, value] : json.at("values").items())
      report.result.values.emplace_back(name, value.is_null() ? NAN : value.get<double>());
    report.state = report.result.is_good ? TaskState::done : TaskState::failed;
  } catch (const std::exception&) {
    report.state = TaskState::failed, report.result = {};
    report.result.error = "the result is damaged";
  }
  return report;
}

Result<Done> forget(const std::string& sweep_folder, const std::string& id) {
  const std::string folder = task_folder(sweep_folder, id);
  std::error_code failure;
  // The result first: without it nothing of the rest counts.
  fs::remove(folder + kResult, failure);
  if (!failure) fs::remove_all(folder, failure);
  if (failure) return Error{folder, "cannot be removed: " + failure.message(), ""};
  return Done{};
}

}  // namespace ctpm::sweep

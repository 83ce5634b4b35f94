#include "studio/server/kept_answers.h"

#include <algorithm>

namespace ctpm::server {

KeptAnswers::Files KeptAnswers::now(const std::vector<std::string>& paths) {
  Files files;
  for (const std::string& path : paths) files.emplace_back(path, KnownFiles::stamp_of(path));
  return files;
}

std::optional<std::string> KeptAnswers::find(const std::string& question, const Files& files) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Kept& kept) { return kept.question == question && kept.files == files; });
  if (found == kept_.end()) return std::nullopt;
  kept_.splice(kept_.begin(), kept_, found);
  return found->answer;
}

void KeptAnswers::keep(const std::string& question, const Files& files, const std::string& answer) {
  // What was written to meanwhile may not be what was read, and what has no stamp cannot be told from what it becomes.
  for (const auto& [path, stamp] : files)
    if (!stamp || KnownFiles::stamp_of(path) != stamp) return;
  const std::lock_guard lock(mutex_);
  kept_.push_front({question, files, answer});
  if (kept_.size() > kMost) kept_.pop_back();
}

}  // namespace ctpm::server

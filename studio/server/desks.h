#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "studio/server/desk.h"

namespace ctpm::server {

/// The desks of all pages that are connected. Any thread may ask.
class Desks {
 public:
  void add(const std::shared_ptr<Desk>& desk);

  /// The desk of the page of that name; null: it is gone, or has none.
  std::shared_ptr<Desk> of_page(const std::string& name);

  /// Why the file of a scene must stay where it is: a session of it runs, or another page than that of `own` shows it,
  /// or has changes of it that are not saved. Empty: nothing keeps it.
  std::string use_of(const std::string& file, const Desk* own);

 private:
  std::vector<std::shared_ptr<Desk>> open();

  std::mutex mutex_;
  std::vector<std::weak_ptr<Desk>> desks_;
};

}  // namespace ctpm::server

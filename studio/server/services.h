#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "studio/server/access.h"
#include "studio/server/desks.h"
#include "studio/server/folder.h"
#include "studio/server/kept_answers.h"
#include "studio/server/known_files.h"
#include "studio/server/limits.h"
#include "studio/server/session_scenes.h"
#include "studio/server/upload_list.h"
#include "studio/session/urgency.h"

namespace ctpm::server {

/// What all connections share. The network has one thread, which never computes; calls run in the pool.
struct Services {
  Services(Folder folder_, Access access_, const Limits& limits_)
      : folder(std::move(folder_)), access(std::move(access_)), limits(limits_) {}

  Folder folder;
  Access access;
  Limits limits;
  KnownFiles uploads, films;  ///< taken from pages; exported for them
  UploadList listed{folder};  ///< those of the uploads that go with their pages; of the network's thread
  KnownFiles verified;        ///< sessions that replayed as they were recorded
  KeptAnswers comparisons;
  SessionScenes scenes;
  Desks desks;
  std::size_t connections = 0;                           ///< open now; of the network's thread
  std::map<const void*, std::function<void()>> clients;  ///< closes each page; of the network's thread
  std::atomic<bool> ends{false};                         ///< the server is about to stop: calls must end
  session::Precedence leading{8e-3};                     ///< while a page leads a hand; of the network's thread
  bool is_led = false;                                   ///< since it was last looked at; of the network's thread
  boost::asio::io_context network{1};
  boost::asio::thread_pool pool{4};
};

/// Counts a connection while it lives.
class CountedConnection {
 public:
  explicit CountedConnection(Services& services) : services_(services) { ++services_.connections; }
  ~CountedConnection() { --services_.connections; }
  CountedConnection(const CountedConnection&) = delete;
  CountedConnection& operator=(const CountedConnection&) = delete;

 private:
  Services& services_;
};

}  // namespace ctpm::server

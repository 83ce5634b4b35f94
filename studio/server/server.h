#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "studio/server/limits.h"

namespace ctpm::server {

struct ServerOptions {
  std::string folder = ".";        ///< all files that it may read and write lie below it
  std::optional<int> port;         ///< 0: any free one; unset: kUsualPort, or any free one if that is taken
  std::string bind = "127.0.0.1";  ///< address of this machine to listen on; others than its own need `behind`
  std::string behind;              ///< https://NAME[:PORT] of a reverse proxy that ends TLS in front; empty: none
  Limits limits;
};

inline constexpr int kUsualPort = 7375;

/// Serves the studio's page to browsers on this machine, and to others through a reverse proxy that ends TLS.
class Server {
 public:
  /// Listens. Errors, all at once: the folder does not exist; `bind` is no address of this machine, or one that others
  /// reach without `behind`; `behind` is no https address; the port is in use or not allowed.
  static Result<std::unique_ptr<Server>> open(const ServerOptions& options);
  ~Server();

  /// The page's address with the token, which lets its reader do everything that the studio can.
  std::string address() const;

  /// Address and port on which it listens.
  std::string listens_on() const;

  /// Serves until `should_stop` returns true; it is asked ten times a second.
  void run(const std::function<bool()>& should_stop);

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::server

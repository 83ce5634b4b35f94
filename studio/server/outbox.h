#pragma once

#include <string>

#include "studio/server/picture.h"

namespace ctpm::server {

/// The way to one page. Any thread may use it; nothing in it waits for the network.
class Outbox {
 public:
  virtual ~Outbox() = default;

  /// Sends a text message. None is ever left out; a page that does not take them is disconnected.
  virtual void send(std::string text) = 0;

  /// As send(), for a binary message.
  virtual void send_bytes(std::string bytes) = 0;

  /// Shows a picture as soon as the page can take it. Only the newest of each stage is kept until then; the frame says
  /// how many were left out.
  virtual void show(Picture picture) = 0;
};

}  // namespace ctpm::server

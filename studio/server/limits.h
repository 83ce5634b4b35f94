#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace ctpm::server {

/// What clients may ask of the server.
struct Limits {
  std::size_t connections = 64;                        ///< at a time; further ones are closed at once
  std::size_t most_message = 1 << 20;                  ///< of a message or a call [bytes]
  std::uint64_t most_upload = std::uint64_t{1} << 30;  ///< of an uploaded file [bytes]
  std::size_t most_header = 16 << 10;                  ///< of a request [bytes]
  std::size_t most_waiting = 32u << 20;                ///< of control messages that a page does not take [bytes]
  std::size_t most_calls = 16;                         ///< of one page at a time
  std::chrono::seconds handshake{10};                  ///< for a request or a WebSocket handshake to be complete
  std::chrono::seconds upload{600};                    ///< for an upload to be complete, or a film to be taken
};

}  // namespace ctpm::server

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "core/model/result.h"

// TCP as far as a device needs it. The classes of OpenIGTLink are not used for this: they listen on every interface of
// the machine and cannot be woken.
namespace ctpm::devices {

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) close(), number_ = std::exchange(other.number_, -1);
    return *this;
  }
  ~Descriptor() { close(); }

  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  void close();

 private:
  int number_ = -1;
};

/// Listens on an interface; `port` 0: any that is free. Errors: no such address, the port is in use or not allowed.
Result<Descriptor> listen_on(const std::string& host, int port);

/// Connects within `timeout_s` [s]. Errors: no such host, nobody listens there, no answer.
Result<Descriptor> connect_to(const std::string& host, int port, double timeout_s);

/// The next waiting connection of a listening socket, ready to use; none if there is none.
Descriptor accept_from(const Descriptor& listener);

/// The port at this end.
int port_of(const Descriptor& socket);

/// Bytes read, 0 if there are none now, -1 if the connection is over. Never waits.
int receive(const Descriptor& socket, std::span<std::uint8_t> into);

/// Bytes taken, -1 if the connection is over. Never waits.
int send(const Descriptor& socket, std::span<const std::uint8_t> bytes);

}  // namespace ctpm::devices

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/model/result.h"

// TCP as far as a device needs it. OpenIGTLink's own socket classes are not used: they listen on every interface of the
// machine, and a thread that waits in them cannot be woken.
namespace ctpm::devices {

/// Owns a file descriptor and closes it.
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

/// Listens on an interface; `port` 0: any free port. Errors: no such address, the port is in use or not allowed.
Result<Descriptor> listen_on(const std::string& host, int port);

/// Connects within `timeout_s` [s]. Errors: no such host, nobody listens there, no answer.
Result<Descriptor> connect_to(const std::string& host, int port, double timeout_s);

/// The next waiting connection of a listening socket, ready to use; empty if there is none.
Descriptor accept_from(const Descriptor& listener);

/// The numeric address of the other side; empty if it is gone.
std::string peer_of(const Descriptor& socket);

/// Addresses that may connect: IPv4 or IPv6, each alone or with the length of a prefix, such as 192.168.1.0/24.
class AddressList {
 public:
  /// Errors: each entry that is no address.
  static Result<AddressList> read(const std::vector<std::string>& entries);

  bool is_empty() const { return entries_.empty(); }
  /// Whether the numeric `address` is in the list.
  bool holds(const std::string& address) const;

 private:
  struct Entry {
    std::array<std::uint8_t, 16> bytes;  ///< IPv4 as IPv6
    int prefix;                          ///< [bits]
  };
  std::vector<Entry> entries_;
};

/// The local port.
int port_of(const Descriptor& socket);

/// Returns the number of bytes read, 0 if none are there, -1 if the connection has ended. Never waits.
int receive(const Descriptor& socket, std::span<std::uint8_t> into);

/// Returns the number of bytes accepted, -1 if the connection has ended. Never waits.
int send(const Descriptor& socket, std::span<const std::uint8_t> bytes);

}  // namespace ctpm::devices

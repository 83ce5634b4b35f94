#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "studio/devices/device.h"

namespace ctpm::devices {

/// Cuts what comes over a connection into OpenIGTLink messages (protocol versions 1 to 3) and tells what they say:
/// TRANSFORM, POSITION and QTRANS as poses, from millimetres to metres; SENSOR as buttons, its n-th value above 0.5
/// meaning that button n is pressed. Other messages are skipped without being kept, so that no size that is written in
/// one takes memory.
class IgtlStream {
 public:
  using Tell = std::function<void(const DeviceReport&)>;

  /// Poses of other devices than `device_name` are skipped; empty: all are taken.
  explicit IgtlStream(std::string device_name) : device_name_(std::move(device_name)) {}

  /// Takes the next bytes, cut in any way, at the time `now` [s]. False if they cannot be OpenIGTLink; the connection
  /// is of no use then.
  bool take(std::span<const std::uint8_t> bytes, double now, const Tell& tell);

  /// Forgets a message that was begun: a new connection begins.
  void begin_again();

  static constexpr std::size_t kHeaderSize = 58;
  static constexpr std::size_t kMostBody = 4096;             ///< of a message that is read: a pose with its metadata
  static constexpr std::uint64_t kMostSkipped = 1ull << 32;  ///< beyond it nobody means it [bytes]

 private:
  enum class Kind { transform, position, sensor };

  bool begin_body();
  void end_body(double now, const Tell& tell) const;

  std::string device_name_;
  std::array<std::uint8_t, kHeaderSize> header_{};
  std::array<std::uint8_t, kMostBody> body_{};
  std::size_t header_size_ = 0, body_size_ = 0;  ///< bytes that are there
  std::uint64_t body_left_ = 0;                  ///< bytes that are to come
  bool is_kept_ = false;                         ///< the body is read, not skipped
  bool is_too_large_ = false;                    ///< a message that would be read, but is larger than any such
  Kind kind_ = Kind::transform;
};

/// A SENSOR message of three values in newton, named "Force", as it goes over the wire.
class IgtlForceMessage {
 public:
  IgtlForceMessage();
  ~IgtlForceMessage();
  IgtlForceMessage(const IgtlForceMessage&) = delete;
  IgtlForceMessage& operator=(const IgtlForceMessage&) = delete;

  /// The bytes of a message with `force` [N], stamped with the time of the system's clock; they are good until the
  /// next call.
  std::span<const std::uint8_t> pack(Vec3 force);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::devices

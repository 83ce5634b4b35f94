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

/// Parses a byte stream of OpenIGTLink messages (protocol versions 1 to 3) into reports. TRANSFORM, POSITION and QTRANS
/// become poses, converted from millimetres to metres. SENSOR becomes buttons: button n is pressed if the n-th value is
/// above 0.5. Other messages are skipped without storage, so that no announced size costs memory. After a size that
/// cannot be true, or a body that takes longer than kMostBodyTime, the next header is searched for byte by byte, so
/// that one wrong header swallows nothing of what follows.
class IgtlStream {
 public:
  using Tell = std::function<void(const DeviceReport&)>;

  /// Skips poses of devices other than `device_name`, and tells the name of the first of them; empty: takes all.
  explicit IgtlStream(std::string device_name) : device_name_(std::move(device_name)) {}

  /// Takes the next bytes, split anywhere, which arrived at `now` [s]. False if they cannot be OpenIGTLink; the
  /// connection is then useless.
  bool take(std::span<const std::uint8_t> bytes, double now, const Tell& tell);

  /// Drops an incomplete message, because a new connection begins.
  void begin_again();

  static constexpr std::size_t kHeaderSize = 58;
  static constexpr std::size_t kMostBody = 4096;  ///< largest body that is read: a pose with its metadata [bytes]
  static constexpr std::uint64_t kMostSkipped = 1ull << 32;  ///< a larger size is taken for garbage [bytes]
  static constexpr double kMostBodyTime = 0.5;               ///< from a header to the end of its body [s]

 private:
  enum class Kind { transform, position, sensor };

  bool begin_body(double now, const Tell& tell);
  bool search(std::span<const std::uint8_t>& bytes);
  bool is_sure_header() const;
  void end_body(double now, const Tell& tell) const;
  static void refuse(const char* text, double now, const Tell& tell);

  std::string device_name_;
  std::array<std::uint8_t, kHeaderSize> header_{};
  std::array<std::uint8_t, kMostBody> body_{};
  std::size_t header_size_ = 0, body_size_ = 0;  ///< bytes received
  std::uint64_t body_left_ = 0;                  ///< bytes of the body still to come
  bool searches_ = false;                        ///< for the next header
  double began_ = 0;                             ///< arrival of the present header [s]
  bool is_kept_ = false;                         ///< the body is read, not skipped
  bool is_too_large_ = false;                    ///< a message of a kind that is read, above kMostBody
  Kind kind_ = Kind::transform;
  bool told_other_name_ = false;
};

/// The bytes of a SENSOR message named "Force" with three values in newton.
class IgtlForceMessage {
 public:
  IgtlForceMessage();
  ~IgtlForceMessage();
  IgtlForceMessage(const IgtlForceMessage&) = delete;
  IgtlForceMessage& operator=(const IgtlForceMessage&) = delete;

  /// Packs `force` [N] with a time stamp of the system clock. The bytes are valid until the next call.
  std::span<const std::uint8_t> pack(Vec3 force);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::devices

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "studio/devices/device.h"
#include "studio/devices/socket.h"

namespace ctpm::devices {

struct IgtlSettings {
  bool listens = false;            ///< true: waits for a device to connect; false: connects to one
  std::string host = "127.0.0.1";  ///< name or address to connect to, or of the interface on which to listen
  int port = 0;                    ///< in [1, 65535]; 0 when listening: any free port
  AddressList allowed;             ///< that may connect; empty: all
  std::string device_name;         ///< skips poses of other names; empty: takes all
};

/// A device that speaks OpenIGTLink over TCP, read by a thread of its own. It has one connection at a time and refuses
/// a second one while the first sends poses. Others wait while it is silent; the first of them that sends a pose takes
/// its place. When the connection ends, it accepts the next one, or retries to connect five times per second.
class IgtlLink : public Device {
 public:
  /// Listens, or connects. Errors: no such host, nobody listens there, the port is in use.
  static Result<std::unique_ptr<IgtlLink>> open(const IgtlSettings& settings);

  /// Sends a last force of zero, so that none persists on the hand.
  ~IgtlLink() override;

  /// The port on which it listens, or to which it is connected.
  int port() const;

  bool next(DeviceReport& report) override;

  /// The other thread sends the force. If the device is slower than the calls, only the newest force is sent.
  void send_force(Vec3 force) override;

 private:
  struct Impl;
  explicit IgtlLink(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::devices

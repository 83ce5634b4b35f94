#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "studio/devices/device.h"

namespace ctpm::devices {

struct IgtlSettings {
  bool listens = false;            ///< waits for a device to connect; else connects to one
  std::string host = "127.0.0.1";  ///< name or address to connect to, or of the interface on which to listen
  int port = 0;                    ///< in [1, 65535]; 0 when listening: any that is free
  std::string device_name;         ///< poses of others are skipped; empty: all are taken
};

/// A device that speaks OpenIGTLink over TCP, read by a thread of its own. One connection at a time: a second one is
/// turned away. If it ends, the next one is taken, or the device is called again five times a second.
class IgtlLink : public Device {
 public:
  /// Listens, or connects. Errors: no such host, nobody listens there, the port is in use.
  static Result<std::unique_ptr<IgtlLink>> open(const IgtlSettings& settings);

  /// Sends a last force of zero, so that no hand is left with one.
  ~IgtlLink() override;

  /// On which it listens, or to which it is connected.
  int port() const;

  bool next(DeviceReport& report) override;

  /// Forces are sent by the other thread; if the device does not take them as fast, the newest one is.
  void send_force(Vec3 force) override;

 private:
  struct Impl;
  explicit IgtlLink(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::devices

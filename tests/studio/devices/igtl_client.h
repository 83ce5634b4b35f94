#pragma once

#include <openigtlink/igtlClientSocket.h>
#include <openigtlink/igtlMessageHeader.h>
#include <openigtlink/igtlPositionMessage.h>
#include <openigtlink/igtlSensorMessage.h>
#include <openigtlink/igtlTransformMessage.h>

#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::testing {

inline std::string bytes_of(igtl::MessageBase& message) {
  message.Pack();
  return {static_cast<const char*>(message.GetPackPointer()), std::size_t(message.GetPackSize())};
}

/// A TRANSFORM message as OpenIGTLink packs it; `time` [s], 0: not stamped.
inline std::string transform_bytes(Vec3 position_mm, double time = 0, const std::string& name = "Stylus") {
  igtl::TransformMessage::Pointer message = igtl::TransformMessage::New();
  message->SetDeviceName(name.c_str());
  igtl::Matrix4x4 matrix;
  igtl::IdentityMatrix(matrix);
  matrix[0][3] = float(position_mm.x), matrix[1][3] = float(position_mm.y), matrix[2][3] = float(position_mm.z);
  message->SetMatrix(matrix);
  message->SetTimeStamp(unsigned(time), unsigned(std::fmod(time, 1.0) * 4294967296.0));
  return bytes_of(*message);
}

inline std::string sensor_bytes(const std::vector<double>& values) {
  igtl::SensorMessage::Pointer message = igtl::SensorMessage::New();
  message->SetDeviceName("Buttons");
  message->SetLength(unsigned(values.size()));
  for (unsigned i = 0; i < values.size(); ++i) message->SetValue(i, values[i]);
  return bytes_of(*message);
}

/// Talks over a socket of OpenIGTLink: sends what it is given, and collects the forces that come back.
class IgtlPeer {
 public:
  explicit IgtlPeer(igtl::ClientSocket::Pointer socket) : socket_(socket), reader_([this] { read(); }) {}
  explicit IgtlPeer(int port) : IgtlPeer(connected(port)) {}
  static IgtlPeer connect(int port) { return IgtlPeer(connected(port)); }
  static igtl::ClientSocket::Pointer connected(int port) {
    igtl::ClientSocket::Pointer socket = igtl::ClientSocket::New();
    socket->ConnectToServer("127.0.0.1", port);
    return socket;
  }
  ~IgtlPeer() { hang_up(); }
  IgtlPeer(const IgtlPeer&) = delete;

  bool send(const std::string& bytes) { return socket_->Send(bytes.data(), int(bytes.size())) != 0; }

  /// Waits until the other side has closed the connection.
  void wait_for_end() {
    if (reader_.joinable()) reader_.join();
  }
  void hang_up() {
    stopping_ = true;
    wait_for_end();
    socket_->CloseSocket();
  }
  /// Forces that came [N]; after hang_up() or wait_for_end().
  const std::vector<Vec3>& forces() const { return forces_; }
  int wrong_messages() const { return wrong_; }

 private:
  void read() {
    socket_->SetReceiveTimeout(50);
    igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
    while (!stopping_) {
      header->InitPack();
      const int size = receive_all(header->GetPackPointer(), header->GetPackSize());
      if (size < 0) continue;  // nothing came
      if (size == 0) return;   // the other side is gone
      header->Unpack();
      igtl::SensorMessage::Pointer message = igtl::SensorMessage::New();
      if (std::string(header->GetDeviceType()) != "SENSOR" || std::string(header->GetDeviceName()) != "Force") {
        ++wrong_;
        return;
      }
      message->SetMessageHeader(header);
      message->AllocatePack();
      if (receive_all(message->GetPackBodyPointer(), message->GetPackBodySize()) <= 0) return;
      if (!(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) || message->GetLength() != 3) ++wrong_;
      forces_.push_back({message->GetValue(0), message->GetValue(1), message->GetValue(2)});
    }
  }
  /// All of `size` bytes: their number, 0 if the connection is over, -1 if nothing came for a while.
  int receive_all(void* into, int size) {
    for (int done = 0; done < size;) {
      const int count = socket_->Receive(static_cast<char*>(into) + done, size - done, 0);
      if (count == 0) return 0;
      if (count < 0 && (done == 0 || stopping_)) return stopping_ && done > 0 ? 0 : -1;
      if (count > 0) done += count;
    }
    return size;
  }

  igtl::ClientSocket::Pointer socket_;
  std::atomic<bool> stopping_{false};
  std::vector<Vec3> forces_;
  int wrong_ = 0;
  std::thread reader_;
};

}  // namespace ctpm::testing

// Bytes from a network: what OpenIGTLink packs is read, however it is cut; anything else is refused and takes no
// memory.

#include "studio/devices/igtl_message.h"

#include <gtest/gtest.h>

#include <openigtlink/igtlPositionMessage.h>
#include <openigtlink/igtlStringMessage.h>
#include <openigtlink/igtl_util.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "studio/sources/rotation.h"
#include "tests/core/blocks.h"
#include "tests/studio/devices/igtl_client.h"

namespace ctpm {
namespace {

using testing::bytes_of;
using testing::sensor_bytes;
using testing::transform_bytes;

std::span<const std::uint8_t> view(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

struct Heard {
  std::vector<devices::DeviceReport> reports;
  bool is_good = true;
};

/// What a stream tells of bytes that come `at_once` at a time.
Heard hear(const std::string& bytes, std::size_t at_once = 1 << 20, const std::string& name = "") {
  devices::IgtlStream stream(name);
  Heard heard;
  for (std::size_t i = 0; i < bytes.size() && heard.is_good; i += at_once)
    heard.is_good = stream.take(view(bytes).subspan(i, std::min(at_once, bytes.size() - i)), 7.5,
                                [&](const devices::DeviceReport& report) { heard.reports.push_back(report); });
  return heard;
}

/// A number as it stands in a message.
std::string wire(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = size; i-- > 0;) bytes += char(value >> (8 * i) & 0xff);
  return bytes;
}

/// A message put together by hand: of any version, size and checksum.
std::string message(int version, const std::string& type, std::uint64_t size, const std::string& body) {
  std::string bytes = wire(std::uint64_t(version), 2) + type + std::string(12 - type.size(), '\0') +
                      std::string(20, '\0') + wire(0, 8) + wire(size, 8);
  std::vector<unsigned char> copy(body.begin(), body.end());
  copy.push_back(0);
  return bytes + wire(crc64(copy.data(), body.size(), 0), 8) + body;
}

TEST(IgtlStream, APoseIsInMetresAndStampedWithTheDevicesTime) {
  igtl::TransformMessage::Pointer transform = igtl::TransformMessage::New();
  igtl::Matrix4x4 matrix;
  float turn[4] = {0.5f, -0.5f, 0.5f, 0.5f};  // x y z w
  igtl::QuaternionToMatrix(turn, matrix);
  matrix[0][3] = 10, matrix[1][3] = -20, matrix[2][3] = 30;
  transform->SetMatrix(matrix);
  transform->SetTimeStamp(1000, 0x40000000);
  const Heard heard = hear(bytes_of(*transform));
  ASSERT_EQ(heard.reports.size(), 1u);
  const devices::DeviceReport& report = heard.reports.front();
  EXPECT_EQ(report.news, devices::DeviceNews::pose);
  EXPECT_EQ(report.arrival, 7.5);
  EXPECT_EQ(report.device_time, 1000.25);
  EXPECT_NEAR(norm(report.pose.position - Vec3{0.01, -0.02, 0.03}), 0, 1e-8);
  EXPECT_NEAR(sources::angle_between(report.pose.orientation, {0.5, 0.5, -0.5, 0.5}), 0, 1e-3);
}

TEST(IgtlStream, EveryRotationMatrixGivesItsQuaternion) {
  testing::Noise noise;
  for (int i = 0; i < 1000; ++i) {
    Quat q{noise.next(), noise.next(), noise.next(), noise.next()};
    if (i % 5 == 0) q.w *= 1e-4;  // half turns, where the trace gives nothing
    if (sources::length_of(q) < 0.1) continue;
    q = sources::normalised(q);
    std::string body;
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{}}) {
      const Vec3 column = rotate(q, axis);
      for (const double value : {column.x, column.y, column.z})
        body += wire(std::bit_cast<std::uint32_t>(float(value)), 4);
    }
    const Heard heard = hear(message(1, "TRANSFORM", body.size(), body));
    ASSERT_EQ(heard.reports.size(), 1u);
    EXPECT_NEAR(std::abs(sources::dot(heard.reports[0].pose.orientation, q)), 1, 1e-6);
  }
}

TEST(IgtlStream, AMirrorAScaleOrAnEmptyMatrixIsNoRotation) {
  for (const Vec3 diagonal : {Vec3{1, 1, -1}, Vec3{2, 2, 2}, Vec3{0, 0, 0}, Vec3{NAN, 1, 1}, Vec3{1, 1, NAN}}) {
    std::string body;
    for (const double value : {diagonal.x, 0., 0., 0., diagonal.y, 0., 0., 0., diagonal.z, 0., 0., 0.})
      body += wire(std::bit_cast<std::uint32_t>(float(value)), 4);
    const Quat q = hear(message(1, "TRANSFORM", 48, body)).reports.at(0).pose.orientation;
    EXPECT_FALSE(std::abs(sources::length_of(q) - 1) < 0.1);
  }
}

TEST(IgtlStream, PositionsAreReadWithAllThreeKindsOfOrientation) {
  igtl::PositionMessage::Pointer position = igtl::PositionMessage::New();
  position->SetPosition(1, 2, 3);
  position->SetQuaternion(0.6f, 0, 0, 0.8f);
  const std::string whole = bytes_of(*position), body = whole.substr(devices::IgtlStream::kHeaderSize);
  // The shorter ones by hand: OpenIGTLink 1.11 writes past the end of its own buffer when it packs them.
  for (const std::string& bytes :
       {whole, message(1, "QTRANS", 28, body), message(1, "POSITION", 24, body.substr(0, 24)),
        message(1, "POSITION", 12, body.substr(0, 12))}) {
    const Heard heard = hear(bytes);
    ASSERT_EQ(heard.reports.size(), 1u);
    EXPECT_EQ(heard.reports[0].news, devices::DeviceNews::pose) << heard.reports[0].text;
    EXPECT_NEAR(norm(heard.reports[0].pose.position - Vec3{0.001, 0.002, 0.003}), 0, 1e-9);
    const bool has_turn = bytes.size() > devices::IgtlStream::kHeaderSize + 12;
    EXPECT_NEAR(sources::length_of(heard.reports[0].pose.orientation), 1, 1e-6);
    EXPECT_NEAR(sources::angle_between(heard.reports[0].pose.orientation, has_turn ? Quat{0.8, 0.6, 0, 0} : Quat{}), 0,
                1e-3);
  }
}

TEST(IgtlStream, ASensorsValuesAreButtons) {
  const Heard heard = hear(sensor_bytes({1, 0, 0.4, 0.6, NAN}));
  ASSERT_EQ(heard.reports.size(), 1u);
  EXPECT_EQ(heard.reports[0].news, devices::DeviceNews::buttons);
  EXPECT_EQ(heard.reports[0].buttons, 0b1001u);
  EXPECT_EQ(hear(sensor_bytes(std::vector<double>(255, 1))).reports.at(0).buttons, 0xffffffffu);
}

TEST(IgtlStream, AMessageOfProtocolVersion3IsReadAroundItsFurtherHeaderAndMetadata) {
  const std::string pose = transform_bytes({4, 5, 6}).substr(devices::IgtlStream::kHeaderSize);
  const std::string further = wire(12, 2) + wire(6, 2) + wire(9, 4) + wire(77, 4), metadata(15, 'm');
  const std::string body = further + pose + metadata;
  const Heard heard = hear(message(2, "TRANSFORM", body.size(), body));
  ASSERT_EQ(heard.reports.size(), 1u);
  EXPECT_EQ(heard.reports[0].news, devices::DeviceNews::pose) << heard.reports[0].text;
  EXPECT_NEAR(norm(heard.reports[0].pose.position - Vec3{0.004, 0.005, 0.006}), 0, 1e-9);
  // Sizes that do not fit.
  for (const std::string& bad :
       {wire(11, 2) + further.substr(2), wire(12, 2) + wire(6, 2) + wire(0xffffffff, 4) + wire(0, 4),
        wire(65535, 2) + further.substr(2), std::string("abc")}) {
    const Heard refused = hear(message(2, "TRANSFORM", bad.size() + pose.size(), bad + pose));
    ASSERT_EQ(refused.reports.size(), 1u);
    EXPECT_EQ(refused.reports[0].news, devices::DeviceNews::bad_message);
  }
}

TEST(IgtlStream, MessagesAreReadHoweverTheyAreCut) {
  igtl::StringMessage::Pointer chat = igtl::StringMessage::New();
  std::string words(10000, 'x');
  chat->SetString(words);
  std::string bytes;
  for (int i = 0; i < 20; ++i)
    bytes += transform_bytes({double(i), 0, 0}) + (i % 5 == 0 ? bytes_of(*chat) : "") + message(1, "GET_STATUS", 0, "");
  for (const std::size_t at_once : {1, 2, 57, 58, 59, 106, 4096, 1 << 20}) {
    const Heard heard = hear(bytes, at_once);
    EXPECT_TRUE(heard.is_good);
    ASSERT_EQ(heard.reports.size(), 20u) << at_once;
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(heard.reports[std::size_t(i)].pose.position.x, i * 1e-3, 1e-9);
  }
}

TEST(IgtlStream, PosesOfOtherDevicesAreSkippedWhereOneIsNamed) {
  const std::string bytes =
      transform_bytes({1, 0, 0}, 0, "Stylus") + transform_bytes({2, 0, 0}, 0, "Reference") + sensor_bytes({1});
  EXPECT_EQ(hear(bytes).reports.size(), 3u);
  const Heard heard = hear(bytes, 100, "Stylus");
  ASSERT_EQ(heard.reports.size(), 3u);
  EXPECT_EQ(heard.reports[0].pose.position.x, 1e-3);
  EXPECT_EQ(heard.reports[1].news, devices::DeviceNews::other_name);
  EXPECT_STREQ(heard.reports[1].name.data(), "Reference");
  EXPECT_EQ(heard.reports[2].news, devices::DeviceNews::buttons);
  // A name is told once, however many poses follow, and a name without an end of its own ends.
  const std::string longest(20, 'x');
  const Heard flooded =
      hear(transform_bytes({1, 0, 0}, 0, longest) + transform_bytes({1, 0, 0}, 0, "Tip"), 7, "Stylus");
  ASSERT_EQ(flooded.reports.size(), 1u);
  EXPECT_EQ(flooded.reports[0].name.data(), longest);
}

TEST(IgtlStream, AWrongChecksumOrSizeCostsOneMessageAndNotTheNext) {
  std::string broken = transform_bytes({1, 2, 3});
  broken[80] = char(broken[80] ^ 1);
  const std::string good = transform_bytes({4, 5, 6});
  for (const std::string& bad :
       {broken, message(1, "TRANSFORM", 47, std::string(47, '\0')),
        message(1, "TRANSFORM", 5000, std::string(5000, '\0')), message(1, "POSITION", 13, std::string(13, '\0')),
        message(1, "SENSOR", 3, std::string(3, '\0')), message(1, "SENSOR", 20, std::string(20, '\xff'))}) {
    const Heard heard = hear(bad + good, 64);
    EXPECT_TRUE(heard.is_good);
    ASSERT_EQ(heard.reports.size(), 2u);
    EXPECT_EQ(heard.reports[0].news, devices::DeviceNews::bad_message);
    EXPECT_NE(std::string(heard.reports[0].text), "");
    EXPECT_EQ(heard.reports[1].news, devices::DeviceNews::pose);
  }
}

TEST(IgtlStream, WhatIsNoOpenIgtLinkEndsTheConnection) {
  EXPECT_FALSE(hear("GET / HTTP/1.1\r\nHost: localhost\r\nAccept: text/html, everything/else\r\n\r\n").is_good);
  EXPECT_FALSE(hear(std::string(58, '\0')).is_good);
  EXPECT_FALSE(hear(message(9, "TRANSFORM", 48, std::string(48, '\0'))).is_good);
  EXPECT_FALSE(hear(message(1, "TRANS\x01", 48, std::string(48, '\0'))).is_good);
  EXPECT_TRUE(hear("GET").is_good);  // too little to tell
}

TEST(IgtlStream, ASizeThatNobodyMeansEndsTheConnectionAndALargeOneIsSkippedWithoutBeingKept) {
  for (const std::uint64_t size : {1ull << 63, ~0ull, (1ull << 32) + 1})
    EXPECT_FALSE(hear(message(1, "TRANSFORM", size, "")).is_good) << size;
  // An image of 300 MB goes by in pieces; the stream is of a fixed size.
  static_assert(sizeof(devices::IgtlStream) < 8192);
  devices::IgtlStream stream("");
  int told = 0;
  const auto tell = [&](const devices::DeviceReport& report) { told += report.news == devices::DeviceNews::pose; };
  const std::string image = message(1, "IMAGE", 300'000'000, ""), piece(1'000'000, '\x5a');
  EXPECT_TRUE(stream.take(view(image), 0, tell));
  for (int i = 0; i < 300; ++i) EXPECT_TRUE(stream.take(view(piece), 0, tell));
  EXPECT_TRUE(stream.take(view(transform_bytes({1, 2, 3})), 0, tell));
  EXPECT_EQ(told, 1);
}

TEST(IgtlStream, AHeaderThatClaimsTooMuchSwallowsNothingOfWhatFollows) {
  const Heard heard = hear(message(1, "TRANSFORM", 1ull << 31, "") + transform_bytes({1, 2, 3}), 64);
  EXPECT_TRUE(heard.is_good);
  ASSERT_EQ(heard.reports.size(), 2u);
  EXPECT_EQ(heard.reports[0].news, devices::DeviceNews::bad_message);
  EXPECT_EQ(heard.reports[1].news, devices::DeviceNews::pose);
  // An image that never ends, between poses at 100 Hz.
  devices::IgtlStream stream("");
  int told = 0;
  const auto tell = [&](const devices::DeviceReport& report) { told += report.news == devices::DeviceNews::pose; };
  EXPECT_TRUE(stream.take(view(message(1, "IMAGE", 1ull << 31, "")), 0, tell));
  for (int i = 1; i <= 100; ++i) EXPECT_TRUE(stream.take(view(transform_bytes({1, 2, 3})), 0.01 * i, tell));
  EXPECT_GE(told, 45);
}

TEST(IgtlStream, NoChangedCutOrRandomStreamDoesAnythingButReadOrRefuse) {
  const std::string further = wire(12, 2) + wire(6, 2) + wire(9, 4) + wire(77, 4);
  const std::string pose = transform_bytes({4, 5, 6}).substr(devices::IgtlStream::kHeaderSize);
  const std::string whole = transform_bytes({1, 2, 3}) + sensor_bytes({1, 0, 1}) +
                            message(2, "TRANSFORM", 12 + 48 + 15, further + pose + std::string(15, 'm')) +
                            message(1, "POSITION", 28, std::string(28, '?')) + transform_bytes({7, 8, 9});
  std::uint64_t random = 12345;
  const auto next = [&] { return random = random * 6364136223846793005ull + 1442695040888963407ull, random >> 33; };
  for (int round = 0; round < 30000; ++round) {
    std::string bytes = whole;
    for (std::uint64_t change = next() % 4 + 1; change > 0; --change) bytes[next() % bytes.size()] = char(next());
    if (round % 3 == 0) bytes.resize(next() % bytes.size());
    if (round % 5 == 0) bytes = bytes.substr(next() % (bytes.size() + 1));
    for (const devices::DeviceReport& report : hear(bytes, next() % 200 + 1).reports)
      EXPECT_TRUE(report.news == devices::DeviceNews::pose || report.news == devices::DeviceNews::buttons ||
                  report.news == devices::DeviceNews::bad_message);
  }
}

TEST(IgtlForceMessage, IsReadByOpenIgtLinkItself) {
  devices::IgtlForceMessage packed;
  (void)packed.pack({9, 9, 9});
  const std::span<const std::uint8_t> bytes = packed.pack({1.25, -2.5, 1e-9});
  igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
  header->InitPack();
  std::memcpy(header->GetPackPointer(), bytes.data(), std::size_t(header->GetPackSize()));
  header->Unpack();
  EXPECT_STREQ(header->GetDeviceType(), "SENSOR");
  EXPECT_STREQ(header->GetDeviceName(), "Force");
  igtl::SensorMessage::Pointer message = igtl::SensorMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  ASSERT_EQ(bytes.size(), std::size_t(header->GetPackSize() + message->GetPackBodySize()));
  std::memcpy(message->GetPackBodyPointer(), bytes.data() + header->GetPackSize(),
              std::size_t(message->GetPackBodySize()));
  EXPECT_TRUE(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY);
  ASSERT_EQ(message->GetLength(), 3u);
  EXPECT_EQ(message->GetValue(0), 1.25);
  EXPECT_EQ(message->GetValue(1), -2.5);
  EXPECT_EQ(message->GetValue(2), 1e-9);
  igtl::Unit::Pointer newton = igtl::Unit::New();
  newton->Init();
  newton->Append(igtl::Unit::SI_DERIVED_NEWTON, 1);
  EXPECT_EQ(message->GetUnit(), newton->Pack());
}

}  // namespace
}  // namespace ctpm

#include "studio/devices/igtl_message.h"

#include <openigtlink/igtlSensorMessage.h>
#include <openigtlink/igtl_header.h>
#include <openigtlink/igtl_util.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "studio/sources/rotation.h"

namespace ctpm::devices {
namespace {

static_assert(sizeof(igtl_header) == IgtlStream::kHeaderSize);

/// Reads big-endian numbers.
class WireReader {
 public:
  explicit WireReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint64_t whole(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes_[at_++];
    return value;
  }
  double float32() { return std::bit_cast<float>(std::uint32_t(whole(4))); }
  double float64() { return std::bit_cast<double>(whole(8)); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

igtl_header decode(const std::array<std::uint8_t, IgtlStream::kHeaderSize>& bytes) {
  igtl_header header;
  std::memcpy(&header, bytes.data(), bytes.size());
  igtl_header_convert_byte_order(&header);
  return header;
}

template <std::size_t size>
std::string_view text_of(const char (&text)[size]) {
  return {text, strnlen(text, size)};
}

/// The content of a message, without the extended header and metadata of protocol version 3. None if their sizes do not
/// fit.
std::optional<std::span<const std::uint8_t>> content_of(std::span<const std::uint8_t> body, int version) {
  if (version < 2) return body;
  constexpr std::size_t kFurtherHeader = 12;
  if (body.size() < kFurtherHeader) return std::nullopt;
  WireReader reader(body);
  const std::uint64_t further = reader.whole(2), metadata_header = reader.whole(2), metadata = reader.whole(4),
                      around = further + metadata_header + metadata;
  if (further < kFurtherHeader || around > body.size()) return std::nullopt;
  return body.subspan(further, body.size() - around);
}

constexpr double kMillimetre = 1e-3;

/// The rotation with the columns `x`, `y`, `z`; of length 0 if they are no rotation. Shepperd, "Quaternion from
/// rotation matrix" (1978): starts from the largest of the four components to avoid cancellation.
Quat rotation_of(Vec3 x, Vec3 y, Vec3 z) {
  constexpr double kTolerance = 0.02;  // single precision, and trackers that round
  const double off = std::max({std::abs(norm(x) - 1), std::abs(norm(y) - 1), norm(cross(x, y) - z)});
  if (!(off <= kTolerance) || !(std::abs(dot(x, y)) <= kTolerance)) return {0, 0, 0, 0};
  const double trace = x.x + y.y + z.z;
  Quat q;
  if (trace >= std::max({x.x, y.y, z.z}))
    q = {1 + trace, y.z - z.y, z.x - x.z, x.y - y.x};
  else if (x.x >= y.y && x.x >= z.z)
    q = {y.z - z.y, 1 + 2 * x.x - trace, y.x + x.y, z.x + x.z};
  else if (y.y >= z.z)
    q = {z.x - x.z, y.x + x.y, 1 + 2 * y.y - trace, z.y + y.z};
  else
    q = {x.y - y.x, z.x + x.z, z.y + y.z, 1 + 2 * z.z - trace};
  return sources::normalised(q);
}

std::optional<Pose> pose_of_transform(std::span<const std::uint8_t> content) {
  if (content.size() != 48) return std::nullopt;
  WireReader reader(content);
  Vec3 columns[4];
  for (Vec3& column : columns) column.x = reader.float32(), column.y = reader.float32(), column.z = reader.float32();
  return Pose{kMillimetre * columns[3], rotation_of(columns[0], columns[1], columns[2])};
}

/// With a whole quaternion, with its first three components (the fourth is not negative then), or without any.
std::optional<Pose> pose_of_position(std::span<const std::uint8_t> content) {
  if (content.size() != 12 && content.size() != 24 && content.size() != 28) return std::nullopt;
  WireReader reader(content);
  Pose pose;
  pose.position.x = reader.float32(), pose.position.y = reader.float32(), pose.position.z = reader.float32();
  pose.position = kMillimetre * pose.position;
  if (content.size() == 12) return pose;
  Quat& q = pose.orientation;
  q.x = reader.float32(), q.y = reader.float32(), q.z = reader.float32();
  q.w = content.size() == 28 ? reader.float32() : std::sqrt(std::max(0.0, 1 - (q.x * q.x + q.y * q.y + q.z * q.z)));
  return pose;
}

std::optional<std::uint32_t> buttons_of_sensor(std::span<const std::uint8_t> content) {
  constexpr std::size_t kSensorHeader = 10;
  if (content.size() < kSensorHeader) return std::nullopt;
  const std::size_t count = content[0];
  if (content.size() != kSensorHeader + 8 * count) return std::nullopt;
  WireReader reader(content.subspan(kSensorHeader));
  std::uint32_t buttons = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 32); ++i)
    if (reader.float64() > 0.5) buttons |= 1u << i;
  return buttons;
}

}  // namespace

void IgtlStream::begin_again() {
  header_size_ = body_size_ = 0, body_left_ = 0;
  searches_ = is_too_large_ = false;
}

/// Moves the header on through `bytes` until it is sure to be one; false if it is not yet.
bool IgtlStream::search(std::span<const std::uint8_t>& bytes) {
  while (!bytes.empty()) {
    if (header_size_ == kHeaderSize) std::copy(header_.begin() + 1, header_.end(), header_.begin()), --header_size_;
    header_[header_size_++] = bytes.front();
    bytes = bytes.subspan(1);
    if (header_size_ == kHeaderSize && is_sure_header()) {
      searches_ = false;
      return true;
    }
  }
  return false;
}

/// Whether the header announces a message that is read, of a size that it can have.
bool IgtlStream::is_sure_header() const {
  if (header_[0] != 0 || header_[1] < 1 || header_[1] > 3) return false;
  const igtl_header header = decode(header_);
  const std::string_view type = text_of(header.name);
  const bool is_read = type == "TRANSFORM" || type == "POSITION" || type == "QTRANS" || type == "SENSOR";
  return is_read && header.body_size > 0 && header.body_size <= kMostBody;
}

void IgtlStream::refuse(const char* text, double now, const Tell& tell) {
  DeviceReport report;
  report.arrival = now, report.news = DeviceNews::bad_message, report.text = text;
  tell(report);
}

bool IgtlStream::take(std::span<const std::uint8_t> bytes, double now, const Tell& tell) {
  while (!bytes.empty()) {
    if (header_size_ == kHeaderSize && now - began_ > kMostBodyTime) begin_again(), searches_ = true;
    if (searches_) {
      if (!search(bytes)) return true;
      if (!begin_body(now, tell)) return false;
    } else if (header_size_ < kHeaderSize) {
      const std::size_t count = std::min(bytes.size(), kHeaderSize - header_size_);
      std::copy_n(bytes.begin(), count, header_.begin() + std::ptrdiff_t(header_size_));
      header_size_ += count;
      bytes = bytes.subspan(count);
      if (header_size_ < kHeaderSize) return true;
      if (!begin_body(now, tell)) return false;
    }
    if (is_too_large_) {
      refuse("a message of a wrong size", now, tell);
      begin_again(), searches_ = true;
      continue;
    }
    const std::size_t count = std::size_t(std::min<std::uint64_t>(bytes.size(), body_left_));
    if (is_kept_) {
      std::copy_n(bytes.begin(), count, body_.begin() + std::ptrdiff_t(body_size_));
      body_size_ += count;
    }
    body_left_ -= count;
    bytes = bytes.subspan(count);
    if (body_left_ > 0) return true;
    end_body(now, tell);
    begin_again();
  }
  return true;
}

/// Decides from the header whether to read or skip a message. False if the header is invalid.
bool IgtlStream::begin_body(double now, const Tell& tell) {
  began_ = now;
  const igtl_header header = decode(header_);
  const std::string_view type = text_of(header.name);
  const bool is_text = std::all_of(type.begin(), type.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (header.version < 1 || header.version > 3 || type.empty() || !is_text || header.body_size > kMostSkipped)
    return false;
  body_size_ = 0, body_left_ = header.body_size;
  const bool is_position = type == "POSITION" || type == "QTRANS";
  kind_ = type == "TRANSFORM" ? Kind::transform : is_position ? Kind::position : Kind::sensor;
  const bool is_named = device_name_.empty() || text_of(header.device_name) == device_name_;
  const bool is_pose = type == "TRANSFORM" || is_position;
  if (is_pose && !is_named && !std::exchange(told_other_name_, true)) {
    DeviceReport report;
    report.news = DeviceNews::other_name, report.arrival = now;
    text_of(header.device_name).copy(report.name.data(), report.name.size() - 1);
    tell(report);
  }
  const bool is_read = type == "SENSOR" || (is_pose && is_named);
  is_too_large_ = is_read && body_left_ > kMostBody;
  is_kept_ = is_read && !is_too_large_;
  return true;
}

/// Reports the content of a complete message.
void IgtlStream::end_body(double now, const Tell& tell) const {
  DeviceReport report;
  report.arrival = now;
  const auto refuse = [&](const char* text) { IgtlStream::refuse(text, now, tell); };
  if (!is_kept_) return;
  const igtl_header header = decode(header_);
  if (crc64(const_cast<unsigned char*>(body_.data()), body_size_, 0) != header.crc)
    return refuse("a message with a wrong checksum");
  const auto content = content_of(std::span(body_).first(body_size_), header.version);
  if (!content) return refuse("a message of a wrong size");

  report.device_time = double(header.timestamp) / 4294967296.0;  // seconds as fixed point with 32 fractional bits
  if (kind_ == Kind::sensor) {
    const auto buttons = buttons_of_sensor(*content);
    if (!buttons) return refuse("a message of a wrong size");
    report.news = DeviceNews::buttons, report.buttons = *buttons;
  } else {
    const auto pose = kind_ == Kind::transform ? pose_of_transform(*content) : pose_of_position(*content);
    if (!pose) return refuse("a message of a wrong size");
    report.news = DeviceNews::pose, report.pose = *pose;
  }
  tell(report);
}

struct IgtlForceMessage::Impl {
  igtl::SensorMessage::Pointer message = igtl::SensorMessage::New();
  igtl::TimeStamp::Pointer time = igtl::TimeStamp::New();
};

IgtlForceMessage::IgtlForceMessage() : impl_(std::make_unique<Impl>()) {
  igtl::Unit::Pointer newton = igtl::Unit::New();
  newton->Init();
  newton->Append(igtl::Unit::SI_DERIVED_NEWTON, 1);
  impl_->message->SetDeviceName("Force");
  impl_->message->SetUnit(newton->Pack());
  impl_->message->SetLength(3);
}

IgtlForceMessage::~IgtlForceMessage() = default;

std::span<const std::uint8_t> IgtlForceMessage::pack(Vec3 force) {
  const double values[3] = {force.x, force.y, force.z};
  for (unsigned int i = 0; i < 3; ++i) impl_->message->SetValue(i, values[i]);
  impl_->time->GetTime();
  impl_->message->SetTimeStamp(impl_->time);
  impl_->message->Pack();
  return {static_cast<const std::uint8_t*>(impl_->message->GetPackPointer()),
          std::size_t(impl_->message->GetPackSize())};
}

}  // namespace ctpm::devices

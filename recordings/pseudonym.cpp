#include "recordings/pseudonym.h"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "recordings/internal/ed25519.h"
#include "recordings/signature.h"

namespace ctpm::recordings {
namespace {

constexpr std::size_t key_size = 32;          // [bytes]
constexpr std::size_t largest_key = 1 << 16;  // [bytes]
constexpr std::size_t name_digits = 12;       // 48 bits: two of a million names meet with a chance of 1 in 500

std::vector<unsigned char> random_bytes() {
  std::vector<unsigned char> bytes(key_size);
  CTPM_CHECK(::getrandom(bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
             "random bytes from the system");
  return bytes;
}

Result<Done> write_new(const std::string& path, const std::vector<unsigned char>& bytes) {
  const int file = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (file < 0) return Error{path, std::string("cannot be created: ") + std::strerror(errno), ""};
  const bool is_good = ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  const bool is_closed = ::fsync(file) == 0 && ::close(file) == 0;
  if (is_good && is_closed) return Done{};
  ::unlink(path.c_str());
  return Error{path, "cannot be written", ""};
}

/// Names what a file is that is plainly no secret key; empty: it may be one. The 32 bytes of a new key may be any.
std::string kind_of(const std::vector<unsigned char>& bytes) {
  if (bytes.size() == key_size) return "";
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("SQLite format 3")) return "a session";
  if (text.starts_with("-----BEGIN PUBLIC KEY")) return "the public key of signatures";
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (text[first] == '{' || text.substr(first).starts_with("//"))) return "JSON";
  return "";
}

const Error missing{"", "this build has no keyed hash, which pseudonyms are made of", "build with CTPM_SIGNING=ON"};

}  // namespace

Result<PseudonymKey> PseudonymKey::make() {
  if (!can_sign()) return missing;
  return PseudonymKey(random_bytes());
}

Result<PseudonymKey> PseudonymKey::read_or_make(const std::string& path, bool& is_new) {
  if (!can_sign()) return missing;
  std::error_code ignored;
  is_new = !std::filesystem::exists(path, ignored);
  if (is_new) {
    PseudonymKey key(random_bytes());
    if (auto r = write_new(path, key.bytes_); !r) return r.errors();
    return key;
  }
  if (std::filesystem::is_directory(path, ignored))
    return Error{path, "is a folder, not a file", "a file that does not exist is made, with a new key"};
  std::ifstream in(path, std::ios::binary);
  std::vector<unsigned char> bytes;
  for (std::istreambuf_iterator<char> at(in), end; at != end && bytes.size() <= largest_key; ++at)
    bytes.push_back(static_cast<unsigned char>(*at));
  if (const std::string kind = kind_of(bytes); !kind.empty())
    return Error{path, "is no key but " + kind + ", which others may have: they could test whose pseudonym it is",
                 "a file that does not exist is made, with a new key"};
  if (!in || bytes.size() < key_size || bytes.size() > largest_key)
    return Error{path, "is no key: it must hold 32 to 65536 bytes",
                 "a file that does not exist is made, with a new key"};
  return PseudonymKey(std::move(bytes));
}

namespace {
std::string hexadecimal(session_file::ByteView bytes) {
  static constexpr char digit[] = "0123456789abcdef";
  std::string digits;
  for (const std::uint8_t byte : bytes) digits += {digit[byte >> 4], digit[byte & 15]};
  return digits;
}
}  // namespace

std::string PseudonymKey::digits(std::string_view kind, std::string_view text, std::size_t count) const {
  std::string whole(kind);
  whole.push_back('\0');
  whole += text;
  return hexadecimal(session_file::keyed_hash(bytes_, session_file::view(whole))).substr(0, count);
}

std::string PseudonymKey::name(std::string_view kind, std::string_view text) const {
  return std::string(kind) + "-" + digits(kind, text, name_digits);
}

std::string name_uuid(std::string_view name) {
  if (!can_sign()) return "";
  // The namespace of addresses, 6ba7b811-9dad-11d1-80b4-00c04fd430c8.
  static constexpr unsigned char addresses[] = {0x6b, 0xa7, 0xb8, 0x11, 0x9d, 0xad, 0x11, 0xd1,
                                                0x80, 0xb4, 0x00, 0xc0, 0x4f, 0xd4, 0x30, 0xc8};
  session_file::Bytes whole(std::begin(addresses), std::end(addresses));
  whole.insert(whole.end(), name.begin(), name.end());
  session_file::Sha1 hash = session_file::sha1(whole);
  hash[6] = std::uint8_t((hash[6] & 0x0f) | 0x50), hash[8] = std::uint8_t((hash[8] & 0x3f) | 0x80);
  std::string text = hexadecimal({hash.data(), 16});
  for (const std::size_t place : {20u, 16u, 12u, 8u}) text.insert(place, "-");
  return text;
}

}  // namespace ctpm::recordings

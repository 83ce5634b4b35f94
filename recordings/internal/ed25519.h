#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/model/result.h"
#include "recordings/internal/bytes.h"

namespace ctpm::recordings::session_file {

using PublicKey = std::array<std::uint8_t, 32>;
using Ed25519Signature = std::array<std::uint8_t, 64>;
using Digest = std::array<std::uint8_t, 64>;

/// Incremental SHA-512.
class Sha512 {
 public:
  Sha512();
  ~Sha512();
  Sha512(const Sha512&) = delete;
  Sha512& operator=(const Sha512&) = delete;
  void add(ByteView bytes);
  Digest value();

 private:
  void* context_;
};

/// HMAC-SHA-256 (RFC 2104) of a text.
using KeyedHash = std::array<std::uint8_t, 32>;
KeyedHash keyed_hash(ByteView key, ByteView text);

/// SHA-1, for names that a standard makes of it; it protects nothing.
using Sha1 = std::array<std::uint8_t, 20>;
Sha1 sha1(ByteView bytes);

/// Keys are PEM files, PKCS #8 or SubjectPublicKeyInfo. Errors name the file.
Result<Done> write_new_key(const std::string& secret_file, const std::string& public_file);
Result<PublicKey> public_key_of(const std::string& file);

struct Signed {
  PublicKey key;
  Ed25519Signature signature;
};
Result<Signed> sign(const std::string& secret_file, ByteView message);
bool is_signed(const PublicKey& key, const Ed25519Signature& signature, ByteView message);

}  // namespace ctpm::recordings::session_file

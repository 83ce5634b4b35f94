#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"

namespace ctpm::recordings {

/// Gives names their pseudonyms: a keyed hash (HMAC-SHA-256), so that a name has the same one wherever the key is the
/// same, and nobody without the key can try names until one fits.
class PseudonymKey {
 public:
  /// A key that nobody keeps: pseudonyms of another run differ. Error: this build has no keyed hash (CTPM_SIGNING).
  static Result<PseudonymKey> make();
  /// The key in a file. A missing file is made, with a new key that its owner alone can read; `is_new` then becomes
  /// true. Errors: the file cannot be read or made, holds fewer than 32 bytes, or is what others may have: JSON, a
  /// session, a public key; this build has no keyed hash.
  static Result<PseudonymKey> read_or_make(const std::string& path, bool& is_new);

  /// Hexadecimal digits, at most 64, for a text of a kind: the same text of another kind has others.
  std::string digits(std::string_view kind, std::string_view text, std::size_t count) const;
  /// "organ-3f20c81d05ab".
  std::string name(std::string_view kind, std::string_view text) const;

 private:
  explicit PseudonymKey(std::vector<unsigned char> bytes) : bytes_(std::move(bytes)) {}
  std::vector<unsigned char> bytes_;
};

/// A UUID of version 5 (RFC 4122) of a name within the namespace of addresses; empty in a build without OpenSSL
/// (CTPM_SIGNING).
std::string name_uuid(std::string_view name);

}  // namespace ctpm::recordings

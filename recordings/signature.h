#pragma once

#include <optional>
#include <string>

#include "core/model/result.h"

namespace ctpm::recordings {

/// Who signed a session.
struct Signature {
  std::string key;   ///< public key, 64 hexadecimal digits
  std::string name;  ///< that the signer gave; nobody has checked it
};

/// Whether this build can sign and check signatures (CTPM_SIGNING).
bool can_sign();

/// Makes a new Ed25519 key: `path` holds the secret part (PEM, readable by its owner alone), `path`.pub the public one.
/// Errors: one of the files exists or cannot be written; this build cannot sign.
Result<Done> make_key(const std::string& path);

/// The public key of a file with a secret or a public part (PEM), as in Signature::key. Errors: no such file, or no
/// Ed25519 key in it.
Result<std::string> read_public_key(const std::string& path);

/// Signs the session at `path` with the secret key in `key_file`: its whole content, so that no row can change. Errors:
/// the session has no clean end, is damaged or signed already; no such key; this build cannot sign.
Result<Signature> sign_session(const std::string& path, const std::string& key_file, const std::string& name);

/// Checks the signature of a session. None: it is not signed. Errors: the content is not what was signed; this build
/// cannot check it.
Result<std::optional<Signature>> check_signature(const std::string& path);

}  // namespace ctpm::recordings

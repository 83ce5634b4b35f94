// In builds without CTPM_SIGNING. Callers ask can_sign() first.

#include "recordings/internal/ed25519.h"

namespace ctpm::recordings::session_file {
namespace {
const Error missing{"", "this build cannot sign or check signatures", "build with CTPM_SIGNING=ON"};
}

Sha512::Sha512() : context_(nullptr) {}
Sha512::~Sha512() = default;
void Sha512::add(ByteView) {}
Digest Sha512::value() { return {}; }
Sha1 sha1(ByteView) { return {}; }
KeyedHash keyed_hash(ByteView, ByteView) { return {}; }
Result<Done> write_new_key(const std::string&, const std::string&) { return missing; }
Result<PublicKey> public_key_of(const std::string&) { return missing; }
Result<Signed> sign(const std::string&, ByteView) { return missing; }
bool is_signed(const PublicKey&, const Ed25519Signature&, ByteView) { return false; }

}  // namespace ctpm::recordings::session_file

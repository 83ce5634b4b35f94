#include "recordings/internal/ed25519.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace ctpm::recordings::session_file {
namespace {

struct Free {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using Key = std::unique_ptr<EVP_PKEY, Free>;
using Context = std::unique_ptr<EVP_MD_CTX, Free>;
using File = std::unique_ptr<std::FILE, Free>;

Result<Key> read_key(const std::string& path, bool must_be_secret) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return Error{path, std::string("cannot be read: ") + std::strerror(errno), ""};
  // No prompt for a password: an encrypted key is an error.
  const auto no_password = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_PrivateKey(file.get(), nullptr, no_password, nullptr));
  if (!key && !must_be_secret) {
    std::rewind(file.get());
    key.reset(PEM_read_PUBKEY(file.get(), nullptr, no_password, nullptr));
  }
  if (!key || EVP_PKEY_get_base_id(key.get()) != EVP_PKEY_ED25519)
    return Error{path, must_be_secret ? "holds no secret Ed25519 key" : "holds no Ed25519 key", "make one: ctpm key"};
  return key;
}

Result<PublicKey> public_part(const Key& key, const std::string& path) {
  PublicKey bytes{};
  std::size_t size = bytes.size();
  if (EVP_PKEY_get_raw_public_key(key.get(), bytes.data(), &size) != 1 || size != bytes.size())
    return Error{path, "holds no Ed25519 key", ""};
  return bytes;
}

/// A new file, which only its owner may read if it is secret.
File create(const std::string& path, bool is_secret) {
  const int number = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, is_secret ? 0600 : 0644);
  return File(number < 0 ? nullptr : ::fdopen(number, "wb"));
}

}  // namespace

Sha512::Sha512() : context_(EVP_MD_CTX_new()) {
  CTPM_CHECK(context_ && EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(context_), EVP_sha512(), nullptr) == 1,
             "a hash of the library");
}
Sha512::~Sha512() { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context_)); }
void Sha512::add(ByteView bytes) {
  CTPM_CHECK(EVP_DigestUpdate(static_cast<EVP_MD_CTX*>(context_), bytes.data(), bytes.size()) == 1,
             "a hash of the library");
}
Digest Sha512::value() {
  Digest digest{};
  CTPM_CHECK(EVP_DigestFinal_ex(static_cast<EVP_MD_CTX*>(context_), digest.data(), nullptr) == 1,
             "a hash of the library");
  return digest;
}

KeyedHash keyed_hash(ByteView key, ByteView text) {
  KeyedHash hash{};
  std::size_t size = 0;
  CTPM_CHECK(EVP_Q_mac(nullptr, "HMAC", nullptr, "SHA256", nullptr, key.data(), key.size(), text.data(), text.size(),
                       hash.data(), hash.size(), &size) != nullptr &&
                 size == hash.size(),
             "a keyed hash of the library");
  return hash;
}

Sha1 sha1(ByteView bytes) {
  Sha1 hash{};
  std::size_t size = hash.size();
  CTPM_CHECK(EVP_Q_digest(nullptr, "SHA1", nullptr, bytes.data(), bytes.size(), hash.data(), &size) == 1,
             "a hash of the library");
  return hash;
}

Result<Done> write_new_key(const std::string& secret_file, const std::string& public_file) {
  const Key key(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"));
  CTPM_CHECK(bool(key), "a key of the library");
  for (const bool is_secret : {true, false}) {
    const std::string& path = is_secret ? secret_file : public_file;
    const File file = create(path, is_secret);
    const bool is_good =
        file &&
        (is_secret ? PEM_write_PKCS8PrivateKey(file.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr)
                   : PEM_write_PUBKEY(file.get(), key.get())) == 1 &&
        std::fflush(file.get()) == 0;
    if (is_good) continue;
    const Error error{path, std::string("cannot be created: ") + std::strerror(errno), ""};
    if (file) ::unlink(path.c_str());
    if (!is_secret) ::unlink(secret_file.c_str());
    return error;
  }
  return Done{};
}

Result<PublicKey> public_key_of(const std::string& file) {
  const Result<Key> key = read_key(file, false);
  if (!key) return key.errors();
  return public_part(*key, file);
}

Result<Signed> sign(const std::string& secret_file, ByteView message) {
  const Result<Key> key = read_key(secret_file, true);
  if (!key) return key.errors();
  const Result<PublicKey> known = public_part(*key, secret_file);
  if (!known) return known.errors();
  Signed made{*known, {}};
  const Context context(EVP_MD_CTX_new());
  std::size_t size = made.signature.size();
  if (!context || EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key->get()) != 1 ||
      EVP_DigestSign(context.get(), made.signature.data(), &size, message.data(), message.size()) != 1)
    return Error{secret_file, "cannot sign with this key", ""};
  return made;
}

bool is_signed(const PublicKey& key, const Ed25519Signature& signature, ByteView message) {
  const Key known(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size()));
  const Context context(EVP_MD_CTX_new());
  return known && context && EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, known.get()) == 1 &&
         EVP_DigestVerify(context.get(), signature.data(), signature.size(), message.data(), message.size()) == 1;
}

}  // namespace ctpm::recordings::session_file

#include "recordings/signature.h"

#include <algorithm>
#include <vector>

#include "recordings/internal/ed25519.h"
#include "recordings/internal/field_codec.h"
#include "recordings/internal/session_store.h"
#include "recordings/session_reader.h"

namespace ctpm::recordings {

using namespace session_file;

namespace {

#ifdef CTPM_SIGNING
constexpr bool has_signing = true;
#else
constexpr bool has_signing = false;
#endif

constexpr const char* signature_part = "signature";
constexpr std::size_t longest_name = 1000;  // [bytes]

/// The part `signature`.
struct SignaturePart {
  std::vector<std::uint8_t> key, signature;
  std::string name;
};

template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, SignaturePart>
void for_each_field(S& s, Visit&& visit) {
  visit("key", s.key);
  visit("signature", s.signature);
  visit("name", s.name);
}

Error cannot(const std::string& path) {
  return {path, "is signed, and this build cannot check signatures", "build with CTPM_SIGNING=ON"};
}

std::string hexadecimal(const PublicKey& key) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : key) text += {digits[byte >> 4], digits[byte & 15]};
  return text;
}

/// What is signed: SHA-512 over each row in the order of the keys, but the signature itself; FORMAT.md section 4.
Result<Bytes> message_of(SessionStore& store, const PublicKey& key, const std::string& name) {
  Sha512 hash;
  const auto rows = store.for_each_row([&](const std::string& label, std::int64_t size, ByteView data) {
    if (label == std::string("part ") + signature_part) return;
    const std::string head = label + " " + std::to_string(size) + " " + std::to_string(data.size()) + "\n";
    hash.add(view(head)), hash.add(data);
  });
  if (!rows) return rows.errors();
  const Digest digest = hash.value();
  const std::string head = "ctpm session 1\n" + hexadecimal(key) + "\n" + name + "\n";
  Bytes message(head.begin(), head.end());
  message.insert(message.end(), digest.begin(), digest.end());
  return message;
}

}  // namespace

bool can_sign() { return has_signing; }

Result<Done> make_key(const std::string& path) { return write_new_key(path, path + ".pub"); }

Result<std::string> read_public_key(const std::string& path) {
  const Result<PublicKey> key = public_key_of(path);
  if (!key) return key.errors();
  return hexadecimal(*key);
}

Result<Signature> sign_session(const std::string& path, const std::string& key_file, const std::string& name) {
  if (!can_sign()) return Error{path, "this build cannot sign", "build with CTPM_SIGNING=ON"};
  if (name.size() > longest_name) return Error{"", "the signer's name is too long", ""};
  auto reader = SessionReader::open(path);
  if (!reader) return reader.errors();
  if (!reader->ended_cleanly())
    return Error{path, "has no clean end", "ctpm recover makes a session that has one, of what is there"};
  if (auto r = reader->check_all(); !r) return r.errors();
  auto store = SessionStore::open(path, false);
  if (!store) return store.errors();
  const auto there = store->part_if_there(signature_part);
  if (!there) return there.errors();
  if (*there) return Error{path, "is signed already", ""};
  const Result<PublicKey> key = public_key_of(key_file);
  if (!key) return key.errors();
  const Result<Bytes> message = message_of(*store, *key, name);
  if (!message) return message.errors();
  const Result<Signed> made = sign(key_file, *message);
  if (!made) return made.errors();

  Bytes content;
  put_fields(
      content,
      SignaturePart{{made->key.begin(), made->key.end()}, {made->signature.begin(), made->signature.end()}, name});
  const Block block = pack(part_name(signature_part), content, store->identity().seed, 3);
  auto tables = SessionTables::open_for_writing(path);
  if (!tables) return tables.errors();
  if (auto r = tables->begin(); !r) return r.errors();
  auto written = tables->insert_part(signature_part, block);
  if (written) written = tables->commit();
  if (!written) {
    tables->rollback();
    return written.errors();
  }
  if (auto r = tables->close(); !r) return r.errors();
  return Signature{hexadecimal(made->key), name};
}

Result<std::optional<Signature>> check_signature(const std::string& path) {
  auto store = SessionStore::open(path, false);
  if (!store) return store.errors();
  const auto content = store->part_if_there(signature_part);
  if (!content) return content.errors();
  if (!*content) return std::optional<Signature>{};
  SignaturePart part;
  std::string problem;
  ByteReader in(**content, 1 << 16);
  get_fields(in, part, problem);
  PublicKey key{};
  Ed25519Signature signature{};
  if (problem.empty() && (part.key.size() != key.size() || part.signature.size() != signature.size()))
    problem = "the key or the signature has another length";
  if (!problem.empty()) return Error{path, "part signature: " + problem, ""};
  if (!can_sign()) return cannot(path);
  std::copy(part.key.begin(), part.key.end(), key.begin());
  std::copy(part.signature.begin(), part.signature.end(), signature.begin());
  const Result<Bytes> message = message_of(*store, key, part.name);
  if (!message) return message.errors();
  if (!is_signed(key, signature, *message))
    return Error{path, "its content is not what was signed with the key " + hexadecimal(key), ""};
  return std::optional(Signature{hexadecimal(key), part.name});
}

}  // namespace ctpm::recordings

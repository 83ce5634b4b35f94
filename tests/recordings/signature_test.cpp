#include "recordings/signature.h"

#include <sys/stat.h>

#include "recordings/replay.h"
#include "tests/recordings/forge.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

TEST(Signature, NamesTheKeyAndFindsWhateverIsChangedWithRightChecksums) {
  if (!recordings::can_sign()) GTEST_SKIP() << "built without CTPM_SIGNING";
  const Folder folder;
  const std::string path = folder / "a.ctpm", key = folder / "me.pem";
  record_session(path, small_start(), 600);
  ASSERT_TRUE(recordings::make_key(key));
  EXPECT_FALSE(recordings::make_key(key)) << "an existing key is not replaced";
  struct stat info {};
  ASSERT_EQ(::stat(key.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
  EXPECT_FALSE(recordings::check_signature(path)->has_value());

  const auto made = recordings::sign_session(path, key, "A. Trainee");
  ASSERT_TRUE(made) << text_of(made.errors());
  EXPECT_EQ(made->key, *recordings::read_public_key(key + ".pub"));
  const auto found = recordings::check_signature(path);
  ASSERT_TRUE(found && *found) << text_of(found ? Errors{} : found.errors());
  EXPECT_EQ((*found)->key, made->key);
  EXPECT_EQ((*found)->name, "A. Trainee");
  EXPECT_FALSE(recordings::sign_session(path, key, "B")) << "signed already";
  {
    auto reader = recordings::SessionReader::open(path);
    ASSERT_TRUE(reader) << text_of(reader.errors());
    const auto verdict = recordings::verify_session(*reader);
    ASSERT_TRUE(verdict) << text_of(verdict.errors());
    EXPECT_TRUE(verdict->same);
  }

  const auto change_first_byte = [](session_file::Bytes& content) { content.back() ^= 1; };
  const std::function<void(Forge&)> changes[] = {
      [&](Forge& f) { f.change("part", "scene", change_first_byte); },
      [&](Forge& f) { f.change("part", "look", change_first_byte); },
      [](Forge& f) { f.run("DELETE FROM keyframe WHERE tick = 250"); },
      [](Forge& f) { f.run("DELETE FROM event WHERE first = (SELECT max(first) FROM event)"); },
      [](Forge& f) { f.run("INSERT INTO part VALUES('later', 0, 0, x'00')"); },
      [](Forge& f) {
        f.change("part", "signature", [](session_file::Bytes& content) {
          const std::string text(content.begin(), content.end());
          content[text.find("Trainee")] = 'X';
        });
      },
  };
  for (const auto& change : changes) {
    const std::string changed = folder / "changed.ctpm";
    std::filesystem::copy_file(path, changed, std::filesystem::copy_options::overwrite_existing);
    {
      Forge forge(changed);
      change(forge);
    }
    const auto checked = recordings::check_signature(changed);
    ASSERT_FALSE(checked);
    EXPECT_NE(checked.errors()[0].message.find("is not what was signed"), std::string::npos)
        << text_of(checked.errors());
    auto reader = recordings::SessionReader::open(changed);
    EXPECT_TRUE(!reader || !recordings::verify_session(*reader));
  }
}

TEST(Signature, OnlyAWholeSessionAndAKeyOfItsKindSign) {
  if (!recordings::can_sign()) GTEST_SKIP() << "built without CTPM_SIGNING";
  const Folder folder;
  ASSERT_TRUE(recordings::make_key(folder / "me.pem"));
  { auto writer = recordings::SessionWriter::create(folder / "open.ctpm", small_start(3, 2, 2)); }
  EXPECT_FALSE(recordings::sign_session(folder / "open.ctpm", folder / "me.pem", ""));
  record_session(folder / "a.ctpm", small_start(3, 2, 2), 30);
  write_bytes(folder / "no.pem", {'n', 'o'});
  for (const char* wrong : {"no.pem", "nowhere.pem", "me.pem.pub"})
    EXPECT_FALSE(recordings::sign_session(folder / "a.ctpm", folder / wrong, "")) << wrong;
  EXPECT_TRUE(recordings::sign_session(folder / "a.ctpm", folder / "me.pem", ""));
}

}  // namespace
}  // namespace ctpm

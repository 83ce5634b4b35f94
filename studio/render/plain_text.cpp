#include "studio/render/plain_text.h"

#include <unicode/translit.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <memory>

namespace ctpm::render {

std::string plain_text(const std::string& text) {
  const auto is_ascii = [](unsigned char c) { return c < 128; };
  if (std::all_of(text.begin(), text.end(), is_ascii)) return text;
  static thread_local const std::unique_ptr<icu::Transliterator> to_ascii = [] {
    UErrorCode failed = U_ZERO_ERROR;
    return std::unique_ptr<icu::Transliterator>(
        icu::Transliterator::createInstance("Any-Latin; NFC; Latin-ASCII", UTRANS_FORWARD, failed));
  }();
  icu::UnicodeString letters = icu::UnicodeString::fromUTF8(text);
  if (to_ascii) to_ascii->transliterate(letters);
  std::string plain;
  for (std::int32_t i = 0; i < letters.length(); i = letters.moveIndex32(i, 1)) {
    const UChar32 letter = letters.char32At(i);
    plain += letter < 128 ? char(letter) : '?';
  }
  return plain;
}

}  // namespace ctpm::render

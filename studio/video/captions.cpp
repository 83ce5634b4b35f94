#include "studio/video/captions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace ctpm::video {
namespace {

constexpr std::uint32_t kPerSecond = 1000;  // time scale of the subtitle track
constexpr std::size_t kMostChapters = 255;

/// Bytes of an MP4 file (ISO/IEC 14496-12), big-endian.
class Bytes {
 public:
  std::string text;

  Bytes& u8(std::uint64_t v) { return put(v, 1); }
  Bytes& u16(std::uint64_t v) { return put(v, 2); }
  Bytes& u32(std::uint64_t v) { return put(v, 4); }
  Bytes& u64(std::uint64_t v) { return put(v, 8); }
  Bytes& raw(const std::string& bytes) {
    text += bytes;
    return *this;
  }
  Bytes& zeros(std::size_t count) {
    text.append(count, '\0');
    return *this;
  }
  /// The matrix that changes nothing.
  Bytes& matrix() { return u32(0x10000).zeros(12).u32(0x10000).zeros(12).u32(0x40000000); }

 private:
  Bytes& put(std::uint64_t v, int count) {
    for (int i = count - 1; i >= 0; --i) text.push_back(char(v >> (8 * i)));
    return *this;
  }
};

std::string box(const char* kind, const std::string& content) {
  return Bytes().u32(content.size() + 8).raw(kind).raw(content).text;
}

std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i) v = v << 8 | std::uint8_t(bytes[at + i]);
  return v;
}

/// A box within others; npos: there is none.
struct Place {
  std::size_t at = std::string::npos, size = 0;
};
Place find_box(const std::string& bytes, std::size_t from, std::size_t to, const char* kind) {
  while (from + 8 <= to) {
    const std::size_t size = number(bytes, from, 4);
    if (size < 8 || from + size > to) break;
    if (bytes.compare(from + 4, 4, kind) == 0) return {from, size};
    from += size;
  }
  return {};
}

/// A subtitle, or silence between two.
struct Sample {
  std::uint32_t duration;  ///< [1 / kPerSecond s]
  std::string bytes;
};

std::vector<Sample> samples_of(const std::vector<Caption>& captions) {
  std::vector<Sample> samples;
  std::int64_t now = 0;
  const auto add = [&](std::int64_t until, const std::string& text) {
    if (until <= now) return;
    samples.push_back({std::uint32_t(until - now), Bytes().u16(text.size()).raw(text).text});
    now = until;
  };
  for (const Caption& caption : captions) {
    add(std::llround(caption.from_s * kPerSecond), "");
    add(std::llround(caption.to_s * kPerSecond), caption.text.substr(0, 1000));
  }
  return samples;
}

std::string sample_table(const std::vector<Sample>& samples, std::uint64_t first_byte) {
  const std::string font = box("ftab", Bytes().u16(1).u16(1).u8(4).raw("Sans").text);
  const std::string entry = box("tx3g", Bytes()
                                            .zeros(6)
                                            .u16(1)
                                            .u32(0)
                                            .u8(1)
                                            .u8(0xff)
                                            .u32(0)
                                            .zeros(8)
                                            .zeros(4)
                                            .u16(1)
                                            .u8(0)
                                            .u8(18)
                                            .u32(0xffffffff)
                                            .raw(font)
                                            .text);
  Bytes times, sizes, places;
  times.u32(0).u32(samples.size()), sizes.u32(0).u32(0).u32(samples.size()), places.u32(0).u32(samples.size());
  for (const Sample& sample : samples) {
    times.u32(1).u32(sample.duration), sizes.u32(sample.bytes.size()), places.u64(first_byte);
    first_byte += sample.bytes.size();
  }
  return box("stbl", box("stsd", Bytes().u32(0).u32(1).raw(entry).text) + box("stts", times.text) +
                         box("stsc", Bytes().u32(0).u32(1).u32(1).u32(1).u32(1).text) + box("stsz", sizes.text) +
                         box("co64", places.text));
}

std::string subtitle_track(const std::vector<Sample>& samples, std::uint32_t number, double movie_scale,
                           std::uint64_t first_byte) {
  std::uint64_t whole = 0;
  for (const Sample& sample : samples) whole += sample.duration;
  const auto in_movie = std::uint64_t(std::llround(double(whole) / kPerSecond * movie_scale));
  const std::string header =
      box("tkhd", Bytes().u32(3).u32(0).u32(0).u32(number).u32(0).u32(in_movie).zeros(16).matrix().zeros(8).text);
  constexpr std::uint32_t kEnglish = 0x15c7;
  const std::string media_header =
      box("mdhd", Bytes().u32(0).u32(0).u32(0).u32(kPerSecond).u32(whole).u16(kEnglish).u16(0).text);
  const std::string handler = box("hdlr", Bytes().u32(0).u32(0).raw("sbtl").zeros(12).raw("captions").u8(0).text);
  const std::string source = box("dinf", box("dref", Bytes().u32(0).u32(1).raw(box("url ", Bytes().u32(1).text)).text));
  const std::string content =
      box("minf", box("nmhd", Bytes().u32(0).text) + source + sample_table(samples, first_byte));
  return box("trak", header + box("mdia", media_header + handler + content));
}

/// Chapters as most players read them (Nero's `chpl`), in units of 100 ns.
std::string chapter_list(const std::vector<Caption>& captions) {
  std::vector<const Caption*> chapters;
  for (const Caption& caption : captions)
    if (caption.is_chapter && chapters.size() < kMostChapters) chapters.push_back(&caption);
  Bytes list;
  list.u32(0x01000000).u32(0).u8(chapters.size());
  for (const Caption* chapter : chapters) {
    std::string name = chapter->text.substr(0, 255);
    std::replace(name.begin(), name.end(), '\n', ' ');
    list.u64(std::uint64_t(std::llround(chapter->from_s * 1e7))).u8(name.size()).raw(name);
  }
  return box("chpl", list.text);
}

/// A movie's own data with a title, as iTunes writes it and players show it.
std::string with_title(const std::string& own, std::string title) {
  std::replace(title.begin(), title.end(), '\n', ' ');
  const std::string name = box("\xa9nam", box("data", Bytes().u32(1).u32(0).raw(title).text));
  const Place meta = find_box(own, 0, own.size(), "meta");
  if (meta.at == std::string::npos) {
    const std::string handler = box("hdlr", Bytes().u32(0).u32(0).raw("mdirappl").zeros(9).text);
    return own + box("meta", Bytes().u32(0).raw(handler).raw(box("ilst", name)).text);
  }
  const std::size_t end = meta.at + meta.size;
  const Place list = find_box(own, meta.at + 12, end, "ilst");
  if (list.at == std::string::npos) return own;
  const std::string before = own.substr(meta.at + 8, list.at - meta.at - 8),
                    after = own.substr(list.at + list.size, end - list.at - list.size);
  const std::string longer = box("ilst", own.substr(list.at + 8, list.size - 8) + name);
  return own.substr(0, meta.at) + box("meta", before + longer + after) + own.substr(end);
}

/// The index with one more track, and with chapters; empty if it has no header.
std::string with_captions(const std::string& movie, const std::vector<Caption>& captions,
                          const std::vector<Sample>& samples, std::uint64_t first_byte) {
  std::string content = movie.substr(8);
  const Place header = find_box(content, 0, content.size(), "mvhd");
  constexpr std::size_t kHeaderSize = 108;  // of version 0
  if (header.size != kHeaderSize) return "";
  const double scale = double(number(content, header.at + 20, 4));
  const std::size_t next_at = header.at + kHeaderSize - 4;
  const auto next = std::uint32_t(number(content, next_at, 4));
  content.replace(next_at, 4, Bytes().u32(next + 1).text);
  const std::string track = subtitle_track(samples, next, scale, first_byte), chapters = chapter_list(captions);
  const Place user = find_box(content, 0, content.size(), "udta");
  const std::string& title = captions.front().text;
  if (user.at == std::string::npos) return box("moov", content + track + box("udta", with_title("", title) + chapters));
  const std::string before = content.substr(0, user.at), own = content.substr(user.at + 8, user.size - 8),
                    after = content.substr(user.at + user.size);
  return box("moov", before + track + box("udta", with_title(own, title) + chapters) + after);
}

}  // namespace

Result<Done> add_captions(const std::string& path, const std::vector<Caption>& captions) {
  const std::vector<Sample> samples = samples_of(captions);
  if (samples.empty()) return Done{};
  const Error other_form{path, "captions cannot be added: the video's index is not at its end", ""};
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::uint64_t size = file ? std::filesystem::file_size(path) : 0;
  std::uint64_t at = 0, length = 0;
  std::string head(16, '\0');
  // The index is the last box.
  for (;;) {
    if (at + 16 > size || !file.seekg(std::streamoff(at)).read(head.data(), 16)) return other_form;
    length = number(head, 0, 4) == 1 ? number(head, 8, 8) : number(head, 0, 4);
    if (length < 8 || at + length > size) return other_form;
    if (head.compare(4, 4, "moov") == 0) break;
    at += length;
  }
  if (at + length != size || number(head, 0, 4) == 1) return other_form;
  std::string movie(std::size_t(length), '\0');
  if (!file.seekg(std::streamoff(at)).read(movie.data(), std::streamsize(length))) return other_form;
  std::string words;
  for (const Sample& sample : samples) words += sample.bytes;
  const std::string index = with_captions(movie, captions, samples, at + 8);
  if (index.empty()) return other_form;
  const std::string end = box("mdat", words) + index;
  if (!file.seekp(std::streamoff(at)).write(end.data(), std::streamsize(end.size())).flush())
    return Error{path, "captions could not be written", "check the free space"};
  return Done{};
}

}  // namespace ctpm::video

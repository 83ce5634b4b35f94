#include "studio/reports/report.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "studio/output/files.h"
#include "studio/output/option_name.h"

namespace ctpm::reports {
namespace {

/// By which a report of this program is known.
constexpr const char* kGenerator = "<meta name=\"generator\" content=\"ctpm\"/>";

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, "Liberation Sans", "DejaVu Sans", sans-serif; color: #222; background: #fff; max-width: 1120px; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .3rem; }
h2 { font-size: 1.25rem; margin: 2.4rem 0 .5rem; padding-top: .8rem; border-top: 1px solid #ddd; }
.subtitle, .caption { color: #555; }
.caption { font-size: 13px; margin: .3rem 0 0; max-width: 62em; }
.head { font-weight: 600; margin: .8rem 0 .3rem; }
.conclusion { padding: .7rem 1.1rem; margin: 1.2rem 0; border-left: 6px solid #777; background: #f6f6f6; }
.conclusion p { font-size: 1.15rem; font-weight: 600; margin: 0; } .conclusion ul { margin: .4rem 0 0; padding-left: 1.2rem; }
.conclusion.good { border-color: #009e73; background: #f0f9f5; } .conclusion.bad { border-color: #c0392b; background: #fcf3f1; }
.verdict { padding: .5rem .8rem; border-left: 5px solid #999; background: #f6f6f6; font-weight: 600; }
.verdict.good { border-color: #009e73; } .verdict.bad { border-color: #c0392b; }
.row { display: flex; flex-wrap: wrap; gap: 1.2rem; margin: .8rem 0; }
figure { margin: 0; flex: 0 1 520px; max-width: 100%; }
figure svg, figure img { max-width: 100%; height: auto; display: block; }
figure img { border: 1px solid #ddd; }
.table { overflow-x: auto; margin: .8rem 0 1.2rem; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem; text-align: left; border-bottom: 1px solid #e4e4e4; }
th { border-bottom: 2px solid #888; vertical-align: bottom; font-weight: 600; }
td.n { text-align: right; white-space: nowrap; } td { min-width: 2.5em; max-width: 26em; }
.v { padding: 0 .45rem; border-radius: 3px; font-weight: 600; }
.v.met { background: #d8f0e6; color: #00654a; } .v.missed { background: #f6d5d1; color: #96271b; } .v.shown { background: #ececec; color: #555; } .v.refused { background: #fbecc8; color: #7a5200; }
svg .grid { stroke: #e6e6e6; } svg .axis { stroke: #444; }
svg text { font: 12px system-ui, "Liberation Sans", "DejaVu Sans", sans-serif; fill: #222; }
svg .tick { fill: #555; font-size: 11.5px; } svg .head { font-weight: 600; font-size: 13.5px; }
svg .event path { stroke: #c0392b; stroke-dasharray: 2 3; fill: none; } svg .event rect { fill: #c0392b; } svg .event text { fill: #fff; font-weight: 600; font-size: 11.5px; }
svg .cursor { pointer-events: none; } svg .cursor path { stroke: #222; } svg .cursor rect { fill: #fff; stroke: #aaa; opacity: .93; }
figure:target { outline: 3px solid #c0392b; outline-offset: 4px; }
@media (max-width: 600px) {
  body { padding: 0 .9rem; margin: 1rem auto; } h1 { font-size: 1.4rem; } .row { gap: .8rem; }
  figure { flex-basis: 100% !important; } figure svg { width: 100%; }
  svg text, svg .tick { font-size: 15px; } svg .head { font-size: 15.5px; } svg .cursor text { font-size: 17px; }
  .table { overflow-x: visible; } table, tbody { display: block; } thead { display: none; }
  tr { display: flex; flex-wrap: wrap; gap: 0 1rem; padding: .4rem 0; border-bottom: 1px solid #ddd; }
  td, td.n { display: block; border: 0; padding: 0; min-width: 0; text-align: left; white-space: normal; order: 2; overflow-wrap: anywhere; }
  td:empty { display: none; } td:first-child { order: 0; font-weight: 600; flex: 1 0 60%; } td.verdict-cell { order: 1; }
  tr::after { content: ""; order: 1; flex: 1 0 100%; }
  td[data-title]:not(:first-child):not(.verdict-cell)::before, td.n[data-title]:first-child::before { content: attr(data-title) " "; color: #666; }
}
)";

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t rest = bytes.size() - i;
    const unsigned word = unsigned(bytes[i]) << 16 | (rest > 1 ? unsigned(bytes[i + 1]) << 8 : 0u) |
                          (rest > 2 ? unsigned(bytes[i + 2]) : 0u);
    text += kDigits[word >> 18 & 63];
    text += kDigits[word >> 12 & 63];
    text += rest > 1 ? kDigits[word >> 6 & 63] : '=';
    text += rest > 2 ? kDigits[word & 63] : '=';
  }
  return text;
}

/// `width`: of a plot [pixels]; 0: that of pictures.
std::string figure(const std::string& content, const std::string& caption, const std::string& id = "", int width = 0) {
  const std::string words =
      caption.empty() ? "" : "<figcaption class=\"caption\">" + escape_html(caption) + "</figcaption>";
  const std::string style = width > 0 ? " style=\"flex-basis:" + std::to_string(width) + "px\"" : "";
  return "<figure" + (id.empty() ? "" : " id=\"" + escape_html(id) + "\"") + style + ">" + content + words +
         "</figure>\n";
}

}  // namespace

Report::Report(std::string title, std::string subtitle) : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

Result<Done> Report::add(const Section& section) {
  add_heading(section.title);
  for (const std::string& text : section.paragraphs) add_paragraph(text);
  if (!section.plots.empty()) add_plots(section.plots);
  if (!section.pictures.empty())
    if (Result<Done> added = add_pictures(section.pictures); !added) return added;
  for (const Table& table : section.tables) add_table(table);
  return Done{};
}

void Report::conclude(ReportVerdict verdict, const std::string& sentence, const std::vector<std::string>& points) {
  const char* tone = verdict == ReportVerdict::met ? " good" : verdict == ReportVerdict::missed ? " bad" : "";
  body_ += std::string("<div class=\"conclusion") + tone + "\"><p>" + escape_html(sentence) + "</p>";
  for (std::size_t i = 0; i < points.size(); ++i)
    body_ += (i ? "" : "<ul>") + ("<li>" + escape_html(points[i]) + "</li>") + (i + 1 < points.size() ? "" : "</ul>");
  body_ += "</div>\n";
}

void Report::add_heading(const std::string& text) { body_ += "<h2>" + escape_html(text) + "</h2>\n"; }
void Report::add_paragraph(const std::string& text) { body_ += "<p>" + escape_html(text) + "</p>\n"; }
void Report::add_link(const std::string& text, const std::string& address) {
  body_ += "<p><a href=\"" + escape_html(address) + "\">" + escape_html(text) + "</a></p>\n";
}
void Report::add_verdict(bool is_good, const std::string& text) {
  body_ += std::string("<p class=\"verdict ") + (is_good ? "good" : "bad") + "\">" + escape_html(text) + "</p>\n";
}
void Report::add_table(const Table& table) { body_ += to_html(table); }

void Report::add_plots(const std::vector<Plot>& plots) {
  body_ += "<div class=\"row\">\n";
  has_plots_ = has_plots_ || !plots.empty();
  for (const Plot& plot : plots) body_ += figure(to_svg(plot), plot.caption, "", plot.width);
  body_ += "</div>\n";
}

Result<Done> Report::add_pictures(const std::vector<Picture>& pictures) {
  std::string row;
  for (const Picture& picture : pictures) {
    const Result<std::string> data = to_data_uri(picture.frame);
    if (!data) return data.errors();
    row += figure("<img alt=\"" + escape_html(picture.caption) + "\" src=\"" + *data + "\"/>", picture.caption,
                  picture.id);
  }
  body_ += "<div class=\"row\">\n" + row + "</div>\n";
  return Done{};
}

std::string Report::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"/>" + std::string(kGenerator) +
         "<meta name=\"viewport\" "
         "content=\"width=device-width\"/><title>" +
         escape_html(title_) + "</title><style>" + kStyle + "</style></head>\n<body>\n<h1>" + escape_html(title_) +
         "</h1>\n<p class=\"subtitle\">" + escape_html(subtitle_) + "</p>\n" + body_ +
         (has_plots_ ? plot_script() : "") + "</body>\n</html>\n";
}

Result<std::string> to_data_uri(const render::Frame& frame) {
  const Result<std::vector<std::uint8_t>> png = render::to_png(frame);
  if (!png) return png.errors();
  return "data:image/png;base64," + base64(*png);
}

namespace {

/// Whether this program wrote a page.
bool is_own_page(const std::filesystem::path& page) {
  std::string head(2000, '\0');
  std::ifstream written(page, std::ios::binary);
  written.read(head.data(), std::streamsize(head.size()));
  return head.find(kGenerator) != std::string::npos;
}

/// The first file that a report would replace in a folder which holds no report of this program; empty if none.
std::string file_of_others(const std::string& folder, const std::string& page) {
  const std::filesystem::path place = folder;
  if (is_own_page(place / page)) return "";
  std::error_code ignored;
  for (const std::string& name : {page, std::string("results.json"), std::string("results.csv")})
    if (std::filesystem::exists(place / name, ignored)) return (place / name).string();
  return "";
}

}  // namespace

Result<Done> prepare_folder(const std::string& folder, const std::string& page) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    return Error{folder, "cannot be made: " + failure.message(),
                 "give another folder with " + output::option_name("report.folder")};
  if (const std::string other = file_of_others(folder, page); !other.empty())
    return Error{other, "exists already, and no report of this program lies beside it",
                 "give another folder with " + output::option_name("report.folder")};
  return output::check_writable((std::filesystem::path(folder) / page).string());
}

Result<Done> check_folder(const std::string& folder, const std::string& page) {
  std::error_code ignored;
  std::vector<std::filesystem::path> missing;
  for (std::filesystem::path place = std::filesystem::absolute(folder, ignored).lexically_normal();
       !place.empty() && !std::filesystem::exists(place, ignored); place = place.parent_path())
    missing.push_back(place);
  const Result<Done> ready = prepare_folder(folder, page);
  for (const std::filesystem::path& place : missing) std::filesystem::remove(place, ignored);
  return ready;
}

void remove_old_pages(const std::string& folder, const std::string& begin, const std::vector<ReportFile>& files) {
  std::error_code failure;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::string name = entry.path().filename().string();
    const bool is_new = std::ranges::any_of(files, [&](const ReportFile& file) { return file.name == name; });
    if (!is_new && name.starts_with(begin) && name.ends_with(".html") && entry.is_regular_file(failure) &&
        is_own_page(entry.path()))
      old.push_back(entry.path());
  }
  for (const std::filesystem::path& page : old) std::filesystem::remove(page, failure);
}

Result<Done> write_report(const std::string& folder, const std::vector<ReportFile>& files, const std::string& page) {
  if (Result<Done> ready = prepare_folder(folder, page); !ready) return ready;
  for (const ReportFile& file : files)
    if (Result<Done> written = output::write_text_file((std::filesystem::path(folder) / file.name).string(), file.text);
        !written)
      return written;
  return Done{};
}

}  // namespace ctpm::reports

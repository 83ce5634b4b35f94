#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/render/frame.h"
#include "studio/reports/plot.h"
#include "studio/reports/table.h"

namespace ctpm::reports {

/// A picture with its caption.
struct Picture {
  render::Frame frame;
  std::string caption;
  std::string id = {};  ///< by which plots lead to it: "#id"
};

/// One part of a report: text first, then plots, pictures and tables.
struct Section {
  std::string key;  ///< name in JSON
  std::string title;
  std::vector<std::string> paragraphs;  ///< before everything else
  std::vector<Plot> plots;
  std::vector<Picture> pictures;
  std::vector<Table> tables;
};

/// One self-contained HTML page: text, tables, line plots and pictures.
class Report {
 public:
  Report(std::string title, std::string subtitle);

  /// The page's conclusion, below its title: the result in one sentence, coloured where it is good or bad, and what a
  /// reader must know to believe it.
  void conclude(ReportVerdict verdict, const std::string& sentence, const std::vector<std::string>& points);

  void add_heading(const std::string& text);
  void add_paragraph(const std::string& text);

  /// Adds a line that leads to another page, by its relative address.
  void add_link(const std::string& text, const std::string& address);

  /// Adds a section with its heading. Error: a picture that cannot be encoded.
  Result<Done> add(const Section& section);

  /// Adds a line with a coloured verdict.
  void add_verdict(bool is_good, const std::string& text);

  void add_table(const Table& table);

  /// Adds plots side by side, as many as fit in a row.
  void add_plots(const std::vector<Plot>& plots);

  /// Adds pictures side by side, as many as fit in a row, embedded as PNG. Error: a frame that cannot be encoded.
  Result<Done> add_pictures(const std::vector<Picture>& pictures);

  /// The page so far.
  std::string html() const;

 private:
  std::string title_, subtitle_, body_;
  bool has_plots_ = false;
};

/// A frame as `data:image/png;base64,...`. Error: an empty frame.
Result<std::string> to_data_uri(const render::Frame& frame);

/// A file of a report; `name` is relative to the report's folder.
struct ReportFile {
  std::string name, text;
};

/// Creates `folder` if necessary and checks that it can be written. Errors: also files that a report would replace,
/// where no report of this program, known by its first page, lies beside them.
Result<Done> prepare_folder(const std::string& folder, const std::string& page = "report.html");

/// Checks that prepare_folder() will do, and leaves no folder behind. Call it before the work to be reported, which may
/// be refused.
Result<Done> check_folder(const std::string& folder, const std::string& page = "report.html");

/// Removes the pages of an earlier report of this program whose names begin with `begin`, but for `files`.
void remove_old_pages(const std::string& folder, const std::string& begin, const std::vector<ReportFile>& files);

/// Writes each file under a temporary name, then renames it, so that no reader sees an incomplete file. Errors: those
/// of output/files.h.
Result<Done> write_report(const std::string& folder, const std::vector<ReportFile>& files,
                          const std::string& page = "report.html");

}  // namespace ctpm::reports

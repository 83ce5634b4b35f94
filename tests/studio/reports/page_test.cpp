// Pages of results in Debian's Chromium: plots read their values, and small screens need no scrolling sideways.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "studio/reports/report.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

constexpr const char* kChromium = "/usr/bin/chromium";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The page after its scripts have run.
std::string shown(const testing::Folder& folder, const std::string& html) {
  std::ofstream(folder / "page.html") << html;
  const std::string command = std::string(kChromium) + " --headless --no-sandbox --disable-gpu --window-size=1280,900" +
                              " --user-data-dir=" + (folder / "profile") + " --dump-dom file://" +
                              (folder / "page.html") + " 2>/dev/null";
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  CTPM_CHECK(pipe, "a browser starts");
  char part[4096];
  for (std::size_t n = 0; (n = fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, n);
  EXPECT_EQ(pclose(pipe), 0);
  return text;
}

reports::Plot force_plot() {
  reports::Plot plot{.title = "Force", .x_title = "time [s]", .y_title = "force [N]"};
  plot.series.push_back({.name = "expert", .x = {0, 2, 4}, .y = {0, 6, 0}});
  plot.series.push_back({.name = "trainee <1>", .x = {0, 4}, .y = {1, 3}});
  plot.x_range = {0, 4}, plot.y_range = {0, 8};
  return plot;
}

std::string page_of(const reports::Plot& plot) {
  reports::Report report("A title", "below it");
  report.add_plots({plot});
  return report.html();
}

class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kChromium)) GTEST_SKIP() << kChromium << " is not installed";
  }
  const testing::Folder folder_;
};

TEST_F(Page, APlotReadsTheValuesUnderAMouse) {
  // At x = 2 s of a plot of 4 s, whose axis goes from 62 to 506 of 520 pixels.
  const std::string after = shown(folder_, page_of(force_plot()) + R"(<script>{
    const svg = document.querySelector("svg[data-x]"), box = svg.getBoundingClientRect(), scale = box.width / 520;
    const to = x => svg.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + x * scale, clientY: box.top + 100 * scale }));
    to(284);
    document.body.dataset.read = svg.querySelector(".cursor").textContent;
    to(20);
    document.body.dataset.beside = svg.querySelector(".cursor").textContent + "nothing";
  }</script>)");
  EXPECT_TRUE(holds(after, "data-read=\"time [s]  2expert  6trainee &lt;1&gt;  2\""))
      << after.substr(after.find("<body"), 200);
  EXPECT_TRUE(holds(after, "data-beside=\"nothing\"")) << "beside the axes there is no value";
}

TEST_F(Page, MarksAreReadBesideALineAndAlone) {
  for (const bool has_line : {true, false}) {
    reports::Plot plot{.title = "Goals", .x_title = "number", .y_title = "share", .x_range = {{0, 4}}};
    plot.series.push_back({.name = "met", .x = {1, 2, 3}, .y = {2, 6, 4}, .stroke = reports::Stroke::marks});
    if (has_line) plot.series.push_back({.name = "bound", .x = {0, 4}, .y = {5, 5}});
    plot.y_range = {0, 8};
    const std::string after = shown(folder_, page_of(plot) + R"(<script>{
      const svg = document.querySelector("svg[data-x]"), box = svg.getBoundingClientRect(), scale = box.width / 520;
      svg.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + 286 * scale, clientY: box.top + 100 * scale }));
      document.body.dataset.read = svg.querySelector(".cursor").textContent;
    }</script>)");
    EXPECT_TRUE(holds(after, "met  6")) << after.substr(after.find("<body"), 200);
    EXPECT_EQ(holds(after, "bound  5\""), has_line) << after.substr(after.find("<body"), 200);
  }
}

TEST_F(Page, OnASmallScreenNothingIsOutOfSight) {
  reports::Report report("A title that is longer than a telephone is wide, or nearly so", "below it");
  report.conclude(reports::ReportVerdict::missed, "One of two goals is missed.", {"The second one."});
  reports::Plot small = force_plot();
  small.title = "mean deviation of the aligned paths", small.width = 360,
  small.series[0].name = "fails too often above", small.bands = {{"experts, one spread", 2, 3}};
  reports::Plot residuals = force_plot();
  residuals.y_title = "network less measured [N]";
  residuals.y_range = {-0.0022, 0.0012}, residuals.series[0].y = {-0.002, 0, 0.001};
  reports::Plot wordy = force_plot();
  wordy.title = "Under auto, of the way that spheres may go, this much is gone";
  report.add_plots({force_plot(), small, residuals, wordy});
  reports::Table table;
  for (int i = 0; i < 14; ++i) table.columns.push_back({"key", "column number " + std::to_string(i)});
  table.rows.emplace_back(14, reports::Cell(1234567.0));
  table.rows[0][13] = reports::ReportVerdict::missed;
  reports::Table narrow;
  narrow.columns = {{"recipe", "recipe"}, {"verdict", "verdict"}, {"met", "met"}};
  narrow.rows = {{std::string("The drawn surface under a ball, and a small ball"), reports::ReportVerdict::met, 3.0}};
  reports::Table numbers;
  numbers.columns = {{"radius_mm", "r [mm]"}, {"spheres", "spheres"}};
  numbers.rows = {{4.0, 225.0}};
  report.add_table(table), report.add_table(narrow), report.add_table(numbers);
  std::string page = report.html(), quoted;
  for (const char c : page) quoted += c == '"' ? "&quot;" : c == '&' ? "&amp;" : std::string(1, c);
  const std::string after =
      shown(folder_, "<body><iframe width=420 height=800 style=\"border:0\" srcdoc=\"" + quoted + R"("></iframe><script>
    onload = () => {
      const inner = document.querySelector("iframe").contentDocument, cell = inner.querySelector(".verdict-cell"), first = inner.querySelector("td");
      document.body.dataset.wider = inner.documentElement.scrollWidth - inner.documentElement.clientWidth;
      document.body.dataset.hidden = [...inner.querySelectorAll("*")].filter(e => getComputedStyle(e).overflowX === "auto" && e.scrollWidth > e.clientWidth).length;
      const texts = svg => [...svg.querySelectorAll(".legend, .head, .title, .tick")].map(e => ({ text: e.textContent, box: e.getBoundingClientRect() }));
      const meet = (a, b) => a.right > b.left && b.right > a.left && a.bottom > b.top + 3 && b.bottom > a.top + 3;
      document.body.dataset.cut = [...inner.querySelectorAll("svg")].flatMap(svg => texts(svg).filter((one, i, all) =>
        one.box.right > svg.getBoundingClientRect().right || all.some((other, j) => j != i && meet(one.box, other.box)))).map(one => one.text).join(", ");
      document.body.dataset.named = getComputedStyle([...inner.querySelectorAll("table")].pop().querySelector("tbody td"), "::before").content.includes("r [mm]");
      document.body.dataset.below = [...inner.querySelectorAll("table")].every(t => [...t.querySelectorAll(".n")].pop().getBoundingClientRect().top >= t.querySelector("td").getBoundingClientRect().bottom - 4);
  document.body.dataset.beside = Math.abs(cell.getBoundingClientRect().top - first.getBoundingClientRect().top) < 8;
};
  </script>)");
  EXPECT_TRUE(holds(after, "data-wider=\"0\"")) << after.substr(0, 300);
  EXPECT_TRUE(holds(after, "data-cut=\"\"")) << "no text of a plot lies on another or ends outside it: "
                                             << after.substr(std::min(after.find("data-cut"), after.size()), 100);
  EXPECT_TRUE(holds(after, "data-hidden=\"0\"")) << "no part scrolls sideways by itself";
  EXPECT_TRUE(holds(after, "data-beside=\"true\"")) << "the verdict stands beside the row's name";
  EXPECT_TRUE(holds(after, "data-named=\"true\"")) << "a number at a row's beginning says what it is";
  EXPECT_TRUE(holds(after, "data-below=\"true\"")) << "and nothing else does";
}

TEST_F(Page, AsManySmallPlotsStandInARowAsFit) {
  reports::Plot small = force_plot();
  small.width = 330;
  reports::Report report("A title", "below it");
  report.add_plots({small, small, small});
  const std::string after = shown(folder_, report.html() + R"(<script>
    document.body.dataset.rows = new Set([...document.querySelectorAll("figure")].map(f => f.getBoundingClientRect().top)).size;
  </script>)");
  EXPECT_TRUE(holds(after, "data-rows=\"1\"")) << after.substr(after.find("<body"), 100);
}

TEST(Report, ColumnsInWhichNothingIsAreLeftOut) {
  reports::Table table;
  table.columns = {{"a", "a"}, {"b", "b"}, {"c", "c"}, {"d", "d"}};
  table.rows = {{reports::Cell(), std::string("x"), std::string(), 1.0}, {reports::Cell(), std::string(), 2.0, 3.0}};
  const reports::Table shorter = reports::without_empty_columns(table);
  EXPECT_EQ(reports::to_csv(shorter), "b,c,d\nx,,1\n,2,3\n");
}

TEST(Report, AnEventLeadsToItsPlaceAndStaysWithinTheAxes) {
  reports::Plot plot = force_plot();
  plot.events = {{1, "1", "force above the limit", "#moment-1"}, {1.01, "2", "pause", ""}, {9, "3", "outside", "#x"}};
  const std::string svg = reports::to_svg(plot);
  EXPECT_TRUE(holds(svg, "href=\"#moment-1\"><title>force above the limit</title>")) << svg;
  EXPECT_TRUE(holds(svg, "<title>pause</title>"));
  EXPECT_FALSE(holds(svg, "outside"));
  // Labels of events at nearly one time stand beside each other.
  const auto first = svg.find("class=\"flag\""), second = svg.find("class=\"flag\"", first + 1);
  const auto place = [&](std::size_t at) { return std::strtod(svg.c_str() + svg.rfind("x=\"", at) + 3, nullptr); };
  EXPECT_GE(place(second) - place(first), 15);
}

TEST(Report, CountsHaveWholeTicksRoundingIsNoDifferenceAndWhatHasNoPointsHasNoLegend) {
  reports::Plot plot{.x_range = {{0.5, 1.5}}};
  plot.series = {{.name = "attempts", .x = {1}, .y = {6e-14}, .stroke = reports::Stroke::marks}, {.name = "mean"}};
  EXPECT_TRUE(holds(reports::to_svg(plot), ">0.6<") && holds(reports::to_svg(plot), "e-14"));
  plot.counts_x = true, plot.least_y_span = 0.1;
  const std::string svg = reports::to_svg(plot);
  EXPECT_TRUE(holds(svg, ">1<") && holds(svg, ">attempts<"));
  EXPECT_FALSE(holds(svg, ">0.6<") || holds(svg, "e-14") || holds(svg, ">mean<")) << svg;
}

TEST(Report, MarksOfSeveralSeriesAtOnePlaceStandSideBySide) {
  reports::Plot plot{.series = {{.x = {1, 2}, .y = {1, 2}, .stroke = reports::Stroke::marks}}};
  const std::string there = reports::to_svg(plot);
  plot.series[0].shift = 10;
  const std::string beside = reports::to_svg(plot);
  const auto place = [](const std::string& svg) { return std::strtod(svg.c_str() + svg.find("cx=\"") + 4, nullptr); };
  EXPECT_NEAR(place(beside) - place(there), 10, 1e-9);
}

TEST(Report, AConclusionComesFirstAndAPageWithoutPlotsHasNoScript) {
  reports::Report report("Title", "subtitle");
  report.conclude(reports::ReportVerdict::met, "All <3> goals hold.", {"a", "b"});
  report.add_heading("Goals");
  const std::string page = report.html();
  EXPECT_TRUE(holds(page, "class=\"conclusion good\"><p>All &lt;3&gt; goals hold.</p><ul><li>a</li><li>b</li></ul>"))
      << page;
  EXPECT_LT(page.find("All &lt;3&gt;"), page.find("<h2>"));
  EXPECT_FALSE(holds(page, "<script"));
}

}  // namespace
}  // namespace ctpm

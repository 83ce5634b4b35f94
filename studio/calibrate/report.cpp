#include "studio/calibrate/report.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/materials_file.h"
#include "studio/output/json_writer.h"
#include "studio/output/number_text.h"
#include "studio/reports/report.h"

namespace ctpm::calibrate {
namespace {

/// Digits after the decimal point with which half an interval has one digit; negative: whole tens, hundreds.
int places_of(const Estimate& estimate) {
  const double half = std::max(0.5 * (estimate.high() - estimate.low()), 1e-9 * estimate.value);
  return -int(std::floor(std::log10(half)));
}

std::string rounded(double value, int places) {
  const double unit = std::pow(10.0, -places);
  return output::fixed(std::round(value / unit) * unit, std::max(0, places));
}

reports::Table estimate_table(const Fit& fit) {
  reports::Table table;
  table.columns = {
      {"what", "what"}, {"value", "value", 4, true}, {"interval", "95 % interval"}, {"unit", "unit"}, {"note", "note"}};
  for (const Estimate& one : fit.estimates)
    table.rows.push_back({one.title, told(one), interval_text(one), one.unit,
                          std::string(one.is_at_bound ? "at bound: the data ask for more" : "")});
  table.caption =
      "Intervals are those of a fit that is linear in the logarithms, with Student's t; they know of the scatter of "
      "the "
      "data, not of what the model lacks.";
  return reports::without_empty_columns(std::move(table));
}

reports::Table correlation_table(const Fit& fit) {
  reports::Table table;
  table.title = "Correlation of what was fitted";
  table.columns = {{"of", "of"}};
  const std::size_t count = fit.fitted.size();
  for (const std::string& name : fit.fitted) table.columns.push_back({name, name, 2});
  for (std::size_t i = 0; i < count; ++i) {
    table.rows.push_back({fit.fitted[i]});
    for (std::size_t j = 0; j < count; ++j) table.rows.back().emplace_back(fit.correlation[i * count + j]);
  }
  table.caption = "Near 1 or -1: the data tell the two together better than each alone.";
  return table;
}

std::string percent(double share) { return output::short_number(100 * share, 2) + " %"; }

/// A cell with a text, or an empty one.
reports::Cell cell_if(bool is_known, const std::function<std::string()>& text) {
  reports::Cell cell;
  if (is_known) cell = text();
  return cell;
}

/// "K2" of "K2, the stiffness at once".
std::string symbol_of(const Estimate& estimate) { return estimate.title.substr(0, estimate.title.find_first_of(" ,")); }

/// A row for each specimen, and one for what they tell together.
reports::Table specimen_table(const std::vector<SpecimenFit>& specimens, const std::vector<Estimate>& whole) {
  reports::Table table;
  table.title = "Specimens, each alone and left out";
  table.columns = {{"specimen", "specimen"}};
  std::vector<std::size_t> shown;  // what any specimen tells
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (spread_of(specimens, i).count > 0) shown.push_back(i);
  for (const std::size_t i : shown)
    table.columns.push_back({whole[i].key, symbol_of(whole[i]) + " [" + whole[i].unit + "]"});
  table.columns.push_back({"error_share", "met alone to", 2});
  table.columns.push_back({"left_out_error_share", "met by the others to", 2});
  table.columns.push_back({"note", "note"});
  for (const SpecimenFit& one : specimens) {
    std::vector<reports::Cell> row{one.name};
    for (const std::size_t i : shown)
      row.push_back(cell_if(i < one.estimates.size(), [&] { return told(one.estimates[i]); }));
    row.push_back(cell_if(!one.estimates.empty(), [&] { return percent(one.error); }));
    row.push_back(cell_if(!std::isnan(one.left_out_error), [&] { return percent(one.left_out_error); }));
    row.emplace_back(one.problem);
    table.rows.push_back(std::move(row));
  }
  std::vector<reports::Cell> mean{std::string("mean")}, spread{std::string("spread")};
  for (const std::size_t i : shown) {
    const SpecimenSpread of = spread_of(specimens, i);
    mean.push_back(cell_if(of.count > 1, [&] { return output::short_number(of.mean, 3); }));
    spread.push_back(cell_if(of.count > 1, [&] { return percent(of.deviation); }));
  }
  for (auto* row : {&mean, &spread}) {
    row->resize(table.columns.size());
    table.rows.push_back(std::move(*row));
  }
  table.caption =
      "A specimen that was left out takes no part in the fit that meets it. Mean and spread (standard deviation) are "
      "those of the logarithms: so far may the next specimen be from these, whatever the intervals above say.";
  return table;
}

std::vector<reports::Plot> plots_of(const Match& match) {
  const Measurement& one = *match.measurement;
  const bool is_slow = one.kind == Kind::indentation;
  const std::string x_title = is_slow ? "depth [mm]" : "time [s]",
                    what = one.kind == Kind::creep ? "depth [mm]" : "force [N]";
  reports::Plot curve{.title = std::string(to_word(one.kind)) + ": " + one.name.substr(one.name.rfind('/') + 1),
                      .x_title = x_title,
                      .y_title = what};
  reports::Plot rest{.title = "residuals: network less measured", .x_title = x_title, .y_title = what};
  reports::Series used{.name = "measured", .stroke = reports::Stroke::marks, .colour = 0},
      held{.name = "held out", .stroke = reports::Stroke::crosses, .colour = 1},
      network{.name = "network", .colour = 2}, used_rest = used, held_rest = held;
  used_rest.name = "in the fit";
  for (std::size_t i = 0; i < match.simulated.size(); ++i) {
    const double x = is_slow ? one.rows[i].imposed : one.rows[i].time;
    reports::Series &at = match.is_held_out[i] ? held : used, &off = match.is_held_out[i] ? held_rest : used_rest;
    at.x.push_back(x), at.y.push_back(one.rows[i].measured);
    off.x.push_back(x), off.y.push_back(match.simulated[i] - one.rows[i].measured);
    network.x.push_back(x), network.y.push_back(match.simulated[i]);
  }
  // So that no mark is cut.
  const double margin = 0.03 * (network.x.back() - network.x.front());
  curve.x_range = rest.x_range = std::pair(network.x.front() - margin, network.x.back() + margin);
  curve.series = {used, held, network}, rest.series = {used_rest, held_rest};
  return {curve, rest};
}

/// Where the network is farthest from what was measured, as a share of the largest value of that measurement.
std::string worst_row(const Fit& fit) {
  double most = 0;
  std::string text;
  for (const Match& match : fit.matches) {
    const Measurement& one = *match.measurement;
    double largest = 0;
    for (const auto& row : one.rows) largest = std::max(largest, std::abs(row.measured));
    for (std::size_t i = 0; i < match.simulated.size(); ++i) {
      const double measured = one.rows[i].measured, off = std::abs(match.simulated[i] - measured) / largest;
      if (!(off > most)) continue;
      const bool is_slow = one.kind == Kind::indentation;
      const std::string unit = one.kind == Kind::creep ? " mm" : " N";
      most = off;
      text = "At worst the network gives " + output::short_number(match.simulated[i], 3) + unit + " where " +
             output::short_number(measured, 3) + unit + " was measured: " + to_word(one.kind) + " " + one.name +
             " at " + output::short_number(is_slow ? one.rows[i].imposed : one.rows[i].time, 3) +
             (is_slow ? " mm." : " s.");
    }
  }
  return text;
}

std::string results_json(const Fit& fit, const std::vector<SpecimenFit>& specimens) {
  output::JsonWriter json;
  json.begin_object().member("format", "ctpm-calibration-results").member("version", 1);
  json.member("program_version", CTPM_VERSION).key("estimates").begin_list();
  for (const Estimate& one : fit.estimates) {
    json.begin_object().member("key", std::string_view(one.key)).member("is_told", one.is_told());
    json.member("at_bound", one.is_at_bound);
    if (one.is_told()) json.member("value", one.value).member("low", one.low()).member("high", one.high());
    json.end_object();
  }
  json.end_list().key("correlation");
  reports::write_rows(json, correlation_table(fit));
  json.member("error_share", fit.error).member("held_out_error_share", fit.held_out_error);
  json.key("specimens").begin_list();
  for (const SpecimenFit& one : specimens) {
    json.begin_object().member("name", std::string_view(one.name)).member("error_share", one.error);
    json.member("left_out_error_share", one.left_out_error).key("estimates").begin_object();
    for (const Estimate& estimate : one.estimates)
      if (estimate.is_told()) json.member(estimate.key, estimate.value);
    json.end_object().end_object();
  }
  json.end_list();
  json.member("starts", fit.starts).member("same_starts", fit.same_starts).key("plots").begin_list();
  for (const Match& match : fit.matches)
    for (const reports::Plot& plot : plots_of(match)) reports::write_points(json, plot);
  return json.end_list().end_object().text();
}

/// As an author's own, with the digits that a fit can have.
scenes::NamedMaterial own_material(const Fit& fit, const std::string& name) {
  const auto rounded = [](double modulus) { return std::stod(output::short_number(modulus, 6)); };
  scenes::MaterialSpec material;
  material.preset = fit.material.preset, material.calibration_ball = fit.material.calibration_ball;
  const Parameters& p = fit.parameters;
  material.spring = rounded(1e6 * p.spring()), material.kelvin = rounded(1e6 * p.kelvin());
  material.constraint = rounded(1e6 * p.prime()), material.viscosity = rounded(1e6 * p.viscosity());
  return {name, material};
}

}  // namespace

std::string told(const Estimate& estimate) {
  return estimate.is_told() ? rounded(estimate.value, places_of(estimate)) : "cannot be told";
}

std::string interval_text(const Estimate& estimate) {
  if (!estimate.is_told()) return "";
  const int places = places_of(estimate);
  return rounded(estimate.low(), places) + " to " + rounded(estimate.high(), places);
}

std::vector<std::string> remarks_of(const Fit& fit, const std::vector<SpecimenFit>& specimens) {
  const std::string held_out = std::isnan(fit.held_out_error)
                                   ? " (too few rows to hold any out; "
                                   : " and those held out to " + percent(fit.held_out_error) + " (";
  std::vector<std::string> remarks{"The network meets the rows of the fit to " + percent(fit.error) + held_out +
                                   "root mean square, of each measurement's own)."};
  if (const std::string worst = worst_row(fit); !worst.empty()) remarks.push_back(worst);
  std::string unknown;
  for (const Estimate& one : fit.estimates)
    if (!one.is_told()) unknown += (unknown.empty() ? "" : ", ") + symbol_of(one);
  if (!unknown.empty()) remarks.push_back("The data cannot tell: " + unknown + ".");
  for (const Estimate& one : fit.estimates)
    if (one.is_at_bound) remarks.push_back(symbol_of(one) + " is at its bound: the data ask for more.");
  std::string left_out;
  for (const SpecimenFit& one : specimens)
    if (!std::isnan(one.left_out_error)) left_out += (left_out.empty() ? "" : ", ") + percent(one.left_out_error);
  if (!left_out.empty())
    remarks.push_back("Whole specimens that were left out are met by the fit of the others to " + left_out + ".");
  remarks.push_back(std::to_string(fit.same_starts) + " of " + std::to_string(fit.starts) +
                    " starts ended at the same place.");
  return remarks;
}

Result<Done> write_calibration(const Fit& fit, const std::vector<SpecimenFit>& specimens, const MaterialName& name,
                               const std::string& folder) {
  const Result<std::string> materials =
      scenes::with_material(name.beside, scenes::kMaterialsFile, own_material(fit, name.name));
  if (!materials) return materials.errors();
  if (Result<Done> ready = reports::prepare_folder(folder); !ready) return ready;
  reports::Report report("Material " + name.name,
                         "Fitted to " + std::to_string(fit.matches.size()) +
                             " measurements, each simulated in the network on " +
                             (fit.block ? "a block of the specimen's size." : "the paper's rig of five spheres."));
  const bool is_whole = std::all_of(fit.estimates.begin(), fit.estimates.end(),
                                    [](const Estimate& one) { return one.is_told() && !one.is_at_bound; });
  const std::vector<std::string> remarks = remarks_of(fit, specimens);
  report.conclude(is_whole ? reports::ReportVerdict::met : reports::ReportVerdict::missed, remarks.front(),
                  {remarks.begin() + 1, remarks.end()});
  report.add_table(estimate_table(fit));
  if (!fit.block)
    report.add_paragraph(
        "The rig is one contact site: an organ of this material is stiffer than it, because the tissue "
        "around carries too. ctpm fit scales an organ to it, or give the specimen's size.");
  if (!specimens.empty()) report.add_table(specimen_table(specimens, fit.estimates));
  if (!is_whole)
    report.add_paragraph("materials.json needs every modulus: what the data cannot tell follows there from " +
                         name.start_name + ".");
  for (const Match& match : fit.matches) report.add_plots(plots_of(match));
  report.add_table(correlation_table(fit));
  return reports::write_report(folder, {{"results.json", results_json(fit, specimens)},
                                        {scenes::kMaterialsFile, *materials},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::calibrate

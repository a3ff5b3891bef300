#include "tools/gp/gp_page.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include "models/gp/table.h"
#include "tools/gp/surface_picture.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using gp::Shape;
using report::Series;

std::string with_si(double value, const std::string& unit) {
  const report::Quantity q = report::engineering(value, unit);
  return q.unit.empty() ? q.value : q.value + " " + q.unit;
}

/// The unit of each hyper-parameter, in the order of gp::parameters_of().
std::vector<std::string> parameter_units(const LearnedModel& learned) {
  std::vector<std::string> units;
  for (const gp::Term& term : learned.model.kernel.terms) {
    units.push_back(learned.label_unit);
    for (size_t d = 0; d < 2; ++d)
      if (term.along[d].kind != Shape::Kind::constant)
        units.push_back(term.along[d].kind == Shape::Kind::periodic ? ""
                        : d == 0                                    ? learned.position_unit
                                                                    : learned.velocity_unit);
  }
  units.push_back(learned.label_unit);
  return units;
}

report::Table parameter_table(const LearnedModel& learned) {
  report::Table table{{"Hyper-parameter", "Value", "Prior median", "Prior, 95 %", "Allowed"}, {}, ""};
  const auto names = gp::parameter_names(learned.model.kernel);
  const auto values = gp::parameters_of(learned.model.kernel);
  const auto units = parameter_units(learned);
  for (size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> row{names[i], with_si(values[i], units[i])};
    if (i < learned.priors.size()) {
      const gp::Prior& p = learned.priors[i];
      const double wide = std::exp(1.96 * p.log_deviation);
      row.push_back(with_si(p.median, units[i]));
      row.push_back(with_si(p.median / wide, units[i]) + " to " + with_si(p.median * wide, units[i]));
      row.push_back(with_si(p.low, units[i]) + " to " + with_si(p.high, units[i]) +
                    (gp::is_at_limit(p, values[i]) ? ": at its limit" : ""));
    }
    table.rows.push_back(std::move(row));
  }
  table.caption = "Maximum a posteriori with log-normal priors. Lengths of periodic terms are plain numbers.";
  return table;
}

/// Characteristic length of the disturbance along the position: its period, or derived from a length scale.
double wave_length(const gp::Model& model) {
  double wave = 0;
  for (const gp::Term& term : model.kernel.terms) {
    const Shape& x = term.along[0];
    if (x.kind == Shape::Kind::periodic) return x.period;
    if (x.kind == Shape::Kind::squared_exponential) wave = std::max(wave, 5 * x.length);
  }
  return wave > 0 ? wave : model.trained[0].high - model.trained[0].low;
}

/// Range of the picture: a number of waves that can be distinguished, two of them outside the samples.
gp::Range pictured_positions(const gp::Model& model) {
  const gp::Range x = model.trained[0];
  const double wave = wave_length(model);
  return {x.low - 2 * wave, std::min(x.low + 6 * wave, x.high + 2 * wave)};
}

report::Plot slices(const LearnedModel& learned, const gp::Posterior& posterior, const gp::MeanTable& table) {
  const gp::Range v = learned.model.trained[1];
  const double from = learned.model.trained[0].low;
  const double to = std::min(learned.model.trained[0].high, from + 3 * wave_length(learned.model));
  report::Plot plot;
  plot.title = "Along the position, at three velocities";
  plot.x = {"Position", learned.position_unit, false};
  plot.y = {"Disturbance", learned.label_unit, false};
  for (double share : {0.0, 0.5, 1.0}) {
    const double at = v.low + share * (v.high - v.low);
    Series mean{fmt::format("{:.3g} m/s", at), {}, {}, Series::Shape::line};
    for (int i = 0; i <= 400; ++i) {
      const double x = from + (to - from) * i / 400;
      mean.x.push_back(x), mean.y.push_back(table({x, at}));
    }
    plot.series.push_back(std::move(mean));
    if (v.high <= v.low) break;
  }
  const double middle = 0.5 * (v.low + v.high),
               sd = std::sqrt(posterior.variance({0.5 * (from + to), middle}));
  plot.caption = fmt::format(
      "The posterior mean. Its own standard deviation in the middle is {}; beyond the trained "
      "velocities it grows.",
      with_si(sd, learned.label_unit));
  return plot;
}

report::Plot deviation_plot(const LearnedModel& learned, const gp::Posterior& posterior) {
  const gp::Range v = learned.model.trained[1];
  const double span = std::max(v.high - v.low, 0.1 * std::abs(v.high)),
               x = 0.5 * (learned.model.trained[0].low + learned.model.trained[0].high);
  report::Plot plot;
  plot.title = "How unsure the model is, over velocity";
  plot.x = {"Velocity", learned.velocity_unit, false};
  plot.y = {"Standard deviation", learned.label_unit, false};
  Series s{"of the disturbance", {}, {}, Series::Shape::line};
  for (int i = 0; i <= 200; ++i) {
    const double at = v.low - 0.5 * span + 2 * span * i / 200;
    s.x.push_back(at), s.y.push_back(std::sqrt(posterior.variance({x, at})));
  }
  plot.series.push_back(std::move(s));
  plot.caption = fmt::format("Trained from {:.3g} to {:.3g} m/s.", v.low, v.high);
  return plot;
}

report::Plot residual_plot(const LearnedModel& learned, const ShownSamples& shown, size_t input) {
  report::Plot plot;
  plot.title = input == 0 ? "Residuals over position" : "Residuals over velocity";
  plot.x = input == 0 ? report::Axis{"Position", learned.position_unit, false}
                      : report::Axis{"Velocity", learned.velocity_unit, false};
  plot.y = {"Label − prediction", learned.label_unit, false};
  Series s{"residual", {}, shown.score.residuals, Series::Shape::points};
  for (const gp::Point& p : shown.samples.inputs) s.x.push_back(p[input]);
  plot.series.push_back(std::move(s));
  return plot;
}

report::Table velocity_table(const LearnedModel& learned, const ShownSamples& shown) {
  struct Sums {
    size_t count = 0;
    double sum = 0, squares = 0;
  };
  std::map<double, Sums> by_velocity;
  for (size_t i = 0; i < shown.samples.labels.size() && by_velocity.size() <= gp::most_levels; ++i) {
    Sums& s = by_velocity[shown.samples.inputs[i][1]];
    ++s.count, s.sum += shown.score.residuals[i], s.squares += std::pow(shown.score.residuals[i], 2);
  }
  report::Table table{
      {"Velocity (m/s)", "Samples", "Residual, RMS", "Residual, mean"}, {}, "Residuals by velocity."};
  if (by_velocity.size() > gp::most_levels) return table;
  for (const auto& [v, s] : by_velocity)
    table.rows.push_back({fmt::format("{:.4g}", v), report::grouped(s.count),
                          with_si(std::sqrt(s.squares / double(s.count)), learned.label_unit),
                          with_si(s.sum / double(s.count), learned.label_unit)});
  return table;
}

report::Section score_section(const LearnedModel& learned, const ShownSamples& shown) {
  report::Section section{"Residuals: " + shown.title, {}};
  report::KeyNumbers numbers;
  const auto add = [&](std::string label, double value) {
    const report::Quantity q = report::engineering(value, learned.label_unit);
    numbers.numbers.push_back({std::move(label), q.value, q.unit, ""});
  };
  add("RMS", shown.score.rmse), add("Greatest", shown.score.greatest), add("Mean", shown.score.mean);
  add("Labels, standard deviation", shown.score.label_deviation);
  section.items.push_back(std::move(numbers));
  section.items.push_back(residual_plot(learned, shown, 0));
  section.items.push_back(residual_plot(learned, shown, 1));
  if (report::Table table = velocity_table(learned, shown); table.rows.size() > 1)
    section.items.push_back(std::move(table));
  return section;
}

report::KeyNumbers key_numbers(const LearnedModel& learned, const gp::MeanTable& table) {
  const std::string& unit = learned.label_unit;
  const auto number = [](std::string label, report::Quantity q, std::string note = "") {
    return report::KeyNumbers::Number{std::move(label), q.value, q.unit, std::move(note)};
  };
  return {{number("Noise", report::engineering(learned.model.kernel.noise, unit)),
           number("Residual, RMS", report::engineering(learned.residual_rms, unit)),
           {"Log evidence", fmt::format("{:.2f}", learned.log_evidence), "", ""},
           {"Samples", report::grouped(learned.sample_count), "", ""},
           number("Table error, at most", report::engineering(table.bound(), unit),
                  fmt::format("{} kB", (table.bytes() + 512) / 1024))}};
}

report::Paragraph slope_sentence(const LearnedModel& learned, const gp::Posterior& posterior) {
  const gp::SlopeBounds slope = gp::slope_bounds(posterior);
  const std::string unit = report::readable_unit(learned.label_unit);
  return {fmt::format(
      "At the trained velocities the mean stays within ±{:.4g} {} and its slopes within {:.4g} {} a "
      "metre and {:.4g} {} a metre per second: upper bounds, for proofs of stability.",
      slope.mean, unit, slope.by_position, unit, slope.by_velocity, unit)};
}

}  // namespace

std::string formula(const gp::Kernel& kernel) {
  static const char* const names[] = {"", "SE", "PE"};
  std::string text;
  for (const gp::Term& term : kernel.terms) {
    std::string product;
    for (size_t d = 0; d < 2; ++d)
      if (term.along[d].kind != Shape::Kind::constant)
        product += fmt::format("{}{}({})", product.empty() ? "" : "·", names[size_t(term.along[d].kind)],
                               d == 0 ? "x" : "v");
    text += (text.empty() ? "" : " + ") + (product.empty() ? "constant" : product);
  }
  return text;
}

report::Page model_page(const LearnedModel& learned, const std::vector<ShownSamples>& shown,
                        const std::vector<std::string>& notes) {
  const gp::Posterior posterior(learned.model);
  const gp::MeanTable table(posterior);
  report::Page page;
  page.title = learned.title.empty() ? "A learned disturbance" : learned.title;
  page.subtitle = "Gaussian process " + formula(learned.model.kernel);
  page.facts = {{"Samples", learned.data_hash},
                {"Recordings", fmt::format("{}", fmt::join(learned.files, ", "))}};
  for (const gp::Term& term : learned.model.kernel.terms)
    if (term.along[0].kind == Shape::Kind::periodic) {
      page.facts.push_back({"Period", with_si(term.along[0].period, learned.position_unit)});
      break;
    }
  page.facts.push_back({"Homing offset", with_si(learned.model.homing_offset, learned.position_unit)});
  page.facts.push_back({"Label lag", with_si(learned.model.label_lag, "s")});
  page.facts.push_back({"Label mean", with_si(learned.model.label_mean, learned.label_unit)});

  report::Section summary{"Summary", {}};
  for (const std::string& warning : learned.warnings)
    summary.items.push_back(report::Notice{report::Notice::Severity::warning, warning});
  summary.items.push_back(key_numbers(learned, table));
  summary.items.push_back(parameter_table(learned));
  for (const std::string& note : notes) summary.items.push_back(report::Paragraph{note});
  summary.items.push_back(slope_sentence(learned, posterior));
  page.sections.push_back(std::move(summary));

  report::Section surface{"The disturbance", {}};
  const gp::Samples& dots = learned.shown;
  report::Picture picture = surface_picture(
      table, dots, {pictured_positions(learned.model), learned.model.trained[1], learned.label_unit});
  picture.caption = "Posterior mean over a part of the stage; it begins two waves before the first sample.";
  if (!dots.labels.empty()) picture.caption += " Dots are samples.";
  surface.items.push_back(std::move(picture));
  surface.items.push_back(slices(learned, posterior, table));
  surface.items.push_back(deviation_plot(learned, posterior));
  page.sections.push_back(std::move(surface));
  for (const ShownSamples& s : shown) page.sections.push_back(score_section(learned, s));
  return page;
}

std::string model_summary(const LearnedModel& learned, const std::vector<ShownSamples>& shown) {
  std::string text =
      fmt::format("{}: {} from {} samples of {}\n", learned.title.empty() ? "model" : learned.title,
                  formula(learned.model.kernel), learned.sample_count, fmt::join(learned.files, ", "));
  const auto names = gp::parameter_names(learned.model.kernel);
  const auto values = gp::parameters_of(learned.model.kernel);
  const auto units = parameter_units(learned);
  text += fmt::format("  {:<28}{:>16}{:>16}   {}\n", "hyper-parameter", "value", "prior median", "allowed");
  for (size_t i = 0; i < names.size(); ++i) {
    text += fmt::format("  {:<28}{:>16}", names[i], with_si(values[i], units[i]));
    if (i < learned.priors.size()) {
      const gp::Prior& p = learned.priors[i];
      text += fmt::format("{:>16}   {} to {}{}", with_si(p.median, units[i]), with_si(p.low, units[i]),
                          with_si(p.high, units[i]), gp::is_at_limit(p, values[i]) ? "  AT ITS LIMIT" : "");
    }
    text += "\n";
  }
  const auto& [x, v] = learned.model.trained;
  text += fmt::format("  log evidence {:.3f}, residual {} rms, mean {}\n", learned.log_evidence,
                      with_si(learned.residual_rms, learned.label_unit),
                      with_si(learned.model.label_mean, learned.label_unit));
  text +=
      fmt::format("  trained at {:.1f} … {:.1f} mm, {:.4g} … {:.4g} m/s; homing offset {}, label lag {}\n",
                  1e3 * x.low, 1e3 * x.high, v.low, v.high, with_si(learned.model.homing_offset, "m"),
                  with_si(learned.model.label_lag, "s"));
  for (const ShownSamples& s : shown)
    text +=
        fmt::format("  {}: {} samples, error {} rms, {} greatest, {} mean\n", s.title,
                    s.samples.labels.size(), with_si(s.score.rmse, learned.label_unit),
                    with_si(s.score.greatest, learned.label_unit), with_si(s.score.mean, learned.label_unit));
  for (const std::string& warning : learned.warnings) text += "  warning: " + warning + "\n";
  return text;
}

std::string model_json(const LearnedModel& learned, const std::vector<ShownSamples>& shown) {
  const gp::SlopeBounds slope = gp::slope_bounds(gp::Posterior(learned.model));
  nlohmann::ordered_json json;
  json["title"] = learned.title;
  json["kernel"] = formula(learned.model.kernel);
  const auto names = gp::parameter_names(learned.model.kernel);
  const auto values = gp::parameters_of(learned.model.kernel);
  for (size_t i = 0; i < names.size(); ++i) json["hyper_parameters"][names[i]] = values[i];
  for (const gp::Term& term : learned.model.kernel.terms)
    if (term.along[0].kind == Shape::Kind::periodic) json["period"] = term.along[0].period;
  json["label_unit"] = learned.label_unit;
  json["label_mean"] = learned.model.label_mean;
  json["log_evidence"] = learned.log_evidence;
  json["residual_rms"] = learned.residual_rms;
  json["samples"] = learned.sample_count;
  json["data_hash"] = learned.data_hash;
  json["slope_bounds"] = {
      {"by_position", slope.by_position}, {"by_velocity", slope.by_velocity}, {"mean", slope.mean}};
  json["warnings"] = learned.warnings;
  for (const ShownSamples& s : shown)
    json["scores"][s.title] = {{"rmse", s.score.rmse},
                               {"mean", s.score.mean},
                               {"greatest", s.score.greatest},
                               {"samples", s.samples.labels.size()}};
  return json.dump(2) + "\n";
}

}  // namespace loopwright

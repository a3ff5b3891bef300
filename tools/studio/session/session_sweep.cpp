/// Two sliders at once: a figure of a signal over their ranges.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include "engine/diagram/in_memory.h"
#include "engine/json/reader.h"
#include "tools/studio/session/session.h"
#include "tools/studio/session/shell_command.h"

namespace loopwright::studio {
namespace {

struct SweptAxis {
  std::string set, unit;
  std::vector<double> values;

  std::pair<std::string, std::string> option(double value) const {
    return {set, unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, unit)};
  }
};

SweptAxis axis_of(const Value& request, std::string_view name) {
  const Value::Member* member = request.find(name);
  if (!member || member->value.kind != Value::Kind::object)
    throw Refused(fmt::format("the request lacks the axis \"{}\"", name));
  const Value& axis = member->value;
  const auto number = [&](std::string_view key) {
    const Value::Member* found = axis.find(key);
    if (!found || found->value.kind != Value::Kind::number)
      throw Refused(fmt::format("\"{}.{}\" is no number", name, key));
    return found->value.number;
  };
  constexpr int64_t most_points = 101;
  const int64_t points = std::clamp<int64_t>(optional_whole(axis, "points", 21), 2, most_points);
  SweptAxis result{required_text(axis, "set"), std::string(text_in(axis, "unit")), {}};
  const double low = number("low"), high = number("high");
  for (int64_t i = 0; i < points; ++i)
    result.values.push_back(low + (high - low) * double(i) / double(points - 1));
  return result;
}

/// A figure of a recorded signal, as `loopwright sweep` names it.
struct Measured {
  std::string kind, port;

  /// "rms(axis.position)". Throws Refused.
  explicit Measured(const std::string& metric) {
    static constexpr std::string_view kinds[] = {"rms", "mean", "maximum", "minimum", "peak", "final"};
    const size_t bracket = std::min(metric.find('('), metric.size());
    kind = metric.substr(0, bracket);
    if (std::ranges::find(kinds, kind) == std::end(kinds) || !metric.ends_with(')'))
      throw Refused(fmt::format("the metric of two sliders is {}(PORT); `loopwright sweep` has others",
                                fmt::join(kinds, ", ")));
    port = metric.substr(bracket + 1, metric.size() - bracket - 2);
  }

  double of(const std::vector<double>& values) const {
    if (values.empty()) return NAN;
    if (kind == "final") return values.back();
    if (kind == "mean") return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
    // The root mean square has the same bits as that of the signals of a run.
    const auto range = report::CurveSummary(values).range(values, 0, values.size());
    if (kind == "rms") return std::sqrt(range.sum_of_squares / double(values.size()));
    if (kind == "peak") return std::max(std::abs(range.lowest), std::abs(range.highest));
    return kind == "maximum" ? range.highest : range.lowest;
  }
};

/// The sweep as a file for `loopwright sweep`, relative to its own folder.
std::string sweep_text(const std::string& diagram, const LoadOptions& options,
                       std::span<const SweptAxis> axes, const Measured& measured) {
  Json set = Json::object(), swept = Json::object();
  for (const auto& [path, value] : options.set) set[path] = value;
  for (const SweptAxis& axis : axes) {
    swept[axis.set] = {
        {"linear",
         {{"from", axis.values.front()}, {"to", axis.values.back()}, {"count", axis.values.size()}}}};
    if (!axis.unit.empty()) swept[axis.set]["unit"] = axis.unit;
  }
  for (const auto& [block, variant] : options.variants) swept[block] = {{"variants", {variant}}};
  Json file{{"loopwright", 1}, {"diagram", diagram}};
  if (!set.empty()) file["set"] = std::move(set);
  file["axes"] = std::move(swept), file["metrics"] = {{measured.kind, {{measured.kind, measured.port}}}};
  return file.dump(2) + "\n";
}

}  // namespace

Json Session::sweep(const Request& request) {
  const auto file = source(request.required("path"));
  LoadOptions options = request.options();
  const SweptAxis x = axis_of(request.message, "x"), y = axis_of(request.message, "y");
  const std::string metric = request.required("metric");
  const Measured measured(metric);
  if (x.set == y.set) throw Refused(fmt::format("\"{}\" cannot be on both axes", x.set));
  // What an axis sweeps is not set besides.
  std::erase_if(options.set, [&](const auto& set) { return set.first == x.set || set.first == y.set; });
  return start(request, [=](Work& work) -> Json {
    Json rows = Json::array();
    std::string unit;
    size_t refused = 0;
    std::optional<Problems> first_problems;
    for (size_t j = 0; j < y.values.size(); ++j) {
      Json row = Json::array();
      for (size_t i = 0; i < x.values.size() && !work.job.is_cancelled(); ++i) {
        LoadOptions here = options;
        here.set.push_back(x.option(x.values[i])), here.set.push_back(y.option(y.values[j]));
        Problems problems;
        const auto diagram = load_diagram_text(file, here, problems);
        const auto plan = diagram ? compile(*diagram, problems) : nullptr;
        // Values that the diagram refuses are gaps; a mistake in the diagram itself refuses all of them.
        if (!plan) {
          ++refused;
          if (!first_problems) first_problems = std::move(problems);
          row.push_back(nullptr);
          continue;
        }
        RunOptions run_options;
        run_options.interrupt = &work.job.interrupt();
        const RunResult result = simulate(*plan, run_options);
        const Column* column = result.recording.find(measured.port);
        if (!column) throw Refused(fmt::format("\"{}\" is not recorded", measured.port));
        unit = column->unit == "1" ? "" : column->unit;
        row.push_back(result.status == RunStatus::finished ? Json(measured.of(column->values))
                                                           : Json(nullptr));
      }
      rows.push_back(std::move(row));
      work.progress("sweep", double(j + 1) / double(y.values.size()));
    }
    if (first_problems && refused == x.values.size() * y.values.size())
      throw InputError(std::move(*first_problems));
    return {
        {"x", x.values}, {"y", y.values}, {"values", std::move(rows)}, {"metric", metric}, {"unit", unit}};
  });
}

Json Session::write_sweep(const Request& request) {
  namespace fs = std::filesystem;
  const std::string path = request.required("path");
  LoadOptions options = request.options();
  const SweptAxis axes[] = {axis_of(request.message, "x"), axis_of(request.message, "y")};
  for (const SweptAxis& axis : axes)
    std::erase_if(options.set, [&](const auto& set) { return set.first == axis.set; });
  const std::string text =
      sweep_text(fs::path(path).filename().string(), options, axes, Measured(request.required("metric")));
  const std::string stem = (fs::path(path).parent_path() / fs::path(path).stem()).string();
  std::string file = stem + ".sweep.json";
  for (int i = 2;; ++i, file = fmt::format("{}_{}.sweep.json", stem, i - 1)) {
    const auto there = folder_.read(file);
    if (there && *there != text) continue;
    if (there || !folder_.replace(file, std::nullopt, text)) break;
  }
  const std::string target = folder_.path_of(file);
  return {{"file", file},
          {"command", fmt::format("loopwright sweep {} -o {}", shell_word(target),
                                  shell_word(target.substr(0, target.size() - 5)))}};
}

}  // namespace loopwright::studio

#include "tools/gp/training.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/block.h"
#include "engine/block/parameter_shape.h"
#include "tools/gp/training_shape.h"
#include "engine/json/edit.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/diagram/parameter_scope.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

// The file as self-describing structs, as for blocks: one list for reading, ranges, units and hints.

struct ColumnEntry {
  std::string column, unit;
  static constexpr auto describe() {
    using E = ColumnEntry;
    return fields(parameter(&E::column, "column", "", "Name of a column in the recordings"),
                  parameter(&E::unit, "unit", "", "Unit of the numbers; as the recording says when left out")
                      .optional());
  }
};
struct LabelEntry {
  std::vector<std::string> columns;
  std::string unit, command;
  double lag = 0, mass = 0, damping = 0, cutoff = 0, delay = 0;
  static constexpr auto describe() {
    using E = LabelEntry;
    return fields(
        parameter(&E::columns, "columns", "", "Columns with the disturbance; several are added up")
            .optional(),
        parameter(
            &E::command, "command", "",
            "Column with the command that was applied: the disturbance follows from it and the position")
            .optional(),
        parameter(&E::unit, "unit", "", "Unit of these columns; as the recording says when left out")
            .optional(),
        parameter(&E::lag, "lag", "s", "How late the columns are, as 2/cutoff for a second-order observer")
            .optional(),
        parameter(&E::mass, "mass", "", "Nominal mass, as the observer has it").not_negative().optional(),
        parameter(&E::damping, "damping", "", "Nominal damping").not_negative().optional(),
        parameter(&E::cutoff, "cutoff", "rad/s", "Of the zero-phase low pass").not_negative().optional(),
        parameter(&E::delay, "delay", "s", "From command to force, beyond the hold")
            .not_negative()
            .optional());
  }
};
struct ShapesEntry {
  gp::Shape::Kind position = gp::Shape::Kind::constant, velocity = gp::Shape::Kind::constant;
  static constexpr auto describe() {
    using E = ShapesEntry;
    return fields(parameter(&E::position, "position", "", "Kernel along the position").optional(),
                  parameter(&E::velocity, "velocity", "", "Kernel along the velocity").optional());
  }
};
struct PriorEntry {
  std::string parameter_name;
  double median = 0, log_deviation = 0, low = 0, high = 0;
  static constexpr auto describe() {
    using E = PriorEntry;
    return fields(
        parameter(&E::parameter_name, "parameter", "", "As in terms.0.position.length"),
        parameter(&E::median, "median", "", "Of the log-normal prior").not_negative().optional(),
        parameter(&E::log_deviation, "log_deviation", "", "Width of its logarithm").not_negative().optional(),
        parameter(&E::low, "low", "", "Lower limit").not_negative().optional(),
        parameter(&E::high, "high", "", "Upper limit").not_negative().optional());
  }
};
struct TrainingEntry {
  int version = 1;
  std::string schema, title, description, time;
  std::vector<std::string> recordings;
  ColumnEntry position, velocity;
  LabelEntry label;
  std::vector<double> velocities, window_centers;
  double velocity_tolerance = 0.05, settling = 0, window_length = 0, slowest = 0.01;
  VelocityPairing pairing = VelocityPairing::plateau;
  KernelChoice kernel = KernelChoice::ps;
  std::vector<ShapesEntry> terms;
  double period = 0, period_search = 0.05, homing_offset = 0;
  bool fit_period = false;
  int most_samples = 0;
  std::vector<PriorEntry> priors;
  static constexpr auto describe() {
    using E = TrainingEntry;
    return fields(
        parameter(&E::version, "loopwright", "", "Version of the format: 1").between(1, 1),
        parameter(&E::schema, "$schema", "", "For editors").optional(),
        parameter(&E::title, "title", "", "What is learned").optional(),
        parameter(&E::description, "description", "", "For readers").optional(),
        parameter(&E::recordings, "recordings", "", "CSV or MAT files, relative to this file").file(),
        parameter(&E::time, "time", "", "Column with the time in s; the first when left out").optional(),
        parameter(&E::position, "position", "", "Position of the moving part"),
        parameter(&E::velocity, "velocity", "",
                  "Velocity; from the position by a zero-phase filter when left out")
            .optional(),
        parameter(&E::label, "label", "", "Where the disturbance comes from"),
        parameter(&E::velocities, "velocities", "m/s", "Of the constant-velocity sections").optional(),
        parameter(&E::velocity_tolerance, "velocity_tolerance", "", "Share of the velocity")
            .between(0, 0.5)
            .optional(),
        parameter(&E::settling, "settling", "s", "Left out at both ends of a section")
            .not_negative()
            .optional(),
        parameter(&E::window_length, "window_length", "m", "About the middle of each section; 0: all of it")
            .not_negative()
            .optional(),
        parameter(&E::window_centers, "window_centers", "m", "One a velocity, in place of the middles")
            .optional(),
        parameter(&E::slowest, "slowest", "m/s", "Without velocities: slower samples are left out")
            .positive()
            .optional(),
        parameter(&E::pairing, "pair_with", "", "The velocity of the section or the measured one").optional(),
        parameter(&E::kernel, "kernel", "",
                  "ps: PE(x) + SE(v); ds: SE(x) + SE(v); product: PE(x) SE(v) + SE(v)")
            .optional(),
        parameter(&E::terms, "terms", "", "Of the kernel \"terms\"").optional(),
        parameter(&E::period, "period", "m", "Spatial period of the disturbance").not_negative().optional(),
        parameter(&E::fit_period, "fit_period", "", "Whether the period is fitted too").optional(),
        parameter(&E::period_search, "period_search", "", "Share of the period to either side")
            .between(0, 0.3)
            .optional(),
        parameter(&E::homing_offset, "homing_offset", "m", "Position reading at the model's origin")
            .optional(),
        parameter(&E::most_samples, "most_samples", "", "Evenly thinned beyond that; 0: all")
            .not_negative()
            .optional(),
        parameter(&E::priors, "priors", "", "In place of the default ones").optional());
  }
};

/// Numbers with a unit must have the unit of their setting.
template <class T> void check_units(const Value& value, std::string_view unit, const Reader& reader) {
  if constexpr (Described<T>) {
    for_each<T, is_parameter>([&](auto, const auto& p) {
      using Field = typename std::remove_cvref_t<decltype(p)>::Type;
      if (const Value::Member* member = value.find(p.name)) check_units<Field>(member->value, p.unit, reader);
    });
  } else if constexpr (List<T>) {
    for (const Value& item : value.items) check_units<typename T::value_type>(item, unit, reader);
  } else if (value.unit && !unit.empty()) {
    const auto wanted = parse_unit(unit);
    if (wanted && wanted->same_dimension(*value.unit)) return;
    auto& p = reader.error(value, "the number has another unit");
    p.expected = unit;
    p.found = shown_unit(value);
  }
}

/// The kernel needs information that only the user has; velocities and windows must match.
void check_rules(const TrainingEntry& e, const Value& file, const Reader& reader) {
  const auto at = [&](std::string_view key) -> const Value& {
    const Value::Member* member = file.find(key);
    return member ? member->value : file;
  };
  if (e.recordings.empty()) reader.error(at("recordings"), "there are no recordings to learn from");
  if (e.label.columns.empty() == e.label.command.empty()) {
    auto& p = reader.error(at("label"), "the disturbance comes either from columns or from the command");
    p.expected =
        "\"columns\": [\"observer.disturbance\"], or \"command\" with \"mass\", \"damping\" and \"cutoff\"";
  }
  if (!e.label.command.empty() && !(e.label.mass > 0 && e.label.cutoff > 0))
    reader.error(at("label"), "the disturbance from the command needs the nominal plant and a low pass")
        .expected = "\"mass\" and \"cutoff\" above zero, and \"damping\"";
  if (!e.label.command.empty() && e.label.lag != 0)
    reader.error(at("label"), "a disturbance from the command has no lag").hint = "leave \"lag\" out";
  const bool is_periodic = e.kernel == KernelChoice::ps || e.kernel == KernelChoice::product ||
                           e.fit_period || std::ranges::any_of(e.terms, [](const ShapesEntry& t) {
                             return t.position == gp::Shape::Kind::periodic;
                           });
  if (!(e.period > 0) && (is_periodic || e.kernel == KernelChoice::ds))
    reader.error(at("period"), "the period of the disturbance is missing").expected =
        "\"period\": {\"value\": 22.5, \"unit\": \"mm\"}, the pitch of the magnets";
  if ((e.kernel == KernelChoice::terms) == e.terms.empty())
    reader.error(at("kernel"), "\"terms\" belong to \"kernel\": \"terms\", and to no other").expected =
        "\"terms\": [{\"position\": \"periodic\"}, {\"velocity\": \"squared_exponential\"}]";
  for (const ShapesEntry& t : e.terms)
    if (t.velocity == gp::Shape::Kind::periodic)
      reader.error(at("terms"), "a disturbance is not periodic in the velocity");
  if (!e.window_centers.empty() && e.window_centers.size() != e.velocities.size()) {
    auto& p = reader.error(at("window_centers"), "there is not one center a velocity");
    p.expected = fmt::format("{} numbers", e.velocities.size());
    p.found = fmt::format("{}", e.window_centers.size());
  }
  if (std::ranges::find(e.velocities, 0.0) != e.velocities.end())
    reader.error(at("velocities"), "a velocity is zero: nothing moves there");
  const auto names = gp::parameter_names(kernel_of(Training{.kernel = e.kernel, .terms = {}}));
  if (e.kernel == KernelChoice::terms) return;
  for (const PriorEntry& prior : e.priors)
    if (std::ranges::find(names, prior.parameter_name) == names.end()) {
      auto& p =
          reader.error(at("priors"), fmt::format("the kernel has no parameter \"{}\"", prior.parameter_name));
      KnownNames(names).explain(p, prior.parameter_name);
    }
}

std::optional<Unit> unit_in(const Value& file, std::string_view object, std::string_view number) {
  const Value::Member* outer = file.find(object);
  const Value::Member* inner = outer ? outer->value.find(number) : nullptr;
  return inner && inner->value.unit ? std::optional<Unit>(*inner->value.unit) : std::nullopt;
}

Training training_of(const TrainingEntry& e) {
  Training t;
  t.title = e.title, t.recordings = e.recordings, t.time = e.time;
  t.position = {e.position.column, e.position.unit};
  t.velocity = {e.velocity.column, e.velocity.unit};
  t.label = {e.label.columns, e.label.unit,    e.label.command, e.label.lag,
             e.label.mass,    e.label.damping, e.label.cutoff,  e.label.delay};
  t.velocities = e.velocities, t.velocity_tolerance = e.velocity_tolerance, t.settling = e.settling;
  t.window_length = e.window_length, t.window_centers = e.window_centers, t.slowest = e.slowest;
  t.pairing = e.velocities.empty() ? VelocityPairing::measured : e.pairing;
  t.kernel = e.kernel;
  for (const ShapesEntry& s : e.terms)
    t.terms.push_back({1, {gp::Shape{s.position, 1, 0}, gp::Shape{s.velocity, 1, 0}}});
  t.period = e.period, t.fits_period = e.fit_period, t.period_search = e.period_search;
  t.homing_offset = e.homing_offset, t.most_samples = e.most_samples;
  for (const PriorEntry& p : e.priors)
    t.priors.push_back({p.parameter_name, p.median, p.log_deviation, p.low, p.high});
  return t;
}

}  // namespace

FileShape training_shape() { return shape_of(parameters_of<TrainingEntry>(), Writing::evaluated); }

gp::Kernel kernel_of(const Training& training) {
  using Kind = gp::Shape::Kind;
  const auto term = [](Kind position, Kind velocity) {
    return gp::Term{1, {gp::Shape{position, 1, 0}, gp::Shape{velocity, 1, 0}}};
  };
  gp::Kernel kernel;
  switch (training.kernel) {
    case KernelChoice::ps:
      kernel.terms = {term(Kind::periodic, Kind::constant), term(Kind::constant, Kind::squared_exponential)};
      break;
    case KernelChoice::ds:
      kernel.terms = {term(Kind::squared_exponential, Kind::constant),
                      term(Kind::constant, Kind::squared_exponential)};
      break;
    case KernelChoice::product:
      kernel.terms = {term(Kind::periodic, Kind::squared_exponential),
                      term(Kind::constant, Kind::squared_exponential)};
      break;
    case KernelChoice::terms:
      kernel.terms = training.terms;
      break;
  }
  for (gp::Term& t : kernel.terms)
    if (t.along[0].kind == Kind::periodic) t.along[0].period = training.period;
  return kernel;
}

std::shared_ptr<const Training> load_training(const std::string& path,
                                              const std::vector<std::pair<std::string, std::string>>& set,
                                              Problems& problems) {
  const auto source = read_source(path, {}, problems);
  if (!source) return nullptr;
  Value file = parse_json(source, problems);
  const Reader reader{problems, ""};
  if (problems.has_errors() ||
      !reader.expect(file, Value::Kind::object, "a training file", "an object in braces") ||
      !expect_kind(file, FileKind::training, problems))
    return nullptr;
  for (const auto& option : set)
    if (const auto edit = read_edit(option, problems)) apply_edit(*edit, file, reader);
  ParameterScope no_names("", problems);
  no_names.resolve();
  file = no_names.evaluate(file, "");
  if (problems.has_errors()) return nullptr;
  TrainingEntry entry;
  read_fields(entry, file, "", problems);
  check_units<TrainingEntry>(file, "", reader);
  if (problems.has_errors()) return nullptr;
  check_rules(entry, file, reader);
  if (problems.has_errors()) return nullptr;
  auto training = std::make_shared<Training>(training_of(entry));
  training->label.mass_unit = unit_in(file, "label", "mass");
  training->label.damping_unit = unit_in(file, "label", "damping");
  training->path = path;
  training->source = source;
  return training;
}

}  // namespace loopwright

#include "blocks/learning/model_file.h"
#include "blocks/learning/model_shape.h"
#include <fmt/format.h>
#include <cmath>
#include "engine/block.h"
#include "engine/block/parameter_shape.h"
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "engine/record/atomic_file.h"
#include "engine/file/hash.h"

namespace loopwright {
namespace {

// The file as structs. Their descriptions serve reading and writing.

struct ShapeEntry {
  gp::Shape::Kind kind = gp::Shape::Kind::constant;
  double length = 1, period = 0;
  static constexpr auto describe() {
    using E = ShapeEntry;
    return fields(parameter(&E::kind, "kind", "", "How covariance falls with distance"),
                  parameter(&E::length, "length", "", "Length scale; of a periodic kernel a plain number")
                      .positive()
                      .optional(),
                  parameter(&E::period, "period", "", "Of a periodic kernel").not_negative().optional());
  }
};
struct TermEntry {
  double deviation = 1;
  ShapeEntry position, velocity;
  static constexpr auto describe() {
    using E = TermEntry;
    return fields(parameter(&E::deviation, "deviation", "", "Standard deviation of the term").positive(),
                  parameter(&E::position, "position", "", "Along the position"),
                  parameter(&E::velocity, "velocity", "", "Along the velocity"));
  }
};
struct KernelEntry {
  std::vector<TermEntry> terms;
  double noise = 1;
  static constexpr auto describe() {
    using E = KernelEntry;
    return fields(parameter(&E::terms, "terms", "", "Terms of the sum"),
                  parameter(&E::noise, "noise", "", "Standard deviation of white noise").positive());
  }
};
struct PriorEntry {
  double median = 1, log_deviation = 1, low = 0, high = 0;
  static constexpr auto describe() {
    using E = PriorEntry;
    return fields(parameter(&E::median, "median", "", "Where the log-normal prior is centred").positive(),
                  parameter(&E::log_deviation, "log_deviation", "", "Width of its logarithm").positive(),
                  parameter(&E::low, "low", "", "Lower limit").positive(),
                  parameter(&E::high, "high", "", "Upper limit").positive());
  }
};
struct BasisEntry {
  gp::Basis::Kind kind = gp::Basis::Kind::constant;
  int size = 1;
  double period = 0, low = 0, high = 0;
  std::vector<double> levels;
  static constexpr auto describe() {
    using E = BasisEntry;
    return fields(parameter(&E::kind, "kind", "", "Kind of functions"),
                  parameter(&E::size, "size", "", "How many functions").between(1, 2 * gp::most_functions),
                  parameter(&E::period, "period", "", "Of a Fourier basis").not_negative().optional(),
                  parameter(&E::low, "low", "", "Least input").optional(),
                  parameter(&E::high, "high", "", "Greatest input").optional(),
                  parameter(&E::levels, "levels", "", "Distinct values, rising").optional());
  }
};
struct StatisticsEntry {
  int64_t count = 0;
  double label_square = 0;
  BasisEntry position, velocity;
  std::vector<double> moments, label_moments;
  static constexpr auto describe() {
    using E = StatisticsEntry;
    return fields(
        parameter(&E::count, "count", "", "Number of samples").not_negative(),
        parameter(&E::label_square, "label_square", "", "Sum of the squared labels")
            .not_negative()
            .optional(),
        parameter(&E::position, "position", "", "Functions of the position").optional(),
        parameter(&E::velocity, "velocity", "", "Functions of the velocity").optional(),
        parameter(&E::moments, "moments", "", "Sums of products of functions").optional(),
        parameter(&E::label_moments, "label_moments", "", "The same, weighted with labels").optional());
  }
};
struct SamplesEntry {
  std::vector<double> position, velocity, label;
  static constexpr auto describe() {
    using E = SamplesEntry;
    return fields(parameter(&E::position, "position", "", "Positions").optional(),
                  parameter(&E::velocity, "velocity", "", "Velocities").optional(),
                  parameter(&E::label, "label", "", "Labels").optional());
  }
};
struct UnitsEntry {
  std::string position, velocity, label;
  static constexpr auto describe() {
    using E = UnitsEntry;
    return fields(parameter(&E::position, "position", "", "Unit of positions"),
                  parameter(&E::velocity, "velocity", "", "Unit of velocities"),
                  parameter(&E::label, "label", "", "Unit of the disturbance"));
  }
};
struct RangeEntry {
  double low = 0, high = 0;
  static constexpr auto describe() {
    using E = RangeEntry;
    return fields(parameter(&E::low, "low", "", "Least"), parameter(&E::high, "high", "", "Greatest"));
  }
};
struct ModelEntry {
  int version = model_file_version;
  std::string checksum, title, data_hash;
  UnitsEntry units;
  std::vector<std::string> files, warnings;
  int64_t sample_count = 0;
  double label_mean = 0, homing_offset = 0, label_lag = 0, log_evidence = 0, residual_rms = 0;
  RangeEntry position, velocity;
  KernelEntry kernel;
  std::vector<PriorEntry> priors;
  StatisticsEntry statistics;
  SamplesEntry samples, shown;
  static constexpr auto describe() {
    using E = ModelEntry;
    return fields(
        parameter(&E::version, "loopwright_gp_model", "", "Version of this format"),
        parameter(&E::checksum, "checksum", "", "Over everything else"),
        parameter(&E::title, "title", "", "What was learned"), parameter(&E::units, "units", "", "Units"),
        parameter(&E::files, "files", "", "Recordings it was trained on"),
        parameter(&E::data_hash, "data_hash", "", "Hash of the samples"),
        parameter(&E::sample_count, "sample_count", "", "Number of samples").not_negative(),
        parameter(&E::homing_offset, "homing_offset", "", "Position reading at the model's origin"),
        parameter(&E::label_lag, "label_lag", "", "Labels were moved ahead by this, in s"),
        parameter(&E::label_mean, "label_mean", "", "Mean of the labels"),
        parameter(&E::position, "trained_position", "", "Positions of the samples"),
        parameter(&E::velocity, "trained_velocity", "", "Velocities of the samples"),
        parameter(&E::kernel, "kernel", "", "Kernel with its hyper-parameters"),
        parameter(&E::priors, "priors", "", "Of each hyper-parameter"),
        parameter(&E::log_evidence, "log_evidence", "", "Log marginal likelihood"),
        parameter(&E::residual_rms, "residual_rms", "", "Of the samples").not_negative(),
        parameter(&E::warnings, "warnings", "", "What training warned of"),
        parameter(&E::statistics, "statistics", "", "What the samples said, where the kernel has structure"),
        parameter(&E::samples, "samples", "", "The samples, where it has none"),
        parameter(&E::shown, "shown", "", "Some of the samples, for pictures"));
  }
};

template <class T> Value value_of(const T& x) {
  Value value;
  if constexpr (Described<T>) {
    value.kind = Value::Kind::object;
    for_each<T, is_parameter>([&](auto, const auto& p) {
      value.members.push_back({std::string(p.name), {}, value_of(x.*p.member)});
    });
  } else if constexpr (std::is_same_v<T, std::string>) {
    value.kind = Value::Kind::text;
    value.text = x;
  } else if constexpr (Choice<T>) {
    value.kind = Value::Kind::text;
    value.text = names_of(T{})[size_t(x)];
  } else if constexpr (List<T>) {
    value.kind = Value::Kind::list;
    for (const auto& item : x) value.items.push_back(value_of(item));
  } else {
    value.kind = Value::Kind::number;
    value.number = double(x);
  }
  return value;
}

std::string checksum_of(Value file) {
  std::erase_if(file.members,
                [](const Value::Member& m) { return m.name == "checksum" || m.name == "$schema"; });
  return content_hash(to_json(file));
}

// Conversion between entries and the model.

ShapeEntry entry_of(const gp::Shape& s) { return {s.kind, s.length, s.period}; }
gp::Shape shape_of(const ShapeEntry& e) { return {e.kind, e.length, e.period}; }
BasisEntry entry_of(const gp::Basis& b) { return {b.kind, b.size, b.period, b.low, b.high, b.levels}; }
gp::Basis basis_of(const BasisEntry& e) { return {e.kind, e.size, e.period, e.low, e.high, e.levels}; }

SamplesEntry entry_of(const gp::Samples& samples) {
  SamplesEntry entry;
  entry.label = samples.labels;
  for (const gp::Point& point : samples.inputs) {
    entry.position.push_back(point[0]);
    entry.velocity.push_back(point[1]);
  }
  return entry;
}
gp::Samples samples_of(const SamplesEntry& entry) {
  gp::Samples samples{{}, entry.label};
  for (size_t i = 0; i < entry.label.size(); ++i)
    samples.inputs.push_back({entry.position[i], entry.velocity[i]});
  return samples;
}

ModelEntry entry_of(const LearnedModel& learned) {
  const gp::Model& model = learned.model;
  ModelEntry e;
  e.title = learned.title, e.data_hash = learned.data_hash, e.files = learned.files;
  e.units = {learned.position_unit, learned.velocity_unit, learned.label_unit};
  e.sample_count = int64_t(learned.sample_count), e.warnings = learned.warnings;
  e.label_mean = model.label_mean, e.homing_offset = model.homing_offset, e.label_lag = model.label_lag;
  e.log_evidence = learned.log_evidence, e.residual_rms = learned.residual_rms;
  e.position = {model.trained[0].low, model.trained[0].high};
  e.velocity = {model.trained[1].low, model.trained[1].high};
  for (const gp::Term& t : model.kernel.terms)
    e.kernel.terms.push_back({t.deviation, entry_of(t.along[0]), entry_of(t.along[1])});
  e.kernel.noise = model.kernel.noise;
  for (const gp::Prior& p : learned.priors) e.priors.push_back({p.median, p.log_deviation, p.low, p.high});
  if (const auto* s = std::get_if<gp::Statistics>(&model.data))
    e.statistics = {int64_t(s->count),     s->label_square, entry_of(s->bases[0]),
                    entry_of(s->bases[1]), s->moments,      s->label_moments};
  else
    e.samples = entry_of(std::get<gp::Samples>(model.data));
  e.shown = entry_of(learned.shown);
  return e;
}

LearnedModel model_of(const ModelEntry& e) {
  LearnedModel learned;
  gp::Model& model = learned.model;
  learned.title = e.title, learned.data_hash = e.data_hash, learned.files = e.files;
  learned.position_unit = e.units.position, learned.velocity_unit = e.units.velocity;
  learned.label_unit = e.units.label;
  learned.sample_count = size_t(e.sample_count), learned.warnings = e.warnings;
  learned.log_evidence = e.log_evidence, learned.residual_rms = e.residual_rms;
  model.label_mean = e.label_mean, model.homing_offset = e.homing_offset, model.label_lag = e.label_lag;
  model.trained = {gp::Range{e.position.low, e.position.high}, gp::Range{e.velocity.low, e.velocity.high}};
  for (const TermEntry& t : e.kernel.terms)
    model.kernel.terms.push_back({t.deviation, {shape_of(t.position), shape_of(t.velocity)}});
  model.kernel.noise = e.kernel.noise;
  for (const PriorEntry& p : e.priors) learned.priors.push_back({p.median, p.log_deviation, p.low, p.high});
  if (e.statistics.count > 0)
    model.data = gp::Statistics{{basis_of(e.statistics.position), basis_of(e.statistics.velocity)},
                                size_t(e.statistics.count),
                                e.statistics.label_square,
                                e.statistics.moments,
                                e.statistics.label_moments};
  else
    model.data = samples_of(e.samples);
  learned.shown = samples_of(e.shown);
  return learned;
}

/// Checks that no single entry allows: that the lists fit each other. A file with a valid checksum fails here
/// only if a program wrote it incorrectly.
std::string contradiction(const ModelEntry& e) {
  const auto equally_long = [](const SamplesEntry& s) {
    return s.position.size() == s.label.size() && s.velocity.size() == s.label.size();
  };
  if (!equally_long(e.samples) || !equally_long(e.shown)) return "samples of different length";
  if (e.kernel.terms.empty()) return "a kernel without terms";
  const bool has_statistics = e.statistics.count > 0;
  if (has_statistics != e.samples.label.empty()) return "not one of statistics and samples";
  const BasisEntry* bases[] = {&e.statistics.position, &e.statistics.velocity};
  for (const TermEntry& t : e.kernel.terms) {
    const ShapeEntry* shapes[] = {&t.position, &t.velocity};
    for (size_t d = 0; d < 2; ++d) {
      const ShapeEntry& shape = *shapes[d];
      const bool is_periodic = shape.kind == gp::Shape::Kind::periodic;
      if (is_periodic && !(shape.period > 0)) return "a periodic kernel without period";
      if (!has_statistics || shape.kind == gp::Shape::Kind::constant) continue;
      const bool fits =
          is_periodic
              ? bases[d]->kind == gp::Basis::Kind::fourier && bases[d]->period == shape.period
              : bases[d]->kind == gp::Basis::Kind::levels || bases[d]->kind == gp::Basis::Kind::chebyshev;
      if (!fits) return "statistics for another kernel";
    }
  }
  if (!has_statistics) return "";
  size_t moments = 1, label_moments = 1;
  for (const BasisEntry* basis : bases) {
    const bool has_levels = basis->kind == gp::Basis::Kind::levels;
    if (basis->levels.size() != (has_levels ? size_t(basis->size) : 0)) return "a wrong number of levels";
    if (basis->kind == gp::Basis::Kind::fourier && basis->size % 2 == 0) return "half a harmonic";
    if (basis->kind == gp::Basis::Kind::chebyshev && !(basis->low < basis->high)) return "an empty interval";
    moments *= size_t(gp::moment_count(basis_of(*basis)));
    label_moments *= size_t(basis->size + (has_levels ? 1 : 0));
  }
  if (e.statistics.moments.size() != moments || e.statistics.label_moments.size() != label_moments)
    return "a wrong number of moments";
  return "";
}

/// Whether this is an unmodified model file of this version.
bool is_intact(const Value& file, const Reader& reader) {
  const Value::Member* version = file.find("loopwright_gp_model");
  if (!version || version->value.kind != Value::Kind::number) {
    auto& p = reader.error(file, "this is no model of a Gaussian process");
    p.expected = fmt::format("\"loopwright_gp_model\": {}", model_file_version);
    p.hint = "loopwright gp train writes model files";
    return false;
  }
  if (version->value.number != model_file_version) {
    auto& p = reader.error(*version, "this version of the model file is not known");
    p.expected = fmt::format("{}", model_file_version);
    p.found = fmt::format("{}", version->value.number);
    p.hint = "train the model again with this program";
    return false;
  }
  const Value::Member* checksum = file.find("checksum");
  const std::string expected = checksum_of(file);
  if (checksum && checksum->value.text == expected) return true;
  auto& p = checksum ? reader.error(*checksum, "the model file is damaged or was changed by hand")
                     : reader.error(file, "the model file has no checksum");
  p.expected = "\"" + expected + "\" for these contents";
  if (checksum) p.found = shown(checksum->value);
  p.hint = "train the model again: its numbers only make sense together";
  return false;
}

}  // namespace

FileShape model_shape() {
  FileShape shape = shape_of(parameters_of<ModelEntry>(), Writing::plain);
  shape.keys.push_back(
      shapes::optional("$schema", shapes::text(), "The JSON Schema of this file, for editors"));
  return shape;
}

LearnedModel read_model(const std::string& path, const Place& reference, Problems& problems) {
  auto source = read_source(path, reference, problems);
  return source ? read_model(std::move(source), problems) : LearnedModel{};
}

LearnedModel read_model(std::shared_ptr<const SourceFile> source, Problems& problems) {
  const size_t before = problems.list().size();
  const auto failed = [&] {
    for (size_t i = before; i < problems.list().size(); ++i)
      if (problems.list()[i].severity == Problem::Severity::error) return true;
    return false;
  };
  Value file = parse_json(std::move(source), problems);
  const Reader reader{problems, ""};
  if (failed() || !reader.expect(file, Value::Kind::object, "a model", "an object in braces") ||
      !expect_kind(file, FileKind::model, problems) || !is_intact(file, reader))
    return {};
  reader.text(file, "$schema");
  std::erase_if(file.members, [](const Value::Member& m) { return m.name == "$schema"; });
  ModelEntry entry;
  read_fields(entry, file, "", problems);
  if (failed()) return {};
  if (const std::string wrong = contradiction(entry); !wrong.empty()) {
    reader.error(file, "the model file contradicts itself").found = wrong;
    return {};
  }
  return model_of(entry);
}

void write_model(const std::string& path, const LearnedModel& model) {
  Value file = value_of(entry_of(model));
  for (Value::Member& member : file.members)
    if (member.name == "checksum") member.value.text = checksum_of(file);
  std::string text = "{\n";
  for (const Value::Member& member : file.members) {
    Value name;
    name.kind = Value::Kind::text;
    name.text = member.name;
    text += fmt::format("  {}: {}{}\n", to_json(name), to_json(member.value),
                        &member == &file.members.back() ? "" : ",");
  }
  write_file(path, text + "}\n");
}

}  // namespace loopwright

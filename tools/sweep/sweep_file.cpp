#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "engine/json/stated_number.h"
#include "engine/plan/plan.h"
#include "models/real/double_functions.h"
#include "tools/sweep/metric_reader.h"
#include "tools/sweep/sweep_shape.h"

namespace loopwright {
namespace {

/// Key by key: the permitted contents of a key and the message for invalid contents are in the same place.
class Loader {
 public:
  Loader(std::string path, Problems& problems) : problems_(problems), reader_{problems, ""} {
    sweep_->path = std::move(path);
  }

  std::shared_ptr<const Sweep> run() {
    const auto source = read_source(sweep_->path, {}, problems_);
    if (!source) return nullptr;
    sweep_->text = source->text;
    const Value file = parse_json(source, problems_);
    if (problems_.has_errors() ||
        !reader_.expect(file, Value::Kind::object, "a sweep", "an object in braces") ||
        !expect_kind(file, FileKind::sweep, problems_))
      return nullptr;
    reject_unknown(reader_, file, sweep_shape(), "a sweep");
    reader_.check_version(file);
    sweep_->title = reader_.text(file, "title");
    read_diagram(file);
    read_settings(file);
    if (const auto* seed = file.find("seed"))
      sweep_->seed = uint64_t(whole(*seed, 0, double(uint64_t(1) << 53)));
    read_axes(file);
    read_pairs(file);
    read_samples(file);
    sweep_->metrics = read_metrics(reader_, file);
    read_keep(file);
    check_size(file);
    if (!problems_.has_errors()) return sweep_;
    tell_problems_of_diagram();
    return nullptr;
  }

 private:
  // ---- pieces of JSON ----
  int64_t whole(const Value& value, const std::string& what, double low, double high) {
    const double n = reader_.number(value, what, low, high);
    if (n == std::floor(n)) return int64_t(n);
    reader_.error(value, fmt::format("{} is no whole number", what)).found = shown(value);
    return int64_t(low);
  }
  int64_t whole(const Value::Member& member, double low, double high) {
    return whole(member.value, fmt::format("\"{}\"", member.name), low, high);
  }
  const Value* object(const Value& in, std::string_view key, std::string_view expected) {
    const Value::Member* member = in.find(key);
    if (!member || !reader_.expect(member->value, Value::Kind::object, fmt::format("\"{}\"", key), expected))
      return nullptr;
    return &member->value;
  }

  // ---- what all runs share ----
  void read_diagram(const Value& file) {
    const Value::Member* diagram = file.find("diagram");
    const std::string name = reader_.text(file, "diagram");
    if (!diagram || name.empty()) {
      reader_.error(file, "the sweep names no diagram").expected = "\"diagram\": \"loop.json\"";
      return;
    }
    sweep_->diagram = resolve_relative(diagram->place, name);
  }
  /// For an unusable sweep the problems of its diagram are also reported: all problems at once.
  void tell_problems_of_diagram() {
    if (sweep_->diagram.empty()) return;
    Problems own;
    if (const auto diagram = load_diagram(sweep_->diagram, sweep_->options, own)) compile(*diagram, own);
    for (const Problem& problem : own.list())
      if (problem.severity == Problem::Severity::error) problems_.add(problem);
  }
  void read_settings(const Value& file) {
    if (const Value* set = object(file, "set", "an object: path → value"))
      for (const Value::Member& member : set->members)
        sweep_->options.set.emplace_back(
            member.name, member.value.kind == Value::Kind::text ? member.value.text : to_json(member.value));
    if (const Value* variants = object(file, "variants", "an object: block → name of its variant"))
      for (const Value::Member& member : variants->members)
        sweep_->options.variants[member.name] = reader_.text(*variants, member.name);
  }

  // ---- axes ----
  void read_axes(const Value& file) {
    const Value* axes = object(file, "axes", "an object: path → {\"values\": […]}");
    if (!axes) {
      if (!file.find("axes"))
        reader_.error(file, "the sweep has no axes").expected =
            "\"axes\": {\"stage.payload\": {\"values\": [0, 0.5], \"unit\": \"kg\"}}";
      return;
    }
    if (axes->members.empty()) reader_.error(*axes, "the sweep has no axes");
    for (const Value::Member& member : axes->members) read_axis(member);
  }
  void read_axis(const Value::Member& member) {
    Axis& axis = sweep_->axes.emplace_back();
    axis.name = member.name, axis.place = member.place, axis.pointer = member.value.place.pointer();
    const Value& body = member.value;
    if (!reader_.expect(body, Value::Kind::object, "an axis", "{\"values\": […]} or {\"uniform\": {…}}"))
      return;
    reject_unknown(reader_, body, axis_shape(), "an axis");
    if (body.find("unit") && reader_.unit(body.find("unit")->value)) axis.unit = reader_.text(body, "unit");
    const bool has_unit = !axis.unit.empty();
    if (!has_unit) axis.unit = unit_of_numbers(body);
    is_bare_allowed_ = has_unit || axis.unit.empty();
    int ways = 0;
    for (const Value::Member& way : body.members)
      if (way.name != "unit") ++ways, read_way(axis, way);
    if (ways == 1) return;
    auto& p = reader_.error(member, ways ? "an axis varies in one way only" : "the axis does not vary");
    p.expected =
        "one of \"values\", \"linear\", \"logarithmic\", \"uniform\", \"log_uniform\", \"normal\", "
        "\"variants\"";
  }
  /// The unit of the first number that states one: "values": ["5 um", "10 um"].
  static std::string unit_of_numbers(const Value& value) {
    if (value.find("value") && value.find("unit"))
      return value.find("unit")->value.kind == Value::Kind::text ? value.find("unit")->value.text : "";
    if (value.kind == Value::Kind::text)
      if (const auto stated = number_and_unit(value.text)) return stated->unit_text;
    std::string unit;
    for (size_t i = 0; i < value.items.size() && unit.empty(); ++i) unit = unit_of_numbers(value.items[i]);
    for (size_t i = 0; i < value.members.size() && unit.empty(); ++i)
      if (value.members[i].name != "variants") unit = unit_of_numbers(value.members[i].value);
    return unit;
  }
  /// In the unit of the axis.
  double number_of(const Axis& axis, const Value& value, std::string_view what, bool is_difference = false) {
    const auto stated = stated_number(value, what, reader_);
    const auto unit = parse_unit(axis.unit);
    if (!stated || !unit) return 0;
    if (!stated->unit && !is_bare_allowed_) {
      auto& p = reader_.error(value, fmt::format("{} has no unit, unlike other numbers of the axis", what));
      p.expected = fmt::format("a number with a unit, or \"unit\": \"{}\" for the axis", axis.unit);
    }
    return in_unit(*stated, *unit, what, reader_, is_difference).value_or(0);
  }
  void read_way(Axis& axis, const Value::Member& way) {
    if (way.name == "values") return read_values(axis, way.value);
    if (way.name == "variants") return read_variants(axis, way.value);
    const std::string expected = way.name == "normal"            ? "{\"mean\": …, \"deviation\": …}"
                                 : way.name.ends_with("uniform") ? "{\"from\": …, \"to\": …}"
                                                                 : "{\"from\": …, \"to\": …, \"count\": …}";
    if (!reader_.expect(way.value, Value::Kind::object, fmt::format("\"{}\"", way.name), expected)) return;
    if (way.name == "normal") {
      reject_unknown(reader_, way.value, normal_shape(), "\"normal\"");
      axis.kind = Axis::Kind::normal;
      axis.low = required(axis, way.value, "mean", expected);
      axis.high = required(axis, way.value, "deviation", expected);
      if (axis.high <= 0) reader_.error(way.value, "the standard deviation must be above zero");
      return;
    }
    const bool is_logarithmic = way.name.starts_with("log"), is_sampled = way.name.ends_with("uniform");
    reject_unknown(reader_, way.value, is_sampled ? distribution_shape() : grid_shape(),
                   fmt::format("\"{}\"", way.name));
    const double from = required(axis, way.value, "from", expected),
                 to = required(axis, way.value, "to", expected);
    if (is_logarithmic && (from <= 0 || to <= 0))
      reader_.error(way.value, "a logarithmic axis lies above zero");
    if (is_sampled) {
      if (!(from < to)) reader_.error(way.value, "\"from\" must lie below \"to\"");
      axis.kind = is_logarithmic ? Axis::Kind::logarithmic : Axis::Kind::uniform;
      axis.low = from, axis.high = to;
    } else {
      fill(axis, way.value, from, to, is_logarithmic);
    }
  }
  double required(const Axis& axis, const Value& object, std::string_view key, const std::string& expected) {
    if (const Value::Member* member = object.find(key))
      return number_of(axis, member->value, fmt::format("\"{}\"", key), key == "deviation");
    reader_.error(object, fmt::format("\"{}\" is missing", key)).expected = expected;
    return 1;
  }
  void fill(Axis& axis, const Value& range, double from, double to, bool is_logarithmic) {
    const Value::Member* member = range.find("count");
    if (!member) {
      reader_.error(range, "\"count\" is missing").expected = "how many values, 2 or more";
      return;
    }
    const int64_t count = whole(*member, 2, 1e6);
    for (int64_t i = 0; i < count && !problems_.has_errors(); ++i) {
      const double share = double(i) / double(count - 1);
      const double value = is_logarithmic ? from * any_power(to / from, share) : from + (to - from) * share;
      axis.values.push_back(i == count - 1 ? to : value);
    }
  }
  void read_values(Axis& axis, const Value& list) {
    if (!reader_.expect(list, Value::Kind::list, "\"values\"", "a list of numbers")) return;
    for (const Value& item : list.items) axis.values.push_back(number_of(axis, item, "a value"));
    if (list.items.empty()) reader_.error(list, "the list of values is empty");
  }
  void read_variants(Axis& axis, const Value& list) {
    axis.kind = Axis::Kind::variants;
    if (!reader_.expect(list, Value::Kind::list, "\"variants\"", "a list of names")) return;
    for (const Value& item : list.items)
      if (reader_.expect(item, Value::Kind::text, "a variant", "a name in quotes"))
        axis.variants.push_back(item.text);
    if (list.items.empty()) reader_.error(list, "the list of variants is empty");
  }

  void read_pairs(const Value& file) {
    const Value::Member* paired = file.find("paired");
    if (!paired || !reader_.expect(paired->value, Value::Kind::list, "\"paired\"", "a list of lists of axes"))
      return;
    for (const Value& group : paired->value.items) {
      if (!reader_.expect(group, Value::Kind::list, "a pair", "a list of axes, as in [\"a.x\", \"b.y\"]"))
        continue;
      int first = -1;
      for (const Value& item : group.items) {
        const int axis = axis_of(item);
        if (axis < 0) continue;
        if (first < 0)
          first = axis;
        else
          pair(item, first, axis);
      }
    }
  }
  int axis_of(const Value& name) {
    if (!reader_.expect(name, Value::Kind::text, "an axis", "its name in quotes")) return -1;
    KnownNames known;
    for (size_t i = 0; i < sweep_->axes.size(); ++i) {
      if (sweep_->axes[i].name == name.text) return int(i);
      known.add(sweep_->axes[i].name);
    }
    known.explain(reader_.error(name, fmt::format("there is no axis \"{}\"", name.text)), name.text);
    return -1;
  }
  void pair(const Value& at, int first, int second) {
    Axis &a = sweep_->axes[size_t(std::min(first, second))],
         &b = sweep_->axes[size_t(std::max(first, second))];
    if (a.is_sampled() || b.is_sampled()) {
      reader_.error(at, "sampled axes cannot be paired").hint = "give both a list of values";
    } else if (a.pair >= 0 || b.pair >= 0 || first == second) {
      reader_.error(at, fmt::format("\"{}\" is paired twice", at.text));
    } else if (a.count() != b.count()) {
      auto& p = reader_.error(at, "paired axes must have as many values each");
      p.found = fmt::format("{} values of \"{}\", {} of \"{}\"", a.count(), a.name, b.count(), b.name);
    } else {
      b.pair = std::min(first, second);
    }
  }

  void read_samples(const Value& file) {
    bool is_sampled = false;
    for (const Axis& axis : sweep_->axes) is_sampled |= axis.is_sampled();
    const Value* samples = object(file, "samples", "{\"method\": \"sobol\", \"count\": 1024}");
    if (!samples) {
      if (is_sampled && !file.find("samples"))
        reader_.error(file, "axes with a distribution need to know how many samples").expected =
            "\"samples\": {\"method\": \"sobol\", \"count\": 1024}";
      return;
    }
    reject_unknown(reader_, *samples, samples_shape(), "\"samples\"");
    if (!is_sampled)
      reader_.error(*samples, "no axis is sampled").hint = "\"uniform\", \"log_uniform\" and \"normal\" are";
    if (const auto* count = samples->find("count"))
      sweep_->samples.count = whole(*count, 1, most_runs);
    else
      reader_.error(*samples, "\"count\" is missing").expected = "how many samples";
    if (const auto* method = samples->find("method")) {
      const std::string name = reader_.text(*samples, "method");
      if (name == "random")
        sweep_->samples.method = Sampling::random;
      else if (name == "latin_hypercube")
        sweep_->samples.method = Sampling::latin_hypercube;
      else if (name == "saltelli")
        sweep_->samples.method = Sampling::saltelli;
      else if (name != "sobol") {
        auto& p = reader_.error(*method, fmt::format("there is no sampling \"{}\"", name));
        KnownNames({"random", "latin_hypercube", "sobol", "saltelli"}).explain(p, name);
      }
    }
  }

  void read_keep(const Value& file) {
    const Value::Member* member = file.find("keep");
    if (!member) return;
    Keep& keep = sweep_->keep;
    keep.place = member->place, keep.pointer = member->value.place.pointer();
    const std::string expected =
        "\"all\", \"failed\", {\"worst\": 5, \"of\": \"tracking\"} or {\"runs\": [0, 7]}";
    const Value& value = member->value;
    if (value.kind == Value::Kind::text && (value.text == "all" || value.text == "failed")) {
      keep.kind = value.text == "all" ? Keep::Kind::all : Keep::Kind::failed;
    } else if (value.kind == Value::Kind::object && value.find("worst")) {
      reject_unknown(reader_, value, worst_shape(), "\"keep\"");
      keep.kind = Keep::Kind::worst;
      keep.count = int(whole(*value.find("worst"), 1, 1e4));
      keep.metric = reader_.text(value, "of");
      KnownNames known;
      bool found = false;
      for (const Metric& metric : sweep_->metrics)
        found |= metric.name == keep.metric, known.add(metric.name);
      if (!found)
        known.explain(reader_.error(value, fmt::format("there is no metric \"{}\"", keep.metric)),
                      keep.metric);
    } else if (value.kind == Value::Kind::object && value.find("runs")) {
      reject_unknown(reader_, value, selected_shape(), "\"keep\"");
      keep.kind = Keep::Kind::selected;
      const Value& runs = value.find("runs")->value;
      if (reader_.expect(runs, Value::Kind::list, "\"runs\"", "a list of run numbers"))
        for (const Value& item : runs.items)
          keep.runs.push_back(whole(item, "the number of a run", 0, most_runs));
    } else {
      auto& p = reader_.error(value, "what shall be kept is not known");
      p.expected = expected, p.found = shown(value);
    }
  }

  void check_size(const Value& file) {
    double runs = double(sweep_->samples.count), sampled = 0;
    for (const Axis& axis : sweep_->axes) {
      if (axis.is_sampled()) sampled += 1;
      if (!axis.is_sampled() && axis.pair < 0) runs *= double(axis.count());
    }
    if (sweep_->samples.method == Sampling::saltelli) runs *= sampled + 2;
    if (runs > most_runs)
      reader_.error(file, fmt::format("the sweep has {:.3g} runs", runs)).expected =
          fmt::format("at most {:g}", most_runs);
  }

  Problems& problems_;
  Reader reader_;
  std::shared_ptr<Sweep> sweep_ = std::make_shared<Sweep>();
  bool is_bare_allowed_ = true;  // a number without a unit, on the axis that is being read
};

}  // namespace

std::shared_ptr<const Sweep> load_sweep(const std::string& path, Problems& problems) {
  return Loader(path, problems).run();
}

}  // namespace loopwright

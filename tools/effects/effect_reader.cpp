#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "engine/diagram/wires.h"
#include "tools/effects/bound.h"
#include "tools/effects/effect.h"
#include "tools/effects/effect_shape.h"
#include "tools/effects/member_reader.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;
using Kind = Value::Kind;

/// Reads one form of an effect file: the members of the file, overridden by those of the form.
class FormReader {
 public:
  FormReader(const Value& file, const Value* form, Problems& problems)
      : file_(file), form_(form), read_{{problems, ""}}, reader_(read_.reader) {}

  Effect read() {
    read_words();
    if (const Value* list = object("parameters", "parameters by name"))
      for (const Value::Member& member : list->members) read_parameter(member);
    read_blocks();
    read_attachments();
    if (const Value* needs = object("needs", "what a record must contain, with a \"text\""))
      effect_.needs = read_needs(*needs, read_);
    if (const Value::Member* others = member("confusable"))
      effect_.confusable = read_confusable(others->value, read_);
    return std::move(effect_);
  }

 private:
  const Value::Member* member(std::string_view key) const {
    if (const Value::Member* own = form_ ? form_->find(key) : nullptr) return own;
    return file_.find(key);
  }
  const Value* object(std::string_view key, std::string_view expected) {
    const Value::Member* found = member(key);
    if (!found) {
      reader_.error(file_, fmt::format("the effect has no \"{}\"", key)).expected = expected;
      return nullptr;
    }
    const bool fits = reader_.expect(found->value, Kind::object, fmt::format("\"{}\"", key),
                                     fmt::format("an object of {}", expected));
    return fits ? &found->value : nullptr;
  }
  void read_words() {
    effect_.name = read_.text(file_, "effect", "the file");
    effect_.title = read_.text(file_, "title", "the effect");
    if (const auto* words = member("physics"))
      effect_.physics = reader_.text(form_ && form_->find("physics") ? *form_ : file_, words->name);
    else
      read_.text(file_, "physics", "the effect");
    if (const auto* list = member("equivalents"))
      effect_.equivalents = read_.texts(list->value, "\"equivalents\"");
    effect_.is_repeatable = read_.flag(file_, "repeatable");
    if (const Value& owner = form_ && form_->find("at_rest") ? *form_ : file_; owner.find("at_rest"))
      read_.word(owner, "at_rest", "the effect", "an axis at rest is not so",
                 {{"free", AtRest::free}, {"holds", AtRest::holds}, {"gives", AtRest::gives}},
                 effect_.at_rest);
  }

  // ---- Parameters ----

  void read_parameter(const Value::Member& member) {
    if (!reader_.check_name(member, "a parameter") ||
        !reader_.expect(member.value, Kind::object, "a parameter", "{\"unit\": …, \"range\": …}"))
      return;
    const Value& body = member.value;
    reject_unknown(reader_, body, shapes::either({fitted_parameter_shape(), given_parameter_shape()}),
                   "a parameter of an effect");
    EffectParameter parameter;
    parameter.name = member.name, parameter.place = member.place;
    parameter.description = reader_.text(body, "description");
    parameter.unit = reader_.text(body, "unit");
    parameter.is_linear = read_.flag(body, "linear"), parameter.is_period = read_.flag(body, "period");
    const Value::Member* value = body.find("value");
    parameter.is_fitted = !value;
    if (value)
      read_given(*value, body, parameter);
    else
      read_fit(body, parameter);
    if (std::ranges::any_of(record_sizes, [&](const NamedSize& s) { return s.name == member.name; }))
      reader_.error(member, fmt::format("\"{}\" is the name of a size of the record", member.name));
    effect_.parameters.push_back(std::move(parameter));
  }
  void read_given(const Value::Member& value, const Value& body, EffectParameter& parameter) {
    if (read_.expect_computed(value.value, "\"value\"")) parameter.value = value.value;
    reject_fit_keys(body);
    read_plausible_range(body, parameter);
  }
  void reject_fit_keys(const Value& body) {
    for (const char* key : {"start", "scale", "points", "linear", "period"})
      if (const auto* misplaced = body.find(key))
        reader_.error(*misplaced, fmt::format("\"{}\" is of no use: a \"value\" is given", key)).hint =
            "leave out \"value\" for a parameter that is to be fitted";
  }
  /// Over quantities and other parameters, as its value.
  void read_plausible_range(const Value& body, EffectParameter& parameter) {
    const Value::Member* range = body.find("range");
    if (!range ||
        !reader_.expect(range->value, Kind::list, "\"range\"", "a list of lowest and highest value"))
      return;
    if (range->value.items.size() != 2) {
      reader_.error(*range, "a range has two ends").found = shown(range->value);
      return;
    }
    for (const Value& end : range->value.items)
      if (!read_.expect_computed(end, "an end of the range")) return;
    parameter.low = range->value.items[0], parameter.high = range->value.items[1];
    parameter.is_bounded = true;
  }
  void read_fit(const Value& body, EffectParameter& parameter) {
    const Value::Member* range = body.find("range");
    if (!range) {
      reader_
          .error(body,
                 fmt::format("the parameter \"{}\" has neither \"range\" nor \"value\"", parameter.name))
          .expected = "\"range\": [0, \"=3*force_level\"], or a \"value\" that is not fitted";
      return;
    }
    if (!reader_.expect(range->value, Kind::list, "\"range\"", "a list of lowest and highest value")) return;
    if (range->value.items.size() != 2) {
      reader_.error(*range, "a range has two ends").found = shown(range->value);
      return;
    }
    parameter.low = range->value.items[0], parameter.high = range->value.items[1];
    const Value::Member* start = body.find("start");
    if (start)
      parameter.start = start->value;
    else
      reader_.error(body, fmt::format("the parameter \"{}\" has no \"start\"", parameter.name)).expected =
          "\"start\": a number or an expression within the range";
    if (const Value::Member* scale = body.find("scale")) parameter.scale = read_scale(*scale);
    if (const Value::Member* points = body.find("points")) parameter.points = read_points(*points);
    const size_t problems_before = reader_.problems.list().size();
    const double low = example_of_bound(parameter.low, parameter.unit, reader_),
                 high = example_of_bound(parameter.high, parameter.unit, reader_),
                 first = start ? example_of_bound(parameter.start, parameter.unit, reader_) : low;
    if (reader_.problems.list().size() != problems_before) return;
    if (!(low < high))
      reader_.error(*range, "the range is empty").found = shown(range->value);
    else if (start && (first < low || first > high))
      reader_.error(*start, "the start is outside the range").found = shown(start->value);
    if (parameter.scale != EffectParameter::Scale::linear && low <= 0)
      reader_.error(*range, "only a range above 0 can have this scale").found = shown(range->value);
  }
  int read_points(const Value::Member& member) {
    const double points = member.value.kind == Kind::number ? member.value.number : 0;
    if (points >= 1 && points <= 200 && points == std::floor(points)) return int(points);
    reader_.error(member, "\"points\" says on how many values of the range a search looks first").expected =
        "a whole number from 1 to 200";
    return 0;
  }
  EffectParameter::Scale read_scale(const Value::Member& member) {
    using Scale = EffectParameter::Scale;
    const std::string name = member.value.text;
    const std::vector<std::pair<std::string, Scale>> known = {
        {"linear", Scale::linear}, {"logarithmic", Scale::logarithmic}, {"reciprocal", Scale::reciprocal}};
    for (const auto& [text, scale] : known)
      if (name == text) return scale;
    KnownNames({"linear", "logarithmic", "reciprocal"})
        .explain(reader_.error(member, "there is no such scale"), name);
    return Scale::linear;
  }

  // ---- Blocks and where they act ----

  void read_blocks() {
    const Value* blocks = object("blocks", "blocks, as in a diagram");
    if (!blocks) return;
    effect_.blocks = *blocks;
    std::set<std::string> reads;
    for (const Value::Member& block : blocks->members)
      if (const auto* in = block.value.find("in"))
        for (const PortWires& port : read_inputs(in->value, reader_))
          for (const Wire& wire : port.wires)
            if (wire.source.find('.') == std::string::npos && is_role(wire)) reads.insert(wire.source);
    for (const std::string& role : effect_roles)
      if (reads.contains(role)) effect_.reads.push_back(role);
  }
  bool is_role(const Wire& wire) {
    if (std::ranges::find(effect_roles, wire.source) != effect_roles.end()) return true;
    auto& p = reader_.problems.error(wire.place, wire.place.pointer(), "",
                                     fmt::format("there is no signal \"{}\" to read", wire.source));
    KnownNames(effect_roles).explain(p, wire.source);
    return false;
  }

  void read_attachments() {
    const Value::Member* list = member("attach");
    if (!list) {
      reader_.error(file_, "the effect does not say where it acts").expected =
          "\"attach\": [{\"to\": \"force\", \"from\": \"block.output\"}]";
      return;
    }
    if (!reader_.expect(list->value, Kind::list, "\"attach\"", "a list of objects")) return;
    for (const Value& item : list->value.items)
      if (reader_.expect(item, Kind::object, "an attachment", "{\"to\": …, \"from\": …}"))
        read_attachment(item);
    if (list->value.items.empty()) reader_.error(*list, "the effect acts nowhere");
  }
  void read_attachment(const Value& item) {
    using To = Attachment::To;
    using Stage = Attachment::Stage;
    Attachment attachment;
    attachment.place = item.place;
    attachment.from = read_.text(item, "from", "the attachment");
    const bool is_known = read_.word(
        item, "to", "the attachment", "an effect cannot be attached there",
        {{"force", To::force}, {"input", To::input}, {"sensor", To::sensor}, {"parameter", To::parameter}},
        attachment.to);
    const bool is_to_parameter = attachment.to == To::parameter;
    reject_unknown(
        reader_, item,
        !is_known         ? shapes::either({signal_attachment_shape(), parameter_attachment_shape()})
        : is_to_parameter ? parameter_attachment_shape()
                          : signal_attachment_shape(),
        is_known ? fmt::format("an attachment to the {}", item.find("to")->value.text) : "an attachment");
    if (!is_known) return;
    if (item.find("stage"))
      read_.word(item, "stage", "the attachment", "the way of the input has no such stage",
                 {{"command", Stage::command},
                  {"amplifier", Stage::amplifier},
                  {"iron", Stage::iron},
                  {"magnets", Stage::magnets}},
                 attachment.stage);
    check_source(item, "from", attachment.from);
    if (item.find("slope")) {
      attachment.slope = read_.text(item, "slope", "the attachment");
      check_source(item, "slope", attachment.slope);
    }
    if (is_to_parameter) {
      if (const auto* targets = item.find("parameter"))
        attachment.targets = read_.texts(targets->value, "\"parameter\"");
      if (attachment.targets.empty())
        reader_.error(item, "the attachment names no parameter").expected = "\"parameter\": [\"Mass.mass\"]";
      const auto* add = item.find("add");
      if (add && read_.expect_computed(add->value, "\"add\""))
        attachment.add = add->value;
      else if (!add)
        reader_.error(item, "the attachment does not say what to add").expected = "\"add\": \"=mass\"";
      attachment.is_optional = read_.flag(item, "optional");
    }
    effect_.attachments.push_back(std::move(attachment));
  }
  void check_source(const Value& item, const char* key, const std::string& from) {
    const std::vector<std::string> path = split_path(from);
    if (path.size() == 2 && effect_.blocks.find(path[0])) return;
    const Value::Member* member = item.find(key);
    if (!member) return;
    KnownNames names;
    for (const Value::Member& block : effect_.blocks.members) names.add(block.name);
    names.explain(reader_.error(*member, fmt::format("\"{}\" is no output of the effect's blocks", from)),
                  path.empty() ? from : path[0]);
  }

  const Value& file_;
  const Value* form_;
  MemberReader read_;
  const Reader& reader_;
  Effect effect_;
};

}  // namespace

std::vector<Effect> load_effect(const std::string& path, Problems& problems) {
  Problems own;
  std::vector<Effect> effects;
  const auto source = read_source(path, {}, own);
  const Value file = source ? parse_json(source, own) : Value{};
  const Reader reader{own, ""};
  if (!own.has_errors() && reader.expect(file, Kind::object, "an effect", "an object in braces") &&
      expect_kind(file, FileKind::effect, own) && !file.find("site")) {
    reject_unknown(reader, file, effect_shape(), "an effect");
    reader.check_version(file);
    const Value::Member* forms = file.find("forms");
    if (!forms)
      effects.push_back(FormReader(file, nullptr, own).read());
    else if (forms->value.kind == Kind::object && forms->value.members.empty())
      reader.error(*forms, "the effect has no form").expected = "a form, or no \"forms\"";
    else if (reader.expect(forms->value, Kind::object, "\"forms\"", "an object: name → what differs"))
      for (const Value::Member& form : forms->value.members) {
        if (!reader.expect(form.value, Kind::object, "a form", "an object")) continue;
        reject_unknown(reader, form.value, effect_form_shape(), "a form of an effect");
        effects.push_back(FormReader(file, &form.value, own).read());
        effects.back().form = form.name;
      }
    for (Effect& effect : effects) {
      effect.path = path;
      if (!effect.name.empty() && fs::path(path).stem() != effect.name)
        reader.error(file, fmt::format("the effect \"{}\" stands in a file of another name", effect.name))
            .expected = effect.name + ".json";
    }
  }
  for (const Problem& problem : own.list()) problems.add(problem);
  if (own.has_errors()) effects.clear();
  return effects;
}

}  // namespace loopwright

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include "engine/json/reader.h"
#include "tools/fit/parameter.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/machine_picture.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/setting_text.h"
#include "tools/studio/session/shown_level.h"
#include "engine/plan/gates.h"
#include "tools/studio/session/written_wires.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

class View {
 public:
  View(const CheckedText& text, ShownLevel shown, const Variants& variants, const Layout& layout)
      : text_(text),
        shown_(std::move(shown)),
        variants_(variants),
        layout_(layout),
        places_(shown_.owner->file->text) {
    if (plan())
      for (const Plan::Logged& logged : plan()->log)
        logged_.insert(logged.name.substr(0, logged.name.find('[')));
    find_rates();
    find_problems();
  }

  Json json() {
    const Value& d = *shown_.diagram;
    Json view{{"inside", shown_.inside},      {"editable", shown_.is_editable},
              {"title", text_in(d, "title")}, {"description", text_in(d, "description")},
              {"levels", shown_.levels},      {"blocks", Json::array()},
              {"wires", Json::array()},       {"inputs", Json::array()},
              {"outputs", Json::array()},     {"parameters", Json::array()},
              {"solver", Json::array()},      {"log", Json::array()},
              {"places", Json::array()}};
    const Level level{&d, shown_.inside};
    sources_ = sources_by_block(level);
    for (const Value::Member& block : level.blocks().members) {
      view["blocks"].push_back(this->block(block));
      view["places"].push_back({places_.units(block.place.offset), places_.units(end_of(block.value))});
      add_wires(block, view["wires"]);
    }
    add_ports(d, view);
    if (const Value::Member* list = d.find("parameters"))
      for (const Value::Member& parameter : list->value.members)
        view["parameters"].push_back(this->parameter(parameter));
    if (const Value::Member* solver = d.find("solver"))
      for (const Value::Member& member : solver->value.members)
        view["solver"].push_back({{"name", member.name}, {"text", typed_text(member.value)}});
    for (const std::string& name : logged_) view["log"].push_back(name);
    return view;
  }

 private:
  const Plan* plan() const { return text_.checked.plan.get(); }
  std::string path_of(const std::string& name) const { return joined(shown_.inside, name); }

  // ---- Facts about the whole level ----

  void find_rates() {
    if (!plan()) return;
    std::set<int64_t> periods;
    for (const Plan::Block& block : plan()->blocks) {
      types_.emplace(block.path, block.type);
      if (block.period > 0) periods.insert(block.period);
    }
    for (const Plan::Block& block : plan()->blocks) {
      if (block.period <= 0) continue;
      const int rate = int(std::distance(periods.begin(), periods.find(block.period))) + 1;
      // Subdiagrams have the colour of their blocks if these have one in common.
      for (std::string path = block.path.substr(0, block.path.find('['));;) {
        const auto [entry, is_new] = rates_.try_emplace(path, rate, block.sample_time);
        if (!is_new && entry->second.first != rate) entry->second = {0, 0};
        const size_t dot = path.rfind('.');
        if (dot == path.npos) break;
        path.resize(dot);
      }
    }
  }
  void find_problems() {
    const auto& list = text_.problems.list();
    for (size_t i = 0; i < std::min(list.size(), most_problems_told); ++i) {
      const Problem& problem = list[i];
      if (!problem.place.file || problem.place.file->name != shown_.owner->file->name) continue;
      by_place_.emplace(problem.place.offset, i);
    }
    for (size_t i = 0; i < std::min(list.size(), most_problems_told); ++i)
      for (std::string path = list[i].block; !path.empty();) {
        by_block_[path].insert(i);
        const size_t dot = path.rfind('.');
        path.resize(dot == path.npos ? 0 : dot);
      }
  }
  /// The ports of a block that other blocks read, for one whose type is not known.
  std::map<std::string, std::set<std::string>> sources_by_block(const Level& level) const {
    std::map<std::string, std::set<std::string>> sources;
    const auto add = [&](const std::string&, const Value& wire, size_t) {
      const size_t dot = wire.text.find('.');
      if (dot != wire.text.npos) sources[wire.text.substr(0, dot)].insert(wire.text.substr(dot + 1));
    };
    for (const Value::Member& block : level.blocks().members) each_wire(block.value, add);
    return sources;
  }
  std::string unit_at(const std::string& port, std::string_view declared) const {
    if (plan()) {
      const std::vector<Number> numbers = plan()->find(port.substr(0, port.find('[')));
      if (!numbers.empty())
        if (const auto unit = plan()->unit_of(numbers.front())) return to_string(*unit);
    }
    return declared.find('$') == declared.npos && declared != "?" ? std::string(declared) : "";
  }

  // ---- Blocks ----

  Json block(const Value::Member& member) const {
    const std::string path = path_of(member.name);
    const Value& body = body_of(member.value, path, variants_);
    const BlockEntry* entry = entry_of(shown_.loaded, member.name);
    const std::string type(text_in(body, "type"));
    const BlockType* known = find_block(type);
    const Value* sub = subdiagram_of(body);
    Json json{{"name", member.name}, {"type", type}, {"room", known ? known->info.room : ""}};
    json["title"] = entry && entry->subdiagram && !entry->subdiagram->title.empty() ? entry->subdiagram->title
                    : sub && sub->kind == Kind::text                                ? sub->text
                                                                                    : type;
    json["description"] = text_in(member.value, "description");
    json["subdiagram"] = sub != nullptr;
    json["file"] = sub && sub->kind == Kind::text ? resolve_relative(sub->place, sub->text) : "";
    json["variants"] = Json::array();
    if (const Value::Member* list = member.value.find("variants"))
      for (const Value::Member& variant : list->value.members) json["variants"].push_back(variant.name);
    json["variant"] = variant_of(member.value, path, variants_);
    json["settings"] = settings(body, entry, known, path);
    ports(member, entry, type_at(path, known), json);
    json["picture"] = sub ? Json{{"kind", "none"}} : picture_json(type, entry ? entry->settings : body);
    const auto rate = rates_.find(path);
    json["rate"] = rate == rates_.end() ? 0 : rate->second.first;
    json["sample_time"] = rate == rates_.end() ? 0.0 : rate->second.second;
    json["position"] = nullptr;
    if (const auto position = layout_.find(path); position != layout_.end())
      json["position"] = {position->second.first, position->second.second};
    json["problems"] = problems_of(member, path);
    json["chart"] = machine_json(type, body, entry ? &entry->settings : nullptr);
    json["hardware"] = known && known->info.room == "io" && known->info.has_side_effects;
    return json;
  }

  Json problems_of(const Value::Member& member, const std::string& path) const {
    std::set<size_t> indices;
    if (const auto found = by_block_.find(path); found != by_block_.end()) indices = found->second;
    const auto end = by_place_.lower_bound(end_of(member.value));
    for (auto i = by_place_.lower_bound(member.place.offset); i != end; ++i) indices.insert(i->second);
    return Json(indices);
  }

  Json slider_json(const std::optional<Slider>& slider, const std::string& set) const {
    if (!slider) return nullptr;
    return {{"low", slider->low},   {"high", slider->high},   {"step", (slider->high - slider->low) / 200},
            {"unit", slider->unit}, {"value", slider->value}, {"set", set},
            {"logarithmic", false}};
  }

  static std::string unit_written(const Value& value) {
    const Value::Member* unit = value.kind == Kind::object ? value.find("unit") : nullptr;
    return unit && unit->value.kind == Kind::text ? unit->value.text : "";
  }
  Json setting(const std::string& name, const Value* written, const Value* evaluated,
               const ParameterInfo* info, const std::string& set) const {
    const std::string unit =
        info && info->unit.find('$') == std::string_view::npos ? std::string(info->unit) : "";
    Json json{{"name", name},
              {"text", written ? typed_text(*written) : ""},
              {"value", evaluated ? shown_value(*evaluated, unit) : ""},
              {"slider", nullptr}};
    if (!evaluated || evaluated->kind != Kind::number || (info && info->kind == ParameterKind::whole))
      return json;
    // A number that an expression computes has no unit of its own: its slider is in SI.
    const std::string own = written ? unit_written(*written) : "";
    const std::string si = evaluated->unit ? to_string(*evaluated->unit) : unit;
    const bool is_bare = written && written->kind == Kind::number;
    json["slider"] = slider_json(slider_around(evaluated->number,
                                               is_bare       ? ""
                                               : own.empty() ? si
                                                             : own,
                                               info),
                                 set);
    return json;
  }

  Json settings(const Value& body, const BlockEntry* entry, const BlockType* known,
                const std::string& path) const {
    Json list = Json::array();
    static const std::set<std::string_view> not_settings = {"type",    "in",         "description",
                                                            "diagram", "parameters", "variants",
                                                            "variant", "enabled_by", "triggered_by"};
    for (const Value::Member& member : body.members) {
      if (not_settings.contains(member.name)) continue;
      const Value::Member* evaluated = entry ? entry->settings.find(member.name) : nullptr;
      const std::vector<std::string> name{member.name};
      list.push_back(setting(member.name, &member.value, evaluated ? &evaluated->value : nullptr,
                             known ? find_parameter(known->info.parameters, name) : nullptr,
                             path + "." + member.name));
    }
    const Value::Member* given = body.find("parameters");
    if (!entry || !entry->subdiagram) {
      if (given)
        for (const Value::Member& member : given->value.members)
          list.push_back(setting(member.name, &member.value, nullptr, nullptr, path + "." + member.name));
      return list;
    }
    for (const Parameter& parameter : entry->subdiagram->parameters) {
      const Value::Member* own = given ? given->value.find(parameter.name) : nullptr;
      list.push_back(setting(parameter.name, own ? &own->value : nullptr, &parameter.value, nullptr,
                             path + "." + parameter.name));
    }
    return list;
  }

  // ---- Ports ----

  static size_t wire_count(const Value& block, std::string_view port) {
    const Value* wires = wires_into(block, port);
    if (!wires) return 0;
    return wires->kind == Kind::list ? wires->items.size() : 1;
  }
  Json input(const Value::Member& member, std::string_view name, std::string_view unit,
             std::string_view sentence, bool many, bool optional) const {
    return {{"name", name},         {"unit", unit_at(path_of(member.name) + "." + std::string(name), unit)},
            {"many", many},         {"wires", wire_count(member.value, name)},
            {"sentence", sentence}, {"optional", optional}};
  }
  Json output(const Value::Member& member, std::string_view name, std::string_view unit,
              std::string_view sentence) const {
    const std::string port = path_of(member.name) + "." + std::string(name);
    return {{"name", name},
            {"unit", unit_at(port, unit)},
            {"sentence", sentence},
            {"logged", logged_.contains(port)}};
  }
  /// With the ports that the instance declares, once the diagram can be compiled.
  const BlockType* type_at(const std::string& path, const BlockType* known) const {
    const auto found = types_.find(path);
    return found == types_.end() ? known : found->second;
  }
  void ports(const Value::Member& member, const BlockEntry* entry, const BlockType* known, Json& json) const {
    Json inputs = Json::array(), outputs = Json::array();
    if (entry && entry->subdiagram) {
      for (const DiagramInput& port : entry->subdiagram->inputs)
        inputs.push_back(input(member, port.name, port.unit, port.description, false, false));
      for (const DiagramOutput& port : entry->subdiagram->outputs)
        outputs.push_back(output(member, port.name, port.unit, port.description));
      if (const RunCondition* condition = entry->condition.get()) {
        inputs.push_back(
            input(member, condition->key, "", "Decides when the subdiagram runs.", false, false));
        outputs.push_back(output(member, gate_name, "", "1 while the subdiagram runs."));
      }
    } else if (known) {
      for (const PortInfo& port : known->info.inputs)
        if (port.shape != PortInfo::Shape::named)
          inputs.push_back(input(member, port.name, port.unit, port.sentence,
                                 port.shape == PortInfo::Shape::many, port.is_optional));
      for (const PortInfo& port : known->info.outputs)
        if (port.shape != PortInfo::Shape::named)
          outputs.push_back(output(member, port.name, port.unit, port.sentence));
    }
    // What wires name but the block does not have, or is not known to have, is shown with its problem.
    const auto has = [](const Json& list, const std::string& name) {
      return std::ranges::any_of(list, [&](const Json& port) { return port["name"] == name; });
    };
    if (const Value::Member* in = member.value.find("in"))
      for (const Value::Member& port : in->value.members)
        if (!has(inputs, port.name))
          inputs.push_back(input(member, port.name, "", "", port.value.kind == Kind::list, false));
    if (const auto read = sources_.find(member.name); read != sources_.end())
      for (const std::string& name : read->second) {
        const std::string port = name.substr(0, name.find('['));
        const bool leads_inside = port.find('.') != port.npos;
        if (!has(outputs, port) && !(leads_inside && entry && entry->subdiagram))
          outputs.push_back(output(member, port, "", ""));
      }
    json["inputs"] = std::move(inputs), json["outputs"] = std::move(outputs);
  }

  // ---- Wires ----

  void add_wire(const Value& source, const std::string& to, size_t index, Json& wires) const {
    if (source.kind != Kind::text) return;
    std::string clash;
    if (const auto problem = by_place_.find(source.place.offset); problem != by_place_.end())
      clash = text_.problems.list()[problem->second].message;
    wires.push_back({{"from", source.text},
                     {"to", to},
                     {"index", index},
                     {"unit", unit_at(path_of(source.text), "")},
                     {"clash", printable(clash)}});
  }
  void add_wires(const Value::Member& block, Json& wires) const {
    each_wire(block.value, [&](const std::string& port, const Value& wire, size_t index) {
      add_wire(wire, block.name + "." + port, index, wires);
    });
  }
  void add_ports(const Value& diagram, Json& view) const {
    const auto place = [&](const Value::Member& member, Json json) {
      json["offset"] = places_.units(member.place.offset), json["end"] = places_.units(end_of(member.value));
      return json;
    };
    const auto described = [&](const Value::Member& member) -> Json {
      const bool is_text = member.value.kind == Kind::text;
      const std::string_view unit =
          is_text ? std::string_view(member.value.text) : text_in(member.value, "unit");
      return {{"name", member.name},
              {"unit", unit_at(path_of(member.name), unit)},
              {"description", is_text ? "" : text_in(member.value, "description")}};
    };
    if (const Value::Member* list = diagram.find("inputs"))
      for (const Value::Member& member : list->value.members)
        view["inputs"].push_back(place(member, described(member)));
    if (const Value::Member* list = diagram.find("outputs"))
      for (const Value::Member& member : list->value.members) {
        const Value::Member* inner =
            member.value.kind == Kind::object ? member.value.find("source") : nullptr;
        const Value& source = inner ? inner->value : member.value;
        Json json = described(member);
        if (!inner) json["unit"] = unit_at(path_of(member.name), "");
        json["source"] = source.text;
        view["outputs"].push_back(place(member, std::move(json)));
        add_wire(source, member.name, 0, view["wires"]);
      }
  }

  // ---- Parameters ----

  Json parameter(const Value::Member& member) const {
    Json json{{"name", member.name},
              {"text", typed_text(member.value)},
              {"value", nullptr},
              {"unit", unit_written(member.value)},
              {"description", member.value.kind == Kind::object ? text_in(member.value, "description") : ""},
              {"slider", nullptr},
              {"offset", places_.units(member.place.offset)},
              {"end", places_.units(end_of(member.value))}};
    if (!shown_.loaded) return json;
    const auto found = std::ranges::find(shown_.loaded->parameters, member.name, &Parameter::name);
    if (found == shown_.loaded->parameters.end() || found->value.kind != Kind::number) return json;
    const double number = found->value.number;
    json["value"] = found->unit ? found->unit->from_si(number) : number;
    // The numbers that every setting with this parameter accepts.
    ParameterInfo limits;
    Problems ignored;
    if (const auto found_number = find_number(*shown_.loaded, member.name, ignored))
      limits.low = found_number->least, limits.high = found_number->most;
    json["slider"] =
        slider_json(slider_around(number, unit_written(member.value), &limits), path_of(member.name));
    return json;
  }

  const CheckedText& text_;
  const ShownLevel shown_;
  const Variants& variants_;
  const Layout& layout_;
  const Utf16 places_;
  std::set<std::string> logged_;
  std::map<std::string, std::pair<int, double>> rates_;
  std::map<std::string_view, const BlockType*> types_;  ///< of the blocks of the plan, by path
  std::map<std::string, std::set<size_t>> by_block_;
  std::multimap<size_t, size_t> by_place_;
  std::map<std::string, std::set<std::string>> sources_;
};

}  // namespace

Json view_json(const CheckedText& text, const std::string& inside, const Variants& variants,
               const Layout& layout) {
  if (!text.parsed->is_object()) return nullptr;
  return View(text, find_shown_level(text, inside, variants), variants, layout).json();
}

}  // namespace loopwright::studio

#include "tools/effects/take_out.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/json.h"

namespace loopwright {
namespace {

using To = Attachment::To;

Value parsed(const std::string& text) {
  Problems problems;  // of texts in this file
  return parse_json(std::make_shared<SourceFile>(SourceFile{"effect", text}), problems);
}

class Switched {
 public:
  explicit Switched(Effect effect) : effect_(std::move(effect)) {}

  Effect run() {
    for (Attachment& a : effect_.attachments) {
      if (a.to == To::force) a.from = force(a.from);
      if (a.to == To::input) a.from = chosen(a.from, passed_input());
      if (a.to == To::sensor) a.from = chosen(a.from, "position");
    }
    return std::move(effect_);
  }

 private:
  std::string add(const std::string& name, const std::string& text) {
    std::string free = name;
    for (int i = 2; effect_.blocks.find(free); ++i) free = fmt::format("{}_{}", name, i);
    effect_.blocks.members.push_back({free, {}, parsed(text)});
    return free;
  }
  std::string force(const std::string& from) {
    return add("share",
               fmt::format(R"({{"type": "Gain", "gain": "{}", "in": {{"u": "{}"}}}})", switch_value, from)) +
           ".y";
  }
  /// An experiment that drives the input then has one port to drive.
  std::string passed_input() {
    const std::string name = add("input", R"({"type": "Gain", "gain": 1, "in": {"u": "input"}})");
    for (Value::Member& block : effect_.blocks.members) {
      if (block.name == name) continue;
      const auto in = std::ranges::find(block.value.members, "in", &Value::Member::name);
      if (in == block.value.members.end()) continue;
      for (Value::Member& port : in->value.members) {
        if (port.value.text == "input") port.value.text = name + ".y";
        for (Value& item : port.value.items)
          if (item.text == "input") item.text = name + ".y";
      }
    }
    return name + ".y";
  }
  std::string chosen(const std::string& with, const std::string& without) {
    const std::string number =
        add("with", fmt::format(R"({{"type": "Constant", "value": "{}"}})", switch_value));
    return add("chosen",
               fmt::format(
                   R"({{"type": "Switch", "in": {{"control": "{}.y", "first": "{}", "second": "{}"}}}})",
                   number, with, without)) +
           ".y";
  }

  Effect effect_;
};

}  // namespace

bool mentions_switch(const Value& block) {
  return std::ranges::any_of(block.members,
                             [](const Value::Member& setting) { return setting.value.text == switch_value; });
}

Effect with_switch(Effect effect) { return Switched(std::move(effect)).run(); }

}  // namespace loopwright

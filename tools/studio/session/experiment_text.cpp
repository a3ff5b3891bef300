#include "tools/studio/session/experiment_text.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/record/csv_syntax.h"
#include "engine/record/time_words.h"
#include "tools/studio/session/draft.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

/// Lines of an object, values in one column.
std::string lines_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  size_t width = 0;
  for (const auto& [name, value] : entries) width = std::max(width, in_quotes(name).size());
  std::string text;
  for (const auto& [name, value] : entries)
    text += fmt::format("{}\n    {}:{} {}", text.empty() ? "" : ",", in_quotes(name),
                        std::string(width - in_quotes(name).size(), ' '), value);
  return "{" + text + "\n  }";
}

std::string signal_text(const Value& column, bool drives) {
  std::string text = fmt::format("{{\"column\": {}", in_quotes(required_text(column, "column")));
  const auto add = [&](const char* key) {
    const std::string value(text_in(column, key));
    const auto number = csv::parse_number(value);
    const bool is_number = number && std::isfinite(*number);
    if (!value.empty())
      text += fmt::format(", \"{}\": {}", key, is_number ? fmt::format("{}", *number) : in_quotes(value));
  };
  add("unit");
  add(drives ? "interpolation" : "resolution");
  return text + "}";
}

/// The unit of the time, if the heading does not state it: a renamed column of the same name.
std::string time_columns(const Value& columns, std::string_view time) {
  for (const Value& column : columns.items) {
    const std::string_view unit = text_in(column, "unit");
    const Value::Member* stated = column.find("unit_is_stated");
    const bool is_in_heading = !stated || stated->value.boolean;
    const TimeWords words = time_words(time);
    const bool is_needed = unit != "s" || !words.unit.empty() || words.is_counted;
    if (text_in(column, "use") == "time" && text_in(column, "column") == time && !unit.empty() &&
        !is_in_heading && is_needed)
      return fmt::format("{{{}: {{\"unit\": {}}}}}", in_quotes(time), in_quotes(unit));
  }
  return "";
}

}  // namespace

std::string experiment_text(const Value& request, const std::string& data, const Value& before) {
  std::vector<std::pair<std::string, std::string>> drives, compared, roles;
  const Value::Member* columns = request.find("columns");
  if (!columns || columns->value.kind != Kind::list) throw Refused("the request lacks the list \"columns\"");
  for (const Value& column : columns->value.items) {
    const std::string_view use = text_in(column, "use");
    if (use != "drive" && use != "compare") continue;
    const std::string port = required_text(column, "port");
    if (port.empty()) throw Refused(fmt::format("the column \"{}\" has no port", text_in(column, "column")));
    (use == "drive" ? drives : compared).emplace_back(port, signal_text(column, use == "drive"));
  }
  if (const Value::Member* list = request.find("roles"))
    for (const Value::Member& role : list->value.members)
      if (role.value.kind == Kind::text && !role.value.text.empty())
        roles.emplace_back(role.name, in_quotes(role.value.text));
  // The position of the machine first: its error is what a person looks at.
  const auto position = std::ranges::find(roles, "position", &std::pair<std::string, std::string>::first);
  if (position != roles.end())
    std::ranges::stable_partition(
        compared, [&](const auto& entry) { return in_quotes(entry.first) == position->second; });
  std::string text = "{\n  \"loopwright\": 1,\n";
  if (const std::string_view title = text_in(request, "title"); !title.empty())
    text += fmt::format("  \"title\": {},\n", in_quotes(title));
  text += fmt::format("  \"data\": {},\n", in_quotes(data));
  if (const std::string_view time = text_in(request, "time"); !time.empty())
    text += fmt::format("  \"time\": {},\n", in_quotes(time));
  if (const std::string of_time = time_columns(columns->value, text_in(request, "time")); !of_time.empty())
    text += fmt::format("  \"columns\": {},\n", of_time);
  if (!drives.empty()) text += fmt::format("  \"drive\": {},\n", lines_of(drives));
  text += fmt::format("  \"compare\": {}", lines_of(compared));
  if (!roles.empty()) text += fmt::format(",\n  \"roles\": {}", lines_of(roles));
  if (const Value::Member* set = before.find("set"))
    text += fmt::format(",\n  \"set\": {}", source_of(set->value));
  const Value::Member* hold_out = request.find("hold_out");
  if (hold_out && hold_out->value.kind == Kind::number && hold_out->value.number > 0)
    text += fmt::format(",\n  \"hold_out\": {{\"fraction\": {}}}", hold_out->value.number);
  return text + "\n}\n";
}

std::vector<std::string> ports_of_experiment(const Value& experiment) {
  std::vector<std::string> ports;
  ports_renamed(experiment, [&](const std::string& port) {
    ports.push_back(port);
    return port;
  });
  return ports;
}

TextChanges ports_renamed(const Value& experiment,
                          const std::function<std::string(const std::string& port)>& new_name) {
  TextChanges changes;
  const auto in_text = [&](const Value& port) {
    if (port.kind != Kind::text) return;
    if (const std::string to = new_name(port.text); to != port.text)
      changes.push_back(replaced(port, in_quotes(to)));
  };
  for (const char* key : {"drive", "compare"})
    if (const Value::Member* list = experiment.find(key))
      for (const Value::Member& member : list->value.members)
        if (const std::string to = new_name(member.name); to != member.name)
          changes.push_back(renamed_member(member, to));
  if (const Value::Member* roles = experiment.find("roles"))
    for (const Value::Member& role : roles->value.members) in_text(role.value);
  if (const Value::Member* sites = experiment.find("sites"))
    for (const Value& site : sites->value.items) in_text(site);
  return changes;
}

std::string with_ports_renamed(const std::string& path, const std::string& text,
                               const std::map<std::string, std::string>& renamed) {
  const ParsedText parsed(path, text);
  if (!parsed.is_object()) return text;
  TextChanges changes = ports_renamed(parsed.root, [&](const std::string& port) {
    for (const auto& [from, to] : renamed)
      if (port == from || port.starts_with(from + ".")) return to + port.substr(from.size());
    return port;
  });
  std::ranges::sort(changes, {}, &TextChange::from);
  return applied(text, changes);
}

}  // namespace loopwright::studio

#include "tools/studio/session/column_match.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include "engine/json/reader.h"
#include "engine/record/csv_syntax.h"
#include "engine/record/time_words.h"
#include "tools/run/scopes.h"

namespace loopwright::studio {
namespace {

using Words = std::vector<std::string>;

/// "q_ref [m]" → q, ref. "motorSpeed" → motor, speed.
Words words_of(std::string_view text) {
  Words words(1);
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool begins = std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(text[i - 1]));
    if (!std::isalnum(c) || begins) words.emplace_back();
    if (std::isalnum(c)) words.back() += char(std::tolower(c));
  }
  std::erase(words, "");
  return words;
}

/// Words that mean the same quantity in logs and diagrams.
const std::vector<std::set<std::string, std::less<>>> meanings = {
    {"position", "pos", "q", "x", "y", "angle", "theta", "phi", "measured", "meas", "encoder", "actual",
     "act"},
    {"velocity", "vel", "v", "speed", "omega", "qd", "dq"},
    {"acceleration", "acc", "a", "qdd", "ddq"},
    {"force", "f", "torque", "tau", "effort", "current", "i", "u", "command", "drive"},
    {"reference", "ref", "setpoint", "sp", "target", "desired", "demand", "des"},
};
constexpr size_t reference = 4, force = 3, quantities = 4;

/// Which meanings the words have.
std::array<bool, 5> meanings_of(const Words& words) {
  std::array<bool, 5> found{};
  for (const std::string& word : words)
    for (size_t i = 0; i < meanings.size(); ++i) found[i] |= meanings[i].contains(word);
  return found;
}

std::string last_name(const std::string& path) { return path.substr(path.rfind('.') + 1); }
std::string first_name(const std::string& path) { return path.substr(0, path.find('.')); }
long depth_of(const std::string& path) { return std::ranges::count(path, '.'); }

bool fits(const ColumnGuess& column, const PortOfDiagram& port) {
  if (column.unit.empty() || !port.unit) return true;
  const auto unit = parse_unit(column.unit);
  return !unit || unit->same_dimension(*port.unit);
}

/// How well a column goes with a port; below 2 it does not.
double score(const ColumnGuess& column, const PortOfDiagram& port, const std::vector<RoleGuess>& roles) {
  if (!fits(column, port)) return 0;
  const Words own = words_of(column.name), all = words_of(port.path), last = words_of(last_name(port.path));
  const auto own_meanings = meanings_of(own), port_meanings = meanings_of(last);
  double points = 0;
  for (const std::string& word : own) {
    if (std::ranges::find(last, word) != last.end())
      points += 4;
    else if (std::ranges::find(all, word) != all.end())
      points += 1;
    else if (meanings_of({word}) == std::array<bool, 5>{})
      points -= 0.5;  // it says something else, too: true_model_position
  }
  for (size_t i = 0; i < quantities; ++i)
    if (own_meanings[i] && port_meanings[i]) points += 2;
  // A reference is not a measured position, even if both are called q.
  const bool is_reference = own_meanings[reference];
  const bool port_is_reference = meanings_of(all)[reference];
  if (is_reference != port_is_reference) points -= 3;
  if (is_reference && port_is_reference) points += 2;
  if (points < 2) return 0;
  if (!column.unit.empty() && port.unit) points += 1;
  // No sensor shows the sum of forces.
  for (const RoleGuess& role : roles)
    if (role.port == port.path) points += role.role == "force" ? -2 : 0.5;
  return points < 2 ? 0 : points - 0.2 * double(depth_of(port.path));
}

/// "force_N" → force and N. A last word that is no unit stays; so do "in" and "t", which are rather
/// an input and the time than inches and tonnes.
void split_unit(ColumnGuess& column) {
  const size_t cut = column.name.rfind('_');
  if (!column.unit.empty() || cut == column.name.npos || cut == 0) return;
  const std::string unit = column.name.substr(cut + 1);
  const bool is_word = meanings_of({unit}) != std::array<bool, 5>{};
  if ((is_word && unit.size() > 1) || unit == "in" || unit == "t" ||
      !csv::is_unit_of(column.name.substr(0, cut), unit) || !parse_unit(unit))
    return;
  const std::string of_time = time_words(column.name).unit;  // ms for "millis"
  column.unit = of_time.empty() ? unit : of_time, column.unit_is_stated = false;
  column.name.resize(cut);
}

bool is_time(const ColumnGuess& column) {
  const Words words = words_of(column.name);
  const auto unit = parse_unit(column.unit);
  const bool has_unit = column.unit.empty() || (unit && unit->same_dimension(*parse_unit("s")));
  return has_unit && words.size() == 1 && (words[0] == "t" || words[0] == "time" || words[0] == "timestamp");
}

/// The unit that the name of the time suggests, for a person to confirm: ms for "timestamp_millis".
void guess_unit_of_time(ColumnGuess& time) {
  if (!time.unit.empty()) return;
  time.unit = time_words(time.column).unit, time.unit_is_stated = false;
}

/// The smallest step between rows, if all steps are multiples of it.
double resolution_of(const std::vector<double>& values) {
  double least = INFINITY;
  for (size_t i = 1; i < values.size(); ++i)
    if (const double step = std::abs(values[i] - values[i - 1]); step > 0) least = std::min(least, step);
  if (!std::isfinite(least)) return 0;
  constexpr double most_counts = 1e8;  // more counts in a range than an encoder has are digits of a log
  size_t multiples = 0, steps = 0;
  double range = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    const double step = std::abs(values[i] - values[i - 1]);
    range = std::max(range, std::abs(values[i]));
    if (!(step > 0)) continue;  // also beside a row without a number
    ++steps;
    multiples += std::abs(step / least - std::round(step / least)) < 0.02;
  }
  return steps > 50 && multiples > 0.99 * double(steps) && range < most_counts * least ? least : 0;
}

const PortOfDiagram* find_port(const std::vector<PortOfDiagram>& ports, Number number,
                               const std::string& within, bool inputs) {
  for (const PortOfDiagram& port : ports)
    if (port.number == number && port.is_input == inputs && first_name(port.path) == within) return &port;
  return nullptr;
}

const Plan::Block* mass_of(const Plan& plan) {
  for (const Plan::Block& block : plan.blocks)
    if (block.type->info.type == "Mass") return &block;
  return nullptr;
}

Number output_number(const Plan::Block& block, std::string_view name) {
  for (size_t i = 0; i < block.type->info.outputs.size(); ++i)
    if (block.type->info.outputs[i].name == name) return block.outputs[i];
  return -1;
}

/// The input of the diagram around the machine that carries the force; or the first term of the sum.
const PortOfDiagram* input_of(const Plan& plan, const Plan::Block& sum,
                              const std::vector<PortOfDiagram>& ports, const std::string& within,
                              const std::optional<Unit>& force_unit) {
  const std::span<const Number> terms = sum.inputs.empty() ? std::span<const Number>() : sum.inputs[0];
  for (Number term : terms)
    for (const PortOfDiagram& port : ports)
      if (port.is_input && depth_of(port.path) == 1 && port.number == term &&
          first_name(port.path) == within && port.path != sum.path + ".terms")
        return &port;
  for (const PortOfDiagram& port : ports)
    if (port.is_input && depth_of(port.path) == 1 && first_name(port.path) == within && within != sum.path &&
        meanings_of(words_of(last_name(port.path)))[force] &&
        (!port.unit || !force_unit || port.unit->fits(*force_unit)))
      return &port;
  for (Number term : terms) {
    const auto [block, output] = plan.source_of(term);
    if (block < 0 || plan.blocks[size_t(block)].type->info.room == "mechanics") continue;
    for (const PortOfDiagram& port : ports)
      if (!port.is_input && port.number == term) return &port;
  }
  return nullptr;
}

}  // namespace

std::string_view name_of(ColumnGuess::Use use) {
  static constexpr std::string_view names[] = {"time", "drive", "compare", "ignore"};
  return names[size_t(use)];
}

namespace {

void add_inputs(const Diagram& diagram, const std::string& prefix, std::set<std::string>& inputs) {
  for (const BlockEntry& entry : diagram.blocks) {
    const std::string path = joined(prefix, entry.name);
    if (entry.subdiagram) {
      for (const DiagramInput& input : entry.subdiagram->inputs) inputs.insert(path + "." + input.name);
      add_inputs(*entry.subdiagram, path, inputs);
    } else if (const BlockType* type = find_block(entry.type)) {
      for (const PortInfo& input : type->info.inputs) inputs.insert(path + "." + std::string(input.name));
    }
  }
}

}  // namespace

std::vector<PortOfDiagram> ports_of(const Plan& plan, const Diagram& diagram) {
  std::set<std::string> inputs;
  add_inputs(diagram, "", inputs);
  std::vector<PortOfDiagram> ports;
  for (const Plan::Port& port : plan.ports) {
    if (port.numbers.size() != 1) continue;
    const std::string path(port.name);
    ports.push_back({path, plan.unit_of(port.numbers[0]), inputs.contains(path), port.numbers[0]});
  }
  std::ranges::stable_sort(ports, {},
                           [](const PortOfDiagram& p) { return std::pair(depth_of(p.path), p.path.size()); });
  return ports;
}

std::vector<RoleGuess> guess_roles(const Plan& plan, const std::vector<PortOfDiagram>& ports) {
  const Plan::Block* mass = mass_of(plan);
  if (!mass) return {};
  const std::string within = first_name(mass->path);
  std::vector<RoleGuess> roles;
  const auto add = [&](const char* role, const PortOfDiagram* port, std::string why) {
    if (port) roles.push_back({role, port->path, std::move(why)});
  };
  for (const char* role : {"position", "velocity"})
    add(role, find_port(ports, output_number(*mass, role), within, false),
        fmt::format("of the mass {}", mass->path));
  if (mass->inputs.empty() || mass->inputs[0].empty()) return roles;
  const Number net_force = mass->inputs[0].front();
  const auto [block, output] = plan.source_of(net_force);
  if (block < 0 || plan.blocks[size_t(block)].type->info.type != "Sum") return roles;
  const Plan::Block& sum = plan.blocks[size_t(block)];
  add("force", find_port(ports, net_force, first_name(sum.path), false),
      fmt::format("the sum of forces on {}", mass->path));
  add("input", input_of(plan, sum, ports, within, plan.unit_of(net_force)), "what pushes the machine");
  return roles;
}

namespace {

/// The ports that go with a column, best first; the points of the best.
double add_candidates(ColumnGuess& guess, bool drives, const std::vector<PortOfDiagram>& ports,
                      const std::vector<RoleGuess>& roles) {
  std::vector<std::pair<double, const PortOfDiagram*>> scored;
  for (const PortOfDiagram& port : ports)
    if (const double points = score(guess, port, roles); points > 0 && port.is_input == drives)
      scored.emplace_back(points, &port);
  std::ranges::stable_sort(scored, std::ranges::greater{}, [](const auto& s) { return s.first; });
  constexpr size_t most_candidates = 12;
  for (size_t i = 0; i < std::min(scored.size(), most_candidates); ++i)
    guess.candidates.push_back(scored[i].second->path);
  return scored.empty() ? 0 : scored.front().first;
}

/// Without a drive, the only column in the unit of the machine's input drives it; or, among columns without
/// units, the only one that is called a force.
void propose_drive(std::vector<ColumnGuess>& guesses, const std::vector<PortOfDiagram>& ports,
                   const std::vector<RoleGuess>& roles) {
  using Use = ColumnGuess::Use;
  const auto role = std::ranges::find(roles, "input", &RoleGuess::role);
  if (role == roles.end() || std::ranges::find(guesses, Use::drive, &ColumnGuess::use) != guesses.end())
    return;
  const auto port =
      std::ranges::find_if(ports, [&](const PortOfDiagram& p) { return p.path == role->port && p.is_input; });
  if (port == ports.end()) return;
  std::vector<ColumnGuess*> in_unit, called;
  for (ColumnGuess& guess : guesses) {
    if (guess.use != Use::ignore) continue;
    if (!guess.unit.empty() && port->unit && fits(guess, *port)) in_unit.push_back(&guess);
    if (guess.unit.empty() && meanings_of(words_of(guess.name))[force]) called.push_back(&guess);
  }
  const bool by_unit = in_unit.size() == 1;
  if (!by_unit && (!in_unit.empty() || called.size() != 1)) return;
  ColumnGuess& drive = by_unit ? *in_unit.front() : *called.front();
  drive.use = Use::drive, drive.port = port->path;
  drive.why =
      by_unit ? fmt::format("the only column in the unit of {}", port->path) : "the only force by its name";
  if (std::ranges::find(drive.candidates, port->path) == drive.candidates.end())
    drive.candidates.insert(drive.candidates.begin(), port->path);
}

}  // namespace

std::vector<ColumnGuess> guess_columns(const Recording& record, const std::vector<PortOfDiagram>& ports,
                                       const std::vector<RoleGuess>& roles) {
  using Use = ColumnGuess::Use;
  std::vector<ColumnGuess> guesses;
  bool has_time = false, has_reference = false;
  for (const Column& column : record.columns) {
    ColumnGuess guess;
    guess.column = guess.name = column.name, guess.unit = column.unit;
    guess.unit_is_stated = !column.unit.empty();
    const SignalRange range(column.values);
    if (range.not_finite < column.values.size()) guess.low = range.least, guess.high = range.greatest;
    split_unit(guess);
    if (!has_time && is_time(guess)) {
      guess.use = Use::time, guess.why = "name and unit";
      has_time = true;
    }
    has_reference |= meanings_of(words_of(guess.name))[reference];
    guesses.push_back(std::move(guess));
  }
  if (!has_time && record.is_ordered && !guesses.empty())
    guesses.front().use = Use::time, guesses.front().why = "the first column";
  for (ColumnGuess& guess : guesses)
    if (guess.use == Use::time) guess_unit_of_time(guess);
  // The whole loop runs along its reference; without one, the machine runs along its force.
  const auto drives = [&](const ColumnGuess& guess) {
    const auto own = meanings_of(words_of(guess.name));
    return own[reference] || (!has_reference && own[force]);
  };
  std::vector<std::pair<double, size_t>> best;  // of each column with a port
  for (size_t c = 0; c < guesses.size(); ++c) {
    if (guesses[c].use == Use::time) continue;
    const double points = add_candidates(guesses[c], drives(guesses[c]), ports, roles);
    if (points > 0) best.emplace_back(points, c);
  }
  std::ranges::stable_sort(best, std::ranges::greater{}, [](const auto& entry) { return entry.first; });
  std::map<std::string, std::string> taken;
  for (const auto& [points, c] : best) {
    ColumnGuess& guess = guesses[c];
    const std::string& port = guess.candidates.front();
    if (const auto [other, is_free] = taken.emplace(port, guess.column); !is_free) {
      guess.why = fmt::format("{} fits {} better", other->second, port);
      continue;
    }
    guess.use = drives(guess) ? Use::drive : Use::compare, guess.port = port;
    guess.why = guess.unit.empty() ? "name" : "name and unit";
    const double step = resolution_of(record.columns[c].values);
    if (guess.use == Use::compare && step > 0 && meanings_of(words_of(guess.name))[0])
      guess.resolution = fmt::format("{:.3g}", step);
  }
  propose_drive(guesses, ports, roles);
  return guesses;
}

}  // namespace loopwright::studio

#include "tests/fuzz/mutate.h"
#include <algorithm>
#include <cctype>
#include "engine/block/registry.h"
#include "tests/engine/record/mutation.h"

namespace loopwright::fuzz {
namespace {

// ---- tokens
// -----------------------------------------------------------------------------------------------------------

struct Token {
  size_t begin, end;
};

/// Approximately as in JSON; also for texts that are not JSON.
std::vector<Token> tokens_of(std::string_view text) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+';
  };
  std::vector<Token> tokens;
  for (size_t at = 0; at < text.size();) {
    const size_t begin = at++;
    if (text[begin] == '"')
      at = std::min(text.find('"', at), text.size() - 1) + 1;
    else if (is_word(text[begin]))
      while (at < text.size() && is_word(text[at])) ++at;
    if (!std::isspace(static_cast<unsigned char>(text[begin])))
      tokens.push_back({begin, std::max(at, begin + 1)});
  }
  return tokens;
}

constexpr std::string_view junk[] = {"null",
                                     "true",
                                     "1e999",
                                     "-1e308",
                                     "123456789012345678901234567890",
                                     "-0",
                                     "\"\"",
                                     "\"=\"",
                                     "\"=1/0\"",
                                     "\"=pi\"",
                                     "\"=((((\"",
                                     "\"=x.y\"",
                                     "{}",
                                     "[]",
                                     "[[[[]]]]",
                                     "{\"value\": 1, \"unit\": \"mm\"}",
                                     "{\"value\": \"=2\", \"unit\": \"?\"}",
                                     "\"\\ud800\"",
                                     "\"\\u0000\"",
                                     "\xff",
                                     "\xc3",
                                     "\"\xed\xa0\x80\"",
                                     "// no",
                                     "'",
                                     "\"..\"",
                                     "\"a.b[99999999999999999999]\"",
                                     "\"/\"",
                                     "\"/dev/null\"",
                                     "1e-400",
                                     "0.1e1",
                                     "\"m^(1/0)\"",
                                     "\"s since 1970-01-01\"",
                                     "9007199254740993"};

}  // namespace

double extreme_number(Random& random) {
  constexpr double numbers[] = {0,
                                -0.0,
                                1,
                                -1,
                                2,
                                3,
                                0.5,
                                1e-3,
                                0.1,
                                1e-9,
                                1e-15,
                                1e-300,
                                5e-324,
                                1e6,
                                1e9,
                                1e15,
                                1e18,
                                1e300,
                                -1e300,
                                1.7976931348623157e308,
                                2147483647,
                                2147483648.0,
                                -2147483649.0,
                                4294967296.0,
                                9007199254740993.0,
                                9.3e18,
                                1.0 / 3,
                                0.30000000000000004,
                                100,
                                1000,
                                65536,
                                -1e-9,
                                -1e9};
  return pick(numbers, random);
}

std::string mutate_tokens(const std::string& text, Random& random) {
  const std::vector<Token> tokens = tokens_of(text);
  if (tokens.empty()) return std::string(pick(junk, random));
  const Token token = pick(tokens, random), other = pick(tokens, random);
  const auto replaced_by = [&](std::string_view by) {
    return std::string(text).replace(token.begin, token.end - token.begin, by);
  };
  switch (below(random, 6)) {
    case 0:
      return replaced_by(std::string_view(text).substr(other.begin, other.end - other.begin));
    case 1:
      return replaced_by("");
    case 2:
      return text.substr(0, token.end) + text.substr(token.begin);  // twice
    case 3:
      return replaced_by(std::string(below(random, 200), '['));
    case 4:
      return text.substr(0, std::min(token.begin, other.begin)) + text.substr(std::max(token.end, other.end));
    default:
      return replaced_by(pick(junk, random));
  }
}

// ---- tree
// -------------------------------------------------------------------------------------------------------------

namespace {

/// A value in the tree, with the name or index that leads to it.
struct Node {
  Json* parent;
  std::string key;
  Json* value;
};
void collect(Json& parent, std::vector<Node>& nodes) {
  for (auto& [key, value] : parent.items()) {
    nodes.push_back({&parent, key, &value});
    if (value.is_structured()) collect(value, nodes);
  }
}
/// The nodes for which `wanted` is true.
std::vector<Node> nodes_where(Json& root, auto wanted) {
  std::vector<Node> nodes;
  if (root.is_structured()) collect(root, nodes);
  std::erase_if(nodes, [&](const Node& node) { return !wanted(node); });
  return nodes;
}
bool is_block(const Node& node) {
  return node.value->is_object() && (node.value->contains("type") || node.value->contains("diagram"));
}
bool is_wire(const Node& node) {
  return node.value->is_string() && node.value->get_ref<const std::string&>().find('.') != std::string::npos;
}

constexpr std::string_view units[] = {
    "m",  "N",     "s",       "mm", "kg",   "V*s^2/m", "rad",   "deg", "1",  "",   "%",    "degC", "m/s",
    "Hz", "rad/s", "furlong", "m^", "m^99", "1/s",     "N*s/m", "lb",  "ms", "km", "s^-1", "µm",   "m/0"};
constexpr double periods[] = {1e-3, 5e-4,         1e-2, 7e-4, 0.1,   1.0 / 3, 1e-6,
                              1e-9, 3.0000001e-3, 1e6,  0,    -1e-3, 1e300,   1e-300};
constexpr std::string_view expressions[] = {"=2*pi",           "=1/0",      "=0/0",           "=sqrt(-1)",
                                            "=mass",           "=1e308*10", "=2 > 1 ? 3 : x", "=-1",
                                            "=nominal_mass*2", "=1e-320"};

std::string any_type(Random& random) {
  auto type = all_blocks().begin();
  std::advance(type, below(random, all_blocks().size()));
  return type->first;
}

/// A source that exists, or nearly: any output of any block, sometimes an element of it.
std::string any_wire(Json& root, Random& random) {
  const auto blocks = nodes_where(root, is_block);
  if (blocks.empty()) return "a.y";
  const Node& block = pick(blocks, random);
  std::string port = "y";
  if (block.value->contains("type") && (*block.value)["type"].is_string())
    if (const BlockType* type = find_block((*block.value)["type"].get<std::string>());
        type && !type->info.outputs.empty())
      port = pick(type->info.outputs, random).name;
  constexpr std::string_view elements[] = {"", "", "", "", "", "[0]", "[1]", "[7]", "[-1]", "."};
  return block.key + "." + port + std::string(pick(elements, random));
}

void set_number(Json& root, Random& random) {
  const auto numbers = nodes_where(root, [](const Node& node) { return node.value->is_number(); });
  if (numbers.empty()) return;
  Json& number = *pick(numbers, random).value;
  if (below(random, 3) == 0)
    number = number.get<double>() * pick(std::array{-1.0, 0.1, 10.0, 1e3, 1e-3, 0.5}, random);
  else if (below(random, 4) == 0)
    number = int64_t(below(random, 20)) - 3;
  else
    number = extreme_number(random);
}
void rewire(Json& root, Random& random) {
  const auto wires = nodes_where(root, is_wire);
  if (wires.empty()) return;
  Json& wire = *pick(wires, random).value;
  switch (below(random, 5)) {
    case 0:
      wire = *pick(wires, random).value;
      break;
    case 1:
      wire = Json::array({any_wire(root, random), any_wire(root, random)});
      break;
    default:
      wire = any_wire(root, random);
  }
}
void retype(Json& root, Random& random) {
  const auto blocks = nodes_where(root, is_block);
  if (!blocks.empty()) (*pick(blocks, random).value)["type"] = any_type(random);
}
/// A block of another diagram replaces one of this diagram, wired to the blocks of this diagram.
void transplant(Json& root, std::span<const Json> donors, Random& random) {
  const auto blocks = nodes_where(root, is_block);
  if (blocks.empty() || donors.empty()) return;
  Json donor = donors[below(random, donors.size())];
  const auto organs = nodes_where(donor, is_block);
  if (organs.empty()) return;
  Json organ = *pick(organs, random).value;
  for (const Node& node : nodes_where(organ, is_wire))
    if (node.key != "diagram" && node.key != "file") *node.value = any_wire(root, random);
  *pick(blocks, random).value = std::move(organ);
}
void remove(Json& root, Random& random) {
  const auto nodes = nodes_where(root, [](const Node&) { return true; });
  if (nodes.empty()) return;
  const Node& node = pick(nodes, random);
  if (node.parent->is_object())
    node.parent->erase(node.key);
  else
    node.parent->erase(size_t(std::stoul(node.key)));
}
void duplicate_block(Json& root, Random& random) {
  const auto blocks = nodes_where(root, is_block);
  if (blocks.empty()) return;
  const Node& block = pick(blocks, random);
  if (!block.parent->is_object()) return;
  const Json copy = *block.value;
  (*block.parent)[block.key + (below(random, 8) ? "_twin" : "")] = copy;
}
void set_unit(Json& root, Random& random) {
  const auto nodes =
      nodes_where(root, [](const Node& node) { return node.key == "unit" || node.value->is_number(); });
  if (nodes.empty()) return;
  const Node& node = pick(nodes, random);
  if (node.key == "unit")
    *node.value = pick(units, random);
  else
    *node.value = Json{{"value", *node.value}, {"unit", pick(units, random)}};
}
void set_sample_time(Json& root, Random& random) {
  const auto blocks = nodes_where(root, is_block);
  if (blocks.empty()) return;
  Json& block = *pick(blocks, random).value;
  const std::string key = below(random, 5) ? "sample_time" : "sample_offset";
  if (block.contains(key) && below(random, 3) == 0)
    block.erase(key);
  else
    block[key] = pick(periods, random);
}
void set_solver(Json& root, Random& random) {
  if (!root.is_object()) return;
  Json& solver = root["solver"];
  if (!solver.is_object()) solver = Json::object();
  constexpr std::string_view methods[] = {"euler",     "heun",        "rk4",  "dopri5",
                                          "cvode-bdf", "cvode-adams", "ode45"};
  constexpr std::string_view keys[] = {
      "step",         "stop", "start", "record_step", "relative_tolerance", "absolute_tolerance",
      "maximum_step", "seed"};
  switch (below(random, 4)) {
    case 0:
      solver["method"] = pick(methods, random);
      for (const char* key : {"step", "relative_tolerance", "absolute_tolerance", "maximum_step"})
        if (below(random, 3)) solver.erase(key);
      break;
    case 1:
      solver["algebraic_loops"] = below(random, 4) ? "solve" : "error";
      break;
    default:
      solver[std::string(pick(keys, random))] =
          below(random, 2) ? pick(periods, random) : extreme_number(random);
  }
}
void swap_values(Json& root, Random& random) {
  const auto nodes = nodes_where(root, [](const Node& node) { return !node.value->is_structured(); });
  if (nodes.size() < 2) return;
  std::swap(*pick(nodes, random).value, *pick(nodes, random).value);
}
void replace_value(Json& root, Random& random) {
  const auto nodes = nodes_where(root, [](const Node&) { return true; });
  if (nodes.empty()) return;
  Json& value = *pick(nodes, random).value;
  switch (below(random, 6)) {
    case 0:
      value = nullptr;
      break;
    case 1:
      value = pick(expressions, random);
      break;
    case 2:
      value = Json::array({value, value});
      break;
    case 3:
      value = Json{{"value", pick(expressions, random)}, {"unit", pick(units, random)}};
      break;
    case 4:
      value = extreme_number(random);
      break;
    default:
      value = any_wire(root, random);
  }
}

}  // namespace

std::string mutate_tree(const std::string& text, std::span<const Json> donors, Random& random) {
  Json root = Json::parse(text, nullptr, false);
  if (!root.is_structured()) return mutate_tokens(text, random);
  for (size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    switch (below(random, 14)) {
      case 0:
      case 1:
      case 2:
        set_number(root, random);
        break;
      case 3:
      case 4:
        rewire(root, random);
        break;
      case 5:
        retype(root, random);
        break;
      case 6:
        transplant(root, donors, random);
        break;
      case 7:
        remove(root, random);
        break;
      case 8:
        duplicate_block(root, random);
        break;
      case 9:
        set_unit(root, random);
        break;
      case 10:
        set_sample_time(root, random);
        break;
      case 11:
        set_solver(root, random);
        break;
      case 12:
        swap_values(root, random);
        break;
      default:
        replace_value(root, random);
    }
  }
  return root.dump(1, ' ', false, Json::error_handler_t::replace);
}

std::string mutate_json(const std::string& text, std::span<const Json> donors, Random& random) {
  switch (below(random, 8)) {
    case 0:
      return mutate(text, random);
    case 1:
      return mutate_tokens(text, random);
    default:
      return mutate_tree(text, donors, random);
  }
}

std::string mutate_table(const std::string& text, Random& random) {
  if (below(random, 2)) return mutate(text, random);
  const std::vector<Token> tokens = tokens_of(text);
  if (tokens.empty()) return mutate(text, random);
  const Token token = pick(tokens, random), other = pick(tokens, random);
  std::string changed = text;
  if (below(random, 2))
    changed.replace(token.begin, token.end - token.begin, std::to_string(extreme_number(random)));
  else
    changed.replace(token.begin, token.end - token.begin, text.substr(other.begin, other.end - other.begin));
  return changed;
}

}  // namespace loopwright::fuzz

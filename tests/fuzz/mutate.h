/// Wrong diagrams as people, editors and damaged disks produce them. The same random numbers give the same
/// mutant.
///
/// Three depths: bytes (tests/engine/record/mutation.h), tokens of JSON, and the tree of a diagram. Mutants
/// of
/// the tree are still JSON and get furthest: wires, types, numbers, units, sample times, blocks.
#pragma once
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::fuzz {

using Json = nlohmann::ordered_json;
using Random = std::mt19937_64;

inline size_t below(Random& random, size_t n) { return size_t(random() % n); }
template <class List> const auto& pick(const List& list, Random& random) {
  return list[below(random, std::size(list))];
}

/// Numbers at which arithmetic, counters and clocks fail.
double extreme_number(Random& random);

/// One token of a JSON text replaced, removed, doubled or swapped with another.
std::string mutate_tokens(const std::string& text, Random& random);

/// One to three changes to a diagram or experiment that leave it JSON. `donors` are diagrams whose blocks may
/// replace others. A text that is not JSON gets a mutant of its tokens.
std::string mutate_tree(const std::string& text, std::span<const Json> donors, Random& random);

/// A mutant of bytes, tokens or tree.
std::string mutate_json(const std::string& text, std::span<const Json> donors, Random& random);

/// A mutant of a table: numbers, separators, rows and columns, or bytes.
std::string mutate_table(const std::string& text, Random& random);

}  // namespace loopwright::fuzz

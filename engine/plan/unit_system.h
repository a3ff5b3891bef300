/// Systems of equations between powers of unknown units.
#pragma once
#include <array>
#include <cstddef>
#include <tuple>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>
#include "engine/unit/unit.h"

namespace loopwright {

/// A set of equations Π unknownᵢ^exponentᵢ · unit = 1, linear in the exponents of each base unit.
///
/// Most equations of a diagram have two unknowns. They connect unknowns to trees (weighted union-find). The
/// remaining equations are eliminated. Coupled equations with many unknowns are solved as far as `most_work`
/// allows; the others stay unsolved.
class UnitSystem {
 public:
  struct Term {
    size_t unknown;
    double exponent;
  };

  void add(std::vector<Term> terms, const Unit& unit, int equation);
  void solve();
  /// The unit of an unknown that occurs; nothing if the equations do not determine it or contradict each
  /// other.
  std::optional<Unit> value(size_t unknown);
  const std::vector<size_t>& unknowns() const { return names_; }
  /// An equation that contradicts the others, with its remainder: a unit that would have to be 1.
  struct Contradiction {
    int equation;
    Unit rest;
  };
  const std::vector<Contradiction>& contradictions() const { return contradictions_; }

 private:
  using Powers = std::array<double, std::tuple_size_v<decltype(Unit::exponents)>>;
  /// unknown = parent^exponent · powers
  struct Node {
    int parent;  // its own index for a root
    double exponent = 1;
    Powers powers{};
    bool is_known = false;  // for a root: it is 1^… · powers of its own
  };
  struct Row {
    std::vector<Term> terms;
    Powers powers;
    int equation;
    int member;  // one of its unknowns
  };

  int index_of(size_t unknown);
  int find(int index);
  int group_of(int index);
  void contradict(const Row& row, const Unit& rest);
  /// Reduces a row to roots that are not known; true if nothing remains to be done.
  bool reduce(Row& row);
  void join(const Row& row);
  void know(int root, const Powers& powers);
  void eliminate(std::vector<Row> rows);

  static constexpr size_t most_work = 20'000'000;  // terms processed: about a second
  std::unordered_map<size_t, int> index_;
  std::vector<size_t> names_;
  std::vector<Node> nodes_;
  std::vector<Row> rows_;
  std::vector<int> groups_;  // of unknowns connected by equations: union-find
  std::unordered_set<int> contradictory_groups_;
  std::vector<Contradiction> contradictions_;
};

}  // namespace loopwright

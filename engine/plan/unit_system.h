/// Equations between powers of unknown units, solved together.
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

/// Π unknownᵢ^exponentᵢ · unit = 1, many times: linear in the exponents of each base unit.
///
/// Equations of two unknowns, which are most of any diagram's, join them to trees (weighted union and find);
/// what is left is eliminated. Of equations with many unknowns that stay tangled, so many are solved as
/// `most_work` allows; the others stay unsolved.
class UnitSystem {
 public:
  struct Term {
    size_t unknown;
    double exponent;
  };

  void add(std::vector<Term> terms, const Unit& unit, int equation);
  void solve();
  /// Of an unknown that occurs; nothing when the equations leave it open, or contradict each other about it.
  std::optional<Unit> value(size_t unknown);
  const std::vector<size_t>& unknowns() const { return names_; }
  /// Equations that cannot hold beside the others, and what is left of them: a unit that would have to be 1.
  struct Contradiction {
    int equation;
    Unit rest;
  };
  const std::vector<Contradiction>& contradictions() const { return contradictions_; }

 private:
  using Powers = std::array<double, std::tuple_size_v<decltype(Unit::exponents)>>;
  /// unknown = parent^exponent · powers
  struct Node {
    int parent;  // itself: a root
    double exponent = 1;
    Powers powers{};
    bool is_known = false;  // a root: it is 1^… · powers of its own
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
  /// Brings a row to roots that are not known; true when nothing is left to be done with it.
  bool reduce(Row& row);
  void join(const Row& row);
  void know(int root, const Powers& powers);
  void eliminate(std::vector<Row> rows);

  static constexpr size_t most_work = 20'000'000;  // terms touched: a second or so
  std::unordered_map<size_t, int> index_;
  std::vector<size_t> names_;
  std::vector<Node> nodes_;
  std::vector<Row> rows_;
  std::vector<int> groups_;  // of unknowns that hang together by equations: union and find
  std::unordered_set<int> contradictory_groups_;
  std::vector<Contradiction> contradictions_;
};

}  // namespace loopwright

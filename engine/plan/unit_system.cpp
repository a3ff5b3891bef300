#include "engine/plan/unit_system.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace loopwright {
namespace {

constexpr double nothing = 1e-6;  // exponents are multiples of 1/12

template <class Powers> void add_to(Powers& sum, const Powers& powers, double times) {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += times * powers[i];
}

template <class Powers> Unit unit_of(const Powers& powers) {
  Unit unit;
  for (size_t i = 0; i < powers.size(); ++i) unit.exponents[i] = static_cast<float>(powers[i]);
  return unit * Unit{};  // rounds the exponents
}

}  // namespace

void UnitSystem::add(std::vector<Term> terms, const Unit& unit, int equation) {
  Row row{std::move(terms), {}, equation, -1};
  for (size_t i = 0; i < row.powers.size(); ++i) row.powers[i] = unit.exponents[i];
  for (Term& term : row.terms) {
    term.unknown = size_t(index_of(term.unknown));
    groups_[size_t(group_of(int(term.unknown)))] = group_of(int(row.terms[0].unknown));
  }
  row.member = row.terms.empty() ? -1 : int(row.terms[0].unknown);
  rows_.push_back(std::move(row));
}

/// The representative of the group of connected unknowns.
int UnitSystem::group_of(int index) {
  while (groups_[size_t(index)] != index) {
    groups_[size_t(index)] = groups_[size_t(groups_[size_t(index)])];
    index = groups_[size_t(index)];
  }
  return index;
}

void UnitSystem::contradict(const Row& row, const Unit& rest) {
  contradictions_.push_back({row.equation, rest});
  if (row.member >= 0) contradictory_groups_.insert(group_of(row.member));
}

int UnitSystem::index_of(size_t unknown) {
  const auto [entry, is_new] = index_.try_emplace(unknown, int(nodes_.size()));
  if (is_new) {
    nodes_.push_back({.parent = int(nodes_.size())});
    groups_.push_back(int(groups_.size()));
    names_.push_back(unknown);
  }
  return entry->second;
}

/// The root, with path compression: every node on the path is attached to it.
int UnitSystem::find(int index) {
  std::vector<int> path;
  int root = index;
  while (nodes_[size_t(root)].parent != root) path.push_back(root), root = nodes_[size_t(root)].parent;
  for (size_t i = path.size(); i-- > 1;) {  // from the root outwards; the first is already attached
    Node& node = nodes_[size_t(path[i - 1])];
    const Node& above = nodes_[size_t(path[i])];
    add_to(node.powers, above.powers, node.exponent);
    node.exponent *= above.exponent;
    node.parent = root;
  }
  return root;
}

bool UnitSystem::reduce(Row& row) {
  std::vector<Term> terms;
  for (const Term& term : row.terms) {
    const int root = find(int(term.unknown));
    double exponent = term.exponent;
    if (root != int(term.unknown)) {
      add_to(row.powers, nodes_[term.unknown].powers, exponent);
      exponent *= nodes_[term.unknown].exponent;
    }
    if (nodes_[size_t(root)].is_known) {
      add_to(row.powers, nodes_[size_t(root)].powers, exponent);
      continue;
    }
    const auto same = std::ranges::find(terms, size_t(root), &Term::unknown);
    if (same == terms.end())
      terms.push_back({size_t(root), exponent});
    else
      same->exponent += exponent;
  }
  std::erase_if(terms, [](const Term& term) { return std::abs(term.exponent) < nothing; });
  row.terms = std::move(terms);
  if (row.terms.size() > 2) return false;
  join(row);
  return true;
}

void UnitSystem::know(int root, const Powers& powers) {
  nodes_[size_t(root)].powers = powers;
  nodes_[size_t(root)].is_known = true;
}

/// Adds a reduced row of at most two terms.
void UnitSystem::join(const Row& row) {
  if (row.terms.empty()) {
    const Unit rest = unit_of(row.powers);
    if (!rest.fits(Unit{})) contradict(row, rest);
    return;
  }
  Powers powers{};
  add_to(powers, row.powers, -1 / row.terms[0].exponent);
  if (row.terms.size() == 1) return know(int(row.terms[0].unknown), powers);
  Node& node = nodes_[row.terms[0].unknown];
  node.parent = int(row.terms[1].unknown);
  node.exponent = -row.terms[1].exponent / row.terms[0].exponent;
  node.powers = powers;
}

void UnitSystem::solve() {
  std::vector<Row> rows = std::move(rows_);
  rows_.clear();
  constexpr int most_passes = 50;  // remaining changes are left to the elimination
  for (int pass = 0; pass < most_passes; ++pass) {
    std::vector<Row> left;
    for (Row& row : rows)
      if (!reduce(row)) left.push_back(std::move(row));
    const bool is_done = left.size() == rows.size();
    rows = std::move(left);
    if (is_done) break;
  }
  eliminate(std::move(rows));
}

/// Gauss-Jordan elimination on rows of three or more unknowns.
void UnitSystem::eliminate(std::vector<Row> rows) {
  std::map<size_t, Row> solved;  // by the unknown for which it is solved
  size_t work = 0;
  const auto subtract = [&work](Row& from, const Row& row, double times) {
    for (const Term& term : row.terms) {
      const auto same = std::ranges::find(from.terms, term.unknown, &Term::unknown);
      if (same == from.terms.end())
        from.terms.push_back({term.unknown, -times * term.exponent});
      else
        same->exponent -= times * term.exponent;
    }
    work += from.terms.size() * row.terms.size();
    add_to(from.powers, row.powers, -times);
    std::erase_if(from.terms, [](const Term& term) { return std::abs(term.exponent) < nothing; });
  };
  const auto exponent_in = [](const Row& row, size_t unknown) {
    const auto term = std::ranges::find(row.terms, unknown, &Term::unknown);
    return term == row.terms.end() ? 0.0 : term->exponent;
  };
  for (Row& row : rows) {
    if (work > most_work) break;
    for (const Term& term : std::vector<Term>(row.terms))
      if (const auto pivot = solved.find(term.unknown); pivot != solved.end())
        subtract(row, pivot->second, exponent_in(row, term.unknown));
    if (row.terms.empty()) {
      join(row);
      continue;
    }
    const size_t unknown = row.terms[0].unknown;
    const double exponent = row.terms[0].exponent;
    for (Term& term : row.terms) term.exponent /= exponent;
    for (double& power : row.powers) power /= exponent;
    for (auto& [other, above] : solved)
      if (const double times = exponent_in(above, unknown); times != 0) subtract(above, row, times);
    work += solved.size();
    solved.emplace(unknown, std::move(row));
  }
  for (auto& [unknown, row] : solved)
    if (row.terms.size() == 1) join(row);
}

std::optional<Unit> UnitSystem::value(size_t unknown) {
  const int index = index_.at(unknown), root = find(index);
  const Node &node = nodes_[size_t(index)], &of_root = nodes_[size_t(root)];
  if (!of_root.is_known || contradictory_groups_.contains(group_of(index))) return {};
  if (index == root) return unit_of(of_root.powers);
  Powers powers = node.powers;
  add_to(powers, of_root.powers, node.exponent);
  return unit_of(powers);
}

}  // namespace loopwright

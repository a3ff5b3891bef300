#include "tools/diagnose/search/law_swaps.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// One of the three: its change and the diagram's value.
struct Term {
  const Candidate* candidate = nullptr;
  size_t member = 0;
  bool is_member = false;
  double nominal = 0, change = 0;
  double whole() const { return nominal + change; }
};

Term term_of(std::string_view name, double nominal, const std::vector<Member>& members,
             const std::vector<Candidate>& candidates) {
  Term term;
  term.nominal = nominal;
  if (const auto found = std::ranges::find(candidates, name, &Candidate::name); found != candidates.end())
    term.candidate = &*found;
  const auto member = std::ranges::find(members, term.candidate, &Member::candidate);
  if (!term.candidate || member == members.end()) return term;
  term.is_member = true, term.member = size_t(member - members.begin()), term.change = member->linear[0];
  return term;
}

double in_range(const CandidateParameter& range, double value) {
  return std::clamp(value, range.low, range.high);
}

/// The members without one term, with the law multiplied so that this term has the diagram's own value.
Proposal without(const Term& removed, std::span<const Term> terms, const std::vector<Member>& members) {
  const double factor = removed.nominal / removed.whole();
  Proposal proposal{{removed.member}, {}, {}, 0};
  std::vector<Member> rest = members;
  rest.erase(rest.begin() + std::ptrdiff_t(removed.member));
  for (const FreeParameter& p : free_parameters(rest)) {
    const Candidate& candidate = *rest[p.member].candidate;
    const auto term = std::ranges::find(terms, &candidate, &Term::candidate);
    const double value = value_of(rest, p);
    double to = value;
    if (term != terms.end())
      to = factor * term->whole() - term->nominal;
    else if (p.is_linear && candidate.acts == Acts::force)
      to = factor * value;
    proposal.step.push_back(in_range(range_of(rest, p), to) - value);
  }
  for (const Term& term : terms)
    if (!term.is_member && term.candidate)
      proposal.added.push_back(
          {term.candidate, {in_range(term.candidate->linear[0], factor * term.whole() - term.nominal)}, {}});
  return proposal;
}

double mean_over_records(const Trials& trials, double (AxisModel::*number)() const) {
  double sum = 0;
  for (const Trial& trial : trials.list) sum += ((*trial.model).*number)();
  return sum / double(trials.list.size());
}

/// Whether all records are of one mass and damping.
bool have_one_law(const Trials& trials) {
  constexpr double alike = 1e-6;  // relative: what differencing the same model leaves
  const AxisModel& first = *trials.list.front().model;
  const auto is_alike = [](double a, double b) { return std::abs(a - b) <= alike * std::abs(a); };
  return std::ranges::all_of(trials.list, [&](const Trial& trial) {
    return is_alike(first.nominal_inertia(), trial.model->nominal_inertia()) &&
           is_alike(first.nominal_damping(), trial.model->nominal_damping());
  });
}

}  // namespace

std::vector<Proposal> law_swaps(const std::vector<Member>& members, const std::vector<Candidate>& candidates,
                                const Trials& trials) {
  const Term terms[] = {
      term_of(gain_name, 1, members, candidates),
      term_of("inertia", mean_over_records(trials, &AxisModel::nominal_inertia), members, candidates),
      term_of("viscous_friction", mean_over_records(trials, &AxisModel::nominal_damping), members,
              candidates)};
  const auto present = std::ranges::count(terms, true, &Term::is_member);
  std::vector<Proposal> list;
  for (const Term& term : terms) {
    // A mass or a damping alone is simpler than a gain together with the other one.
    const bool is_alike = present == 2 || (present == 1 && &term == &terms[0]);
    if (!term.is_member || !is_alike || !(term.nominal > 0) || !(term.whole() > 0)) continue;
    if (Proposal proposal = without(term, terms, members); !proposal.added.empty())
      list.push_back(std::move(proposal));
  }
  return list;
}

double preference(const Trials& trials, const std::vector<Member>& members,
                  const std::vector<Member>& other) {
  if (members.size() != other.size() || !have_one_law(trials)) return 0;
  return criteria::same_law * (int(has_gain(other)) - int(has_gain(members)));
}

bool has_gain(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return m.candidate->name == gain_name; });
}

}  // namespace loopwright::diagnosis

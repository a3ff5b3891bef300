#include "tools/diagnose/verdict/found_parameters.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

/// "(N*m)*s/(rad)" in usual notation: parentheses only around products of several units, and not around the
/// first factor.
std::string without_idle_brackets(const std::string& unit) {
  std::string text;
  for (size_t i = 0; i < unit.size(); ++i) {
    const size_t end = unit[i] == '(' ? unit.find(')', i) : unit.npos;
    const std::string inside = end == unit.npos ? "" : unit.substr(i + 1, end - i - 1);
    const bool is_one = std::ranges::all_of(inside, [](unsigned char c) { return std::isalpha(c); });
    const bool is_raised = end + 1 < unit.size() && unit[end + 1] == '^';
    const bool idle =
        !inside.empty() && inside.find('(') == inside.npos && (is_one || (i == 0 && !is_raised));
    text += idle ? inside : std::string(1, unit[i]);
    if (idle) i = end;
  }
  return text;
}

}  // namespace

std::vector<DiagnosedParameter> parameters_of_member(const Conclusion& conclusion, size_t index,
                                                     const MachineUnits& units) {
  const Estimate& estimate = conclusion.estimate;
  std::vector<Member> members = estimate.members;
  const std::vector<FreeParameter> free = free_parameters(members);
  std::vector<DiagnosedParameter> list;
  for (size_t i = 0; i < free.size(); ++i) {
    if (free[i].member != index) continue;
    const CandidateParameter& range = range_of(members, free[i]);
    const double value = value_of(members, free[i]);
    const double half =
        1.96 * std::sqrt(std::max(0.0, estimate.covariance(Eigen::Index(i), Eigen::Index(i))));
    double low = value - half, high = value + half;
    // The fit looked for a shape nowhere else: what the rows do not determine may be anything within.
    if (!free[i].is_linear) low = std::max(low, range.low), high = std::min(high, range.high);
    list.push_back({range.name, without_idle_brackets(unit_in(range.unit, units)), value, low, high,
                    range.ends_at(value), 0, free[i].is_linear, value + half >= range.high});
  }
  if (const Member& member = members[index]; member.is_part_of_turn) {
    const CandidateParameter& pitch = member.candidate->nonlinear[0];
    const double value = member.nonlinear[0];
    list.push_back({pitch.name, without_idle_brackets(unit_in(pitch.unit, units)), value, value, value, false,
                    std::round(conclusion.turn / value)});
  }
  return list;
}

std::vector<DiagnosedParameter> wave_of_member(const Conclusion& conclusion, size_t index,
                                               const MachineUnits& units) {
  const Estimate& estimate = conclusion.estimate;
  const Candidate& candidate = *estimate.members[index].candidate;
  if (candidate.linear.size() != 2 || candidate.linear[0].name != sine_name ||
      candidate.linear[1].name != cosine_name)
    return {};
  const std::vector<FreeParameter> free = free_parameters(estimate.members);
  const auto of_member = [&](const FreeParameter& p) { return p.member == index && p.is_linear; };
  const Eigen::Index first = std::ranges::find_if(free, of_member) - free.begin();
  const Eigen::Vector2d wave(estimate.members[index].linear[0], estimate.members[index].linear[1]);
  const Eigen::Matrix2d covariance = estimate.covariance.block<2, 2>(first, first);
  const double amplitude = wave.norm(), phase = std::atan2(wave[1], wave[0]);
  const Eigen::Vector2d along = wave / amplitude, across(-along[1], along[0]);
  const double of_amplitude = 1.96 * std::sqrt(std::max(0.0, along.dot(covariance * along))),
               of_phase = 1.96 * std::sqrt(std::max(0.0, across.dot(covariance * across))) / amplitude;
  return {{"amplitude", without_idle_brackets(unit_in(candidate.linear[0].unit, units)), amplitude,
           amplitude - of_amplitude, amplitude + of_amplitude},
          {"phase", "rad", phase, phase - of_phase, phase + of_phase}};
}

}  // namespace loopwright::diagnosis

/// An effect as the diagnosis uses it: columns along a path, and the admissible values of its parameters.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/responses.h"
#include "tools/effects/effect.h"
#include "tools/effects/switched_effect.h"

namespace loopwright::diagnosis {

struct CandidateParameter {
  std::string name, unit;
  double low = 0, high = 0;
  bool logarithmic = false;  ///< scale on which it is stepped through, when nonlinear
  std::vector<double> grid;  ///< initial values of the search, when nonlinear
  double span = 0;    ///< for a period: the stroke or time over which it repeats; determines its resolution
  double centre = 0;  ///< for a period: the middle of the record, where the phase is known best
  double start = 0;   ///< a typical value
  double step = 0;    ///< that its derivative is computed with; 0: a part of its range or of its value

  /// Whether a value is at an end of the range; a fitted one is then reported as a warning, not as a result.
  bool ends_at(double value) const {
    if (logarithmic && low > 0) {
      const double edge = std::pow(high / low, criteria::share_of_end);
      return value <= low * edge || value >= high / edge;
    }
    const double edge = criteria::share_of_linear_end * (high - low);
    return value <= low + edge || value >= high - edge;
  }
};

struct Member;

/// The variable of which a force without memory is a law. One that a position gives place and that brakes
/// there too, as an end stop, is a law of the position.
enum class LawOf { several, position, velocity };

struct Candidate {
  std::string name, form;  ///< form: for an effect with several
  Acts acts = Acts::force;
  Attachment::Stage stage = Attachment::Stage::command;  ///< of Acts::input
  std::vector<CandidateParameter> linear;                ///< amplitudes
  std::vector<CandidateParameter> nonlinear;             ///< shapes
  /// Pure shape (a delay, a lag): the amplitude is the step from 0 to the shape and must be near one.
  bool amplitude_is_one = false;
  /// Scans every pitch: the first nonlinear parameter is the pitch, and the columns are its sine and cosine.
  bool is_periodic = false;
  double fine_pitch = 0;  ///< shorter ones pass within a few rows at the top speed
  AtRest at_rest = AtRest::free;
  bool flies = false;            ///< its force is zero for a while and returns with an impact
  bool is_repeatable = false;    ///< may occur more than once
  bool repeats_in_time = false;  ///< its period is in time, not in position
  bool jumps = false;            ///< at an instant, its only nonlinear parameter, which the errors tell
  LawOf law_of = LawOf::several;
  bool is_unknown = false;  ///< not from the catalogue, but any function of the variables in `form`
  /// Of shapes; otherwise the errors tell its pitch or its instant.
  bool has_grid() const { return !is_periodic && !jumps; }
  /// For several shapes together: cheaper than one after the other.
  std::function<std::vector<Columns>(const Path& path, const std::vector<std::vector<double>>& shapes)>
      columns_at;
  Columns columns(const Path& path, const std::vector<double>& shape) const {
    return std::move(columns_at(path, {shape}).front());
  }
  /// Whether computed parameters are within the ranges that their effect states; empty: it states none.
  std::function<bool(const Member& member)> is_plausible;
  /// How much of the consumed force is a mass times the acceleration of the moving part; empty: none. This
  /// part is added to the model's own mass, where it acts without delay.
  std::function<double(const Member& member)> added_inertia;
  /// One sample of a force with states of its own, if it is linear in them and the motion; empty: it is not.
  std::function<SampleMap(const Member& member)> linear_load;
  /// The same for a load that is linear only from one blow to the next.
  std::function<std::unique_ptr<SwitchedSample>(const Member& member)> switched_load;
};

/// An effect taken into the model, with its parameters.
struct Member {
  const Candidate* candidate = nullptr;
  std::vector<double> linear, nonlinear;
  /// Its pitch is a whole part of a turn, and is not fitted: see snap_to_turn().
  bool is_part_of_turn = false;

  /// Whether a nonlinear parameter is fitted; the pitch is the first one.
  bool is_free(size_t nonlinear_index) const { return !is_part_of_turn || nonlinear_index > 0; }
};

/// A delay or a lag of the input.
inline bool is_late_input(const Candidate& candidate) {
  return candidate.acts == Acts::input && candidate.amplitude_is_one;
}

/// A law of dry friction: its first amplitude is the level, as the effect file calls it. The drift of a level
/// that is there anyway is none.
inline bool is_dry_friction(const Candidate& candidate) {
  return candidate.acts == Acts::force && candidate.at_rest != AtRest::free && !candidate.is_unknown &&
         !candidate.linear.empty() && candidate.linear.front().name == "level";
}

inline bool is_among(const std::vector<const Candidate*>& list, const Candidate& candidate) {
  return std::ranges::find(list, &candidate) != list.end();
}

inline bool is_late_member(const Member& member) { return is_late_input(*member.candidate); }
inline bool has_dry_friction(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return is_dry_friction(*m.candidate); });
}

/// Of the same candidates, in any order.
inline bool are_alike(const std::vector<Member>& one, const std::vector<Member>& other) {
  return std::ranges::is_permutation(one, other, {}, &Member::candidate, &Member::candidate);
}

/// Unless the same candidates are among them.
inline void add_if_other(std::vector<std::vector<Member>>& sets, std::vector<Member> set) {
  if (std::ranges::none_of(sets, [&](const auto& other) { return are_alike(other, set); }))
    sets.push_back(std::move(set));
}

/// Whether it makes a part of the mass move by itself.
inline bool is_own_load(const Member& member) {
  const Candidate& candidate = *member.candidate;
  return !candidate.nonlinear.empty() && candidate.added_inertia && candidate.added_inertia(member) < 0;
}

/// Whether a parameter is at an end of its range.
inline bool is_at_limit(const Member& member) {
  const Candidate& candidate = *member.candidate;
  for (size_t i = 0; i < member.linear.size() && !candidate.amplitude_is_one; ++i)
    if (candidate.linear[i].ends_at(member.linear[i])) return true;
  for (size_t i = 0; i < member.nonlinear.size(); ++i)
    if (member.is_free(i) && candidate.nonlinear[i].ends_at(member.nonlinear[i])) return true;
  return false;
}

}  // namespace loopwright::diagnosis

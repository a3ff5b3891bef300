#include "tools/diagnose/search/noisy_input.h"
#include <algorithm>
#include <array>
#include <limits>

namespace loopwright::diagnosis {
namespace {

/// Takes a share of what the input is above its mean over some rows away from it.
Candidate unfelt_noise(RowsOfMean side) {
  Candidate candidate;
  candidate.name = "unfelt_noise", candidate.acts = Acts::input;
  candidate.linear = {{"share", "1", 0, 1.2, false, {}}};
  candidate.nonlinear = {{"rows", "1", 0.5, 300, true, {2, 8, 32}}};
  candidate.columns_at = [side](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result;
    for (const std::vector<double>& shape : shapes) {
      const std::vector<double> mean = mean_over_rows(path.input, shape[0], side);
      std::vector<float> above(mean.size());
      for (size_t k = 0; k < above.size(); ++k) above[k] = float(path.input[k] - mean[k]);
      result.push_back({Column(std::move(above))});
    }
    return result;
  };
  return candidate;
}

/// One of each kind, for as long as the members that refer to it.
const Candidate& smoothing(RowsOfMean side) {
  static const Candidate about = unfelt_noise(RowsOfMean::about), after = unfelt_noise(RowsOfMean::after);
  return side == RowsOfMean::about ? about : after;
}

double loss_of(const Trials& trials, const Estimate& e, size_t catalogue) {
  return e.is_valid ? criterion(trials, e, catalogue) : std::numeric_limits<double>::infinity();
}

/// Sets of members beside a smoothed input, each with its own noise.
class Smoothed {
 public:
  Smoothed(Trials& trials, const Estimate& found, std::vector<Member> others, size_t catalogue)
      : trials_(trials), found_(found), others_(std::move(others)), catalogue_(catalogue) {}

  Estimate with(std::vector<Member> members) {
    members.insert(members.begin(), others_.begin(), others_.end());
    return fitted(members, found_);
  }
  /// The measured input as it is, also with what the fits of a smoothed one made of the others and of the
  /// noise: that is no gain of smoothing.
  Estimate with_nothing(std::initializer_list<const Estimate*> starts) {
    Estimate best = with(std::vector<Member>{});
    for (const Estimate* start : starts) {
      if (!start->is_valid) continue;
      std::vector<Member> others(start->members.begin(), start->members.end() - 1);
      Estimate trial = fit_members(trials_, std::move(others), start->noise, start->motion, iterations);
      if (loss_of(trials_, trial, catalogue_) < loss_of(trials_, best, catalogue_)) best = std::move(trial);
    }
    return best;
  }
  /// From the best of the starts.
  Estimate with(const Candidate& smoothing) {
    Estimate best;
    for (const double rows : smoothing.nonlinear[0].grid) {
      Estimate trial = with({Member{&smoothing, {0.5}, {rows}}});
      if (loss_of(trials_, trial, catalogue_) < loss_of(trials_, best, catalogue_)) best = std::move(trial);
    }
    return best;
  }

 private:
  static constexpr int iterations = 6;

  Estimate fitted(const std::vector<Member>& members, const Estimate& start) {
    return with_own_noise(trials_, fit_members(trials_, members, start.noise, start.motion, iterations),
                          iterations);
  }

  Trials& trials_;
  const Estimate& found_;
  std::vector<Member> others_;
  size_t catalogue_;
};

/// In place of what is late.
struct Replacements {
  Estimate nothing, about, after;  ///< the input as it is; smoothed about each row, or over those after it
};
/// Empty: nothing is late.
std::optional<Replacements> replacements_of_late_input(Trials& trials, const Estimate& found,
                                                       size_t catalogue) {
  std::vector<Member> others = found.members;
  if (trials.has_map() || std::erase_if(others, is_late_member) == 0) return {};
  std::erase_if(others, is_own_load);  // which a wrong lag calls for
  Smoothed smoothed(trials, found, std::move(others), catalogue);
  Replacements by;
  by.about = smoothed.with(smoothing(RowsOfMean::about));
  if (!by.about.is_valid) return {};
  by.after = smoothed.with(smoothing(RowsOfMean::after));
  by.nothing = smoothed.with_nothing({&by.about, &by.after});
  return by;
}

}  // namespace

std::optional<InputCorrection> noise_instead_of_late_input(Trials& trials, const Estimate& found,
                                                           size_t catalogue) {
  const auto by = replacements_of_late_input(trials, found, catalogue);
  if (!by) return {};
  const auto loss = [&](const Estimate& e) { return loss_of(trials, e, catalogue); };
  const double of_late = loss(found), of_nothing = loss(by->nothing);
  const bool gains_early =
      of_nothing - loss(by->after) > criteria::least_gain_of_early_input * (of_nothing - of_late);
  if (!gains_early && loss(by->about) >= of_late) return {};
  const Member& smoothing = by->about.members.back();
  if (smoothing.linear[0] < criteria::least_unfelt_share) return {};
  const AxisRecord& record = trials.list.front().model->record();
  return InputCorrection{smoothing.nonlinear[0], smoothing.linear[0], record.leaps, record.rows_late};
}

bool measure_position(const Trials& trials) {
  return std::ranges::all_of(trials.list,
                             [](const Trial& t) { return t.model->record().find("position") != nullptr; });
}

bool smoothing_gains(Trials& trials, const Estimate& found, size_t catalogue) {
  const auto by = replacements_of_late_input(trials, found, catalogue);
  if (!by) return false;
  const double least = criteria::least_gain_of_early_input * (by->nothing.misfit() - found.misfit());
  return std::ranges::any_of(std::array{&by->about, &by->after}, [&](const Estimate* smoothed) {
    return by->nothing.misfit() - smoothed->misfit() > least;
  });
}

}  // namespace loopwright::diagnosis

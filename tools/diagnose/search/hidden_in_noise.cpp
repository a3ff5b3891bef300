#include "tools/diagnose/search/hidden_in_noise.h"
#include <fmt/format.h>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/names.h"

namespace loopwright::diagnosis {
namespace {

double size_of(const Noise& noise) { return std::hypot(noise.white, noise.slow()); }

}  // namespace

std::optional<Estimate> hidden_in_noise(Trials& trials, const Estimate& found,
                                        const std::vector<Candidate>& unknown, size_t catalogue,
                                        std::vector<std::string>& trail) {
  constexpr int iterations = 8;
  std::optional<Estimate> best;
  if (!found.is_valid || has_function_without_name(found.members)) return best;
  double least = criteria::least_gain_without_name;
  for (const Candidate& function : unknown) {
    if (!function.has_grid() || trials.work->is_spent(criteria::work_with_rivals)) continue;
    const size_t levels = function.linear.size();
    std::vector<Member> members = found.members;
    members.push_back({&function, std::vector<double>(levels), {}});
    Estimate with = fit_members(trials, std::move(members), found.noise, found.motion, 1);
    // Even the noise that hides it does not hide all of it.
    if (!with.is_valid || found.profile - with.profile < criteria::least_gain_of_level * double(levels))
      continue;
    with = with_own_noise(trials, std::move(with), iterations);
    const double gain =
        with.is_valid ? criterion(trials, found, catalogue) - criterion(trials, with, catalogue) : 0;
    const double left = size_of(with.noise) / size_of(found.noise);
    trail.push_back(fmt::format("in the noise, a function of {}: criterion {:+.1f}, leaves {:.2f} of it",
                                function.form, -gain, left));
    if (gain > least && left < criteria::most_noise_left) least = gain, best = std::move(with);
  }
  return best;
}

}  // namespace loopwright::diagnosis

#include "tools/diagnose/verdict/smooth_share.h"
#include <algorithm>
#include "models/statistics/smoother.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

double smooth_share(std::span<const double> signal, std::span<const double> variable, size_t levels,
                    size_t block, std::span<const double> side) {
  const Hats hats = Hats::between_quantiles(variable, levels);
  CrossValidation validation{{}, hats.count() * (side.empty() ? 1 : 2), {}, criteria::folds};
  for (size_t i = 0; i < signal.size(); ++i) {
    Hats::Place place = hats.at(variable[i]);
    if (!side.empty() && side[i] < 0) place.knot += hats.count();
    validation.places.push_back(place), validation.fold.push_back(i / block % criteria::folds);
  }
  return signal.empty() ? 0 : std::max(0.0, validation.share_of(signal));
}

}  // namespace loopwright::diagnosis

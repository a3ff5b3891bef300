/// Whether a slow disturbance is no noise.
#pragma once
#include <optional>
#include <string>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// What a disturbance follows along the record.
struct FollowedSignal {
  std::string name;  ///< "arm.position", or "arm.position and the direction of arm.velocity"
  double share;      ///< of its mean square, in rows to which the function of that signal was not fitted
};

/// The signal of the diagram that the disturbance with this number among those of the noise follows best, if
/// enough of it: noise follows none over a whole record, an effect does. Each fold is one stretch of the
/// record, because rows beside each other are alike in any slow noise.
std::optional<FollowedSignal> followed_signal(SiteFitter& fitter, SiteHypothesis hypothesis,
                                              size_t disturbance);

}  // namespace loopwright::diagnosis

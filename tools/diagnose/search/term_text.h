/// A term in words.
#pragma once
#include <string>
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis {

/// As in "net.sum: square(rotor.velocity)".
std::string describe(const SiteModel& model, const SiteTerm& term);

}  // namespace loopwright::diagnosis

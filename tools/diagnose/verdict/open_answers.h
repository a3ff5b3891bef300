/// Answers that stand for something else, as the answer itself shows.
#pragma once
#include <string>
#include "tools/diagnose/diagnosis.h"

namespace loopwright::diagnosis {

/// A sensor that is off by c x² takes the force M (2 c x a + 2 c v²) of a mass M for motion. An inertia
/// M (1 + 2 c x), as of a linkage or a drum, asks for M (2 c x a + c v²), and a force constant that falls
/// along the way for M 2 c x a: beside a drag that has the sign of the direction they are the same law.
/// Empty: no such set was named.
std::string why_sensor_is_open(const Diagnosis& diagnosis);

/// Of effects that are all optional nothing is written, so that the forces must not balance worse with them:
/// see criteria::worse_balance. Empty: one is necessary, or they do not.
std::string why_optional_effects_are_open(const Diagnosis& diagnosis);

}  // namespace loopwright::diagnosis

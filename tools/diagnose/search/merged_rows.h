/// A command that comes late by a few rows, each of which stands for several recorded ones.
#pragma once
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

/// Whether it is a delay or a lag of so few of these rows that it may be the other one: see
/// criteria::rows_that_blur.
bool is_blurred(const Trials& trials, const Member& member);

/// Whether it is a delay or a lag of about one of these rows, and smaller than the noise of the force. Within
/// a row the controller has already answered to that noise, before the row shows it; such an answer looks
/// like a command that comes late, and is no finding.
bool is_feigned_within_rows(const Trials& trials, const Estimate& estimate, size_t member,
                            const Weight& weight);

}  // namespace loopwright::diagnosis

/// An input that was measured, with noise that the machine does not feel.
#pragma once
#include <optional>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// A lag or a delay that was found may only average the noise of a measured input: then an input of which a
/// part of the fast changes is taken away, without any delay, explains the records better, because it is
/// averaged over the rows after each as well; or an input that is too early by as much gains nearly as much
/// as the late one. A command that the machine obeys loses by either. Empty: nothing is late, or it truly is.
std::optional<InputCorrection> noise_instead_of_late_input(Trials& trials, const Estimate& found,
                                                           size_t catalogue);

/// Whether every record measures the position. A controller that does knows more than a record of the
/// velocity alone, and what it answers to noise resembles an input that is late.
bool measure_position(const Trials& trials);

/// Whether an input that is smoothed, and so reduces noise without being late, gains a large part of what the
/// late one does: the answer of a controller to noise resembles a small delay.
bool smoothing_gains(Trials& trials, const Estimate& found, size_t catalogue);

}  // namespace loopwright::diagnosis

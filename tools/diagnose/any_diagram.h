/// The diagnosis of any diagram, without roles: docs/diagnose.md, "Any diagram".
#pragma once
#include "tools/diagnose/diagnose.h"

namespace loopwright {

/// One experiment. Throws InputError with every problem.
Diagnosis diagnose_any_diagram(const std::string& diagram, const std::string& experiment,
                               const DiagnoseOptions& options);

}  // namespace loopwright

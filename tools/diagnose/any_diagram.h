/// The diagnosis of any diagram, without roles: docs/diagnose.md, "Any diagram".
#pragma once
#include "tools/diagnose/diagnose.h"

namespace loopwright {

/// Throws InputError with every problem.
Diagnosis diagnose_any_diagram(const std::string& diagram, const std::vector<std::string>& experiments,
                               const DiagnoseOptions& options);

}  // namespace loopwright

/// Whether an improved diagram can be run along the records, before it is written.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/improvement.h"

namespace loopwright::diagnosis {

/// Why it is not written: it cannot be run, or diverges where the user's diagram does not. Nothing if it can.
std::optional<std::string> why_not_run(const Improvement& improved,
                                       const std::shared_ptr<const SourceFile>& nominal,
                                       const std::vector<std::shared_ptr<const Experiment>>& experiments,
                                       const LoadOptions& load);

/// Whether there is no such reason; otherwise it becomes a finding.
bool is_usable(const Improvement& improved, const std::shared_ptr<const SourceFile>& nominal,
               const std::vector<std::shared_ptr<const Experiment>>& experiments, const LoadOptions& load,
               Diagnosis& result);

/// To the file of the options.
void write_improved(const Improvement& improved, const DiagnoseOptions& options, Diagnosis& result);

}  // namespace loopwright::diagnosis

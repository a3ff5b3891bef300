/// A model compared with several records of the same machine.
#pragma once
#include "tools/compare/compare.h"

namespace loopwright {

struct SeveralComparisons {
  std::vector<std::string> experiments;
  std::vector<Comparison> records;
  std::vector<RecordFault> faults;            ///< of the records together: see faults_of
  std::vector<Identifiability> identifiable;  ///< from the records together
};

/// Each record by itself, and what they contain together. Throws InputError with every problem of diagram and
/// experiments.
SeveralComparisons compare(const std::string& diagram, const std::vector<std::string>& experiments,
                           const LoadOptions& options = {}, const RunOptions& run_options = {});

/// For one record the same as of its comparison. For several: records[], each with "experiment" and the keys
/// of a comparison, and together.{signals.<name>.rmse,force_residual.rmse,faults,effects}.
std::string to_json(const SeveralComparisons& several);
std::string to_text(const SeveralComparisons& several);
report::Page comparison_page(const SeveralComparisons& several, const std::string& title);

}  // namespace loopwright

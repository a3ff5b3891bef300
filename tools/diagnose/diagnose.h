/// Which physical effect a diagram lacks, as far as records of the real axis can show.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "tools/diagnose/diagnosis.h"

namespace loopwright {

struct DiagnoseOptions {
  LoadOptions load;  ///< --set, --variant
  std::vector<std::string>
      catalogues;  ///< folders with effect files; empty: the catalogue of the installation
  std::vector<std::string> more_catalogues;  ///< folders with further effect files
  std::string improved_diagram;              ///< path of the diagram with the effects; empty: not written
  bool writes_all = false;                   ///< also the optional effects
  std::function<void(const char* stage, double done)> progress;
  /// Told of every set of effects that the search accepts, with the force that it leaves in the fitted rows.
  std::function<void(const std::vector<std::string>& effects, double force)> found;
  std::optional<double> most_work;  ///< [operations] where the search ends, if not as in criteria.h
  const std::atomic<bool>* interrupt = nullptr;  ///< once true, the diagnosis ends soon, without a verdict
};

/// Throws InputError with every problem of diagram, experiments and effects.
Diagnosis diagnose(const std::string& diagram, const std::vector<std::string>& experiments,
                   const DiagnoseOptions& options = {});

}  // namespace loopwright

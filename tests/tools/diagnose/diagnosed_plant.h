/// The answer about the record of a plant, without roles.
#pragma once
#include <cstdio>
#include <cstdlib>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plants.h"

namespace loopwright {

/// With SHOW_DIAGNOSES in the environment the search and the answer are printed.
inline Diagnosis diagnosed(const Plant& plant) {
  const RecordedPlant files(plant);
  const Diagnosis d = diagnose(files.diagram(), {files.experiment()});
  if (getenv("SHOW_DIAGNOSES")) {
    for (const std::string& line : d.trail) puts(line.c_str());
    puts(to_text(d).c_str());
  }
  return d;
}

/// "site: effect(variables)" of everything found.
inline std::vector<std::string> terms(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const DiagnosedEffect& e : d.effects)
    list.push_back(fmt::format("{}: {}({})", e.site, e.name, fmt::join(e.variables, ", ")));
  return list;
}
/// Of the record, with what each costs.
inline std::vector<std::string> findings(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const RecordFinding& f : d.findings) list.push_back(f.what + "; " + f.cost);
  return list;
}

}  // namespace loopwright

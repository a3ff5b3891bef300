/// The vendor's library, loaded while the program runs: nothing of it is needed to build.
#pragma once
#include <string>
#include <vector>
#include "hw/quanser/hil_functions.h"

namespace loopwright::hw::quanser {

struct Library {
  HilFunctions functions;
  std::string path;                  ///< under which it was found
  std::string file;                  ///< the file itself
  std::vector<std::string> missing;  ///< optional functions that it lacks
};

/// What was tried, and why each did not serve.
struct LibraryProblem {
  std::string message;
  std::string found;
  std::string hint;
};

/// Which file load_library would load, and who says so: to be told before its code runs. Loads nothing.
std::string library_to_load(const std::string& named);

/// $HIL_LIBRARY, else `named` (of a device file), else the usual names and places. Loaded once and never
/// unloaded: drivers keep threads. False: `problem` says why.
bool load_library(const std::string& named, Library& library, LibraryProblem& problem);

}  // namespace loopwright::hw::quanser

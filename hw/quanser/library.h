/// The vendor's library, loaded at run time: it is not needed to build.
#pragma once
#include <string>
#include <vector>
#include "hw/quanser/hil_functions.h"

namespace loopwright::hw::quanser {

struct Library {
  HilFunctions functions;
  std::string path;                  ///< name under which it was found
  std::string file;                  ///< the file itself
  std::vector<std::string> missing;  ///< optional functions that are missing
};

/// What was tried, and why each attempt failed.
struct LibraryProblem {
  std::string message;
  std::string found;
  std::string hint;
};

/// The file that load_library would load, and what selected it: shown before its code runs. Loads nothing.
std::string library_to_load(const std::string& named);

/// $HIL_LIBRARY, else `named` (by a device file), else the usual names and folders. Loaded once and never
/// unloaded, because drivers keep threads. False: `problem` states why.
bool load_library(const std::string& named, Library& library, LibraryProblem& problem);

}  // namespace loopwright::hw::quanser

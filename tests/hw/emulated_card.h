/// The emulated card inside this process, accessed directly: settings and observations of tests.
#pragma once
#include <dlfcn.h>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>
#include "tests/engine/diagram/diagram_folder.h"
#include "where.h"

namespace loopwright::hw {

/// A library of this build by its short name, "hil_emulator".
inline std::string emulator_library(const std::string& name = "hil_emulator") {
  return LOOPWRIGHT_BINARY "/lib/lib" + name + ".so";
}

/// A copy of the emulator's library that this process and its children alone load. The product names other
/// processes that have the library loaded: with the copy, those of tests that run at the same time are none.
inline const std::string& own_emulator_library() {
  static const DiagramFolder folder;
  static const std::string copy = [] {
    const std::string path = folder.path("libhil_emulator.so");
    std::filesystem::copy_file(emulator_library(), path);
    return path;
  }();
  return copy;
}

class EmulatedCard {
 public:
  /// Loads the library, sets HIL_LIBRARY to it and starts a new world in virtual time.
  explicit EmulatedCard(const std::string& path = emulator_library()) {
    setenv("HIL_LIBRARY", path.c_str(), 1);
    unsetenv("HIL_EMU"), unsetenv("HIL_EMU_SHARED");
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(dlerror());
    set_ = reinterpret_cast<int (*)(const char*, double)>(dlsym(library, "hil_emu_set"));
    get_ = reinterpret_cast<double (*)(const char*)>(dlsym(library, "hil_emu_get"));
    calls_ = reinterpret_cast<int (*)(char*, size_t)>(dlsym(library, "hil_emu_calls"));
    options_ = reinterpret_cast<int (*)(char*, size_t)>(dlsym(library, "hil_emu_options"));
    set("reset", 0);
  }
  void set(const char* name, double value) const {
    if (!set_(name, value)) throw std::invalid_argument(name);
  }
  double get(const char* name) const { return get_(name); }
  /// Names of the exported functions that were called, in order, including repetitions.
  std::vector<std::string> calls() const {
    std::string text(1 << 17, 0);
    calls_(text.data(), text.size());
    std::vector<std::string> names;
    std::stringstream stream(text.c_str());
    for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
    return names;
  }
  /// The text of the card's options, and the size that was passed with it.
  std::pair<std::string, int> options() const {
    char text[2048];
    const int size = options_(text, sizeof text);
    return {text, size};
  }

 private:
  int (*set_)(const char*, double);
  double (*get_)(const char*);
  int (*calls_)(char*, size_t);
  int (*options_)(char*, size_t);
};

}  // namespace loopwright::hw

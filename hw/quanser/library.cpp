#include "hw/quanser/library.h"
#include "engine/file/regular_file.h"
#include <fmt/format.h>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#include <elf.h>
#endif

namespace loopwright::hw::quanser {
namespace {

#ifdef _WIN32
const std::vector<std::string> usual_places{"hil.dll", "C:\\Program Files\\Quanser\\HIL SDK\\bin\\hil.dll"};
void* open_library(const std::string& path, std::string& why) {
  // The loader would block on a pipe until it is written. A bare name is searched for in the system's
  // folders.
  if (path.find('/') != path.npos)
    if (const std::string reason = why_not_regular(path);
        !reason.empty() && reason != "there is no such file") {
      why = path + ": " + reason;
      return nullptr;
    }
  void* handle = LoadLibraryA(path.c_str());
  if (!handle) why = fmt::format("error {} of LoadLibrary", GetLastError());
  return handle;
}
void* find_symbol(void* handle, const char* name) {
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle), name));
}
std::string other_architecture(const std::string&) { return ""; }
std::string file_of(void*, const std::string& path) { return path; }
#else
#ifdef __aarch64__
constexpr int own_machine = EM_AARCH64;
const std::string multiarch = "aarch64-linux-gnu";
#else
constexpr int own_machine = EM_X86_64;
const std::string multiarch = "x86_64-linux-gnu";
#endif
const std::vector<std::string> usual_places{
    "libhil.so.1", "libhil.so", "/usr/lib/" + multiarch + "/libhil.so.1",
    "/opt/quanser/hil_sdk/lib/libhil.so", "/opt/quanser/lib/libhil.so"};

/// Also loads libraries whose own dependencies must be loaded by the program.
void* open_library(const std::string& path, std::string& why) {
  if (void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  why = dlerror();
  if (why.find("undefined symbol") == why.npos) return nullptr;
  dlopen("libquanser_common.so.1", RTLD_NOW | RTLD_GLOBAL);
  dlopen("libquanser_runtime.so.1", RTLD_NOW | RTLD_GLOBAL);
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) why = dlerror();
  return handle;
}

/// The message functions may be in a separate library.
void* find_symbol(void* handle, const char* name) {
  if (void* symbol = dlsym(handle, name)) return symbol;
  if (std::strncmp(name, "msg_", 4) != 0) return nullptr;
  void* common = dlopen("libquanser_common.so.1", RTLD_NOW | RTLD_LOCAL);
  return common ? dlsym(common, name) : nullptr;
}

/// The file in which the loader found the symbol.
std::string file_of(void* symbol, const std::string& path) {
  Dl_info info{};
  return dladdr(symbol, &info) && info.dli_fname ? info.dli_fname : path;
}

/// For a library built for another processor the loader reports "no such file". Empty: it is built for this
/// processor, or it is not a library.
std::string other_architecture(const std::string& path) {
  Elf64_Ehdr header{};
  if (!why_not_regular(path).empty()) return "";
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return "";
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    return "no shared library (its first bytes are not those of one)";
  if (header.e_ident[EI_CLASS] != ELFCLASS64) return "a library for a 32-bit processor";
  if (header.e_machine == own_machine) return "";
  return fmt::format("a library for another processor (machine {} instead of {})", header.e_machine,
                     own_machine);
}
#endif

std::vector<std::string> places(const std::string& named) {
  if (const char* variable = std::getenv("HIL_LIBRARY"); variable && *variable) return {variable};
  if (!named.empty()) return {named};
  return usual_places;
}

/// Names of required functions that are missing.
std::vector<std::string> resolve(void* handle, Library& library) {
  std::vector<std::string> required;
#define LOOPWRIGHT_HIL_RESOLVE(name, missing)                                               \
  library.functions.name = reinterpret_cast<signatures::name*>(find_symbol(handle, #name)); \
  if (!library.functions.name) missing.push_back(#name);
#define LOOPWRIGHT_HIL_REQUIRED(name, ...) LOOPWRIGHT_HIL_RESOLVE(name, required)
#define LOOPWRIGHT_HIL_OPTIONAL(name, ...) LOOPWRIGHT_HIL_RESOLVE(name, library.missing)
  LOOPWRIGHT_HIL_FUNCTIONS(LOOPWRIGHT_HIL_REQUIRED, LOOPWRIGHT_HIL_OPTIONAL)
#undef LOOPWRIGHT_HIL_OPTIONAL
#undef LOOPWRIGHT_HIL_REQUIRED
#undef LOOPWRIGHT_HIL_RESOLVE
  return required;
}

}  // namespace

std::string library_to_load(const std::string& named) {
  const std::vector<std::string> tried = places(named);
  if (const char* variable = std::getenv("HIL_LIBRARY"); variable && *variable)
    return fmt::format("{} (HIL_LIBRARY)", tried.front());
  if (!named.empty()) return fmt::format("{} (\"library\" in the device file)", tried.front());
  return fmt::format("the first that is there of {}", fmt::join(tried, ", "));
}

bool load_library(const std::string& named, Library& library, LibraryProblem& problem) {
  library = {};
  const std::vector<std::string> tried = places(named);
  for (const std::string& path : tried) {
    std::string why;
    void* handle = open_library(path, why);
    if (!handle) {
      const std::string other = other_architecture(path);
      problem.found +=
          fmt::format("{}{}", problem.found.empty() ? "" : "; ", other.empty() ? why : path + " is " + other);
      continue;
    }
    const std::vector<std::string> lacks = resolve(handle, library);
    library.path = path;
    library.file = file_of(reinterpret_cast<void*>(library.functions.hil_open), path);
    if (lacks.empty()) return true;
    problem.message = fmt::format("{} lacks functions that are needed", path);
    problem.found = fmt::format("no {}", fmt::join(lacks, ", "));
    problem.hint = "is it the library of the card's vendor, in a version that is not too old?";
    return false;
  }
  problem.message = "the library of the card's vendor cannot be loaded";
  problem.hint =
      "install the vendor's SDK, or say where it is: \"library\" in the device file, or HIL_LIBRARY";
  return false;
}

}  // namespace loopwright::hw::quanser

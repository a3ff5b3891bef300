#include "hw/quanser/card_in_use.h"
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include "hw/quanser/errors.h"

namespace loopwright::hw::quanser {
namespace {

/// The path that the process list shows for a file that a process has mapped.
std::string real_path(const std::string& path) {
  std::error_code code;
  const auto real = std::filesystem::canonical(path, code);
  return code ? path : real.string();
}

bool has_mapped(const std::filesystem::path& process, const std::string& path) {
  std::ifstream maps(process / "maps");
  for (std::string line; std::getline(maps, line);)
    if (line.ends_with(path)) return true;
  return false;
}

/// The command line of a process, in one line of limited length.
std::string command_line(const std::filesystem::path& process) {
  std::ifstream file(process / "cmdline");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  constexpr size_t longest = 200;
  text.resize(std::min(text.size(), longest));
  while (!text.empty() && text.back() == 0) text.pop_back();
  for (char& c : text)
    if (c >= 0 && c < ' ') c = ' ';
  return text;
}

}  // namespace

std::vector<std::string> processes_with(const std::string& library) {
  std::vector<std::string> found;
  const std::string path = real_path(library);
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", code)) {
    const std::string name = entry.path().filename();
    int process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    if (error != std::errc{} || end != name.data() + name.size() || process == getpid()) continue;
    if (has_mapped(entry.path(), path))
      found.push_back(fmt::format("{} ({})", process, command_line(entry.path())));
  }
  return found;
}

std::string who_has(const Settings& settings, const Library& library, int32_t native) {
  const std::vector<std::string> others = processes_with(library.file);
  const std::string users =
      others.empty()
          ? "No other process that can be seen has the vendor's library loaded: a program that was killed "
            "may have left the card open, or it belongs to another user or another computer. When you are "
            "sure that nothing drives it, --take-over opens it"
          : fmt::format("The vendor's library is loaded in process {}: end that one first",
                        fmt::join(others, "; "));
  return fmt::format("card {} {} ({}, {}). Nothing of it was touched. {}", settings.board,
                     settings.identifier, native, error_name(native), users);
}

}  // namespace loopwright::hw::quanser

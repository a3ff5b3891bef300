#include "tools/studio/session/left_over.h"
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "tools/studio/session/draft.h"

namespace loopwright::studio {
namespace {

namespace fs = std::filesystem;

std::string program_of(std::string_view process) {
  std::ifstream file(fmt::format("/proc/{}/comm", process));
  std::string name;
  std::getline(file, name);
  return name;
}

/// Another program may have got the number of a studio that ended.
bool is_gone(int process) {
  if (::kill(process, 0) != 0 && errno == ESRCH) return true;
  return program_of(std::to_string(process)) != program_of("self");
}

std::optional<int> whole(std::string_view text) {
  int number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  return code == std::errc() && end == text.data() + text.size() && number >= 0 ? std::optional(number)
                                                                                : std::nullopt;
}

std::optional<std::string> text_of(const std::string& path) {
  std::error_code code;
  if (fs::symlink_status(path, code).type() != fs::file_type::regular) return {};
  std::ostringstream text;
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  return text.str();
}

std::string time_of(const std::string& path) {
  std::error_code code;
  const auto time = fs::last_write_time(path, code);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(fs::file_time_type::clock::to_sys(time));
  return code ? "" : fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(seconds));
}

std::string path_of(const Folder& folder, const LeftOver& left) { return folder.path() + "/" + left.file; }

/// f(file below the folder) for every hidden file.
template <class F> void each_hidden(const Folder& folder, F&& f) {
  constexpr int deepest = 8;
  std::error_code code;
  for (fs::recursive_directory_iterator i(folder.path(), fs::directory_options::skip_permission_denied, code),
       end;
       !code && i != end; i.increment(code)) {
    const std::string name = i->path().filename().string();
    std::error_code own;
    const bool is_foreign = name.starts_with('.') && name != ".loopwright";
    if (i->is_directory(own) && (is_foreign || name == "node_modules" || i.depth() >= deepest))
      i.disable_recursion_pending();
    else if (name.starts_with('.') && i->is_regular_file(own) && !i->is_symlink(own))
      f(i->path().lexically_relative(folder.path()));
  }
}

}  // namespace

std::optional<std::string> owner_of_left_over(const std::string& name) {
  constexpr std::string_view mark = ".studio-";
  const size_t at = name.rfind(mark);
  if (!name.starts_with('.') || at == name.npos || at < 2) return {};
  const std::string_view numbers = std::string_view(name).substr(at + mark.size());
  const size_t dash = numbers.find('-');
  if (dash == numbers.npos) return {};
  const auto process = whole(numbers.substr(0, dash)), count = whole(numbers.substr(dash + 1));
  if (!process || !count || *process == 0 || !is_gone(*process)) return {};
  return name.substr(1, at - 1);
}

std::vector<LeftOver> take_left_over(const Folder& folder) {
  std::vector<LeftOver> list;
  each_hidden(folder, [&](const fs::path& file) {
    const auto owner = owner_of_left_over(file.filename().string());
    if (!owner) return;
    LeftOver left{file.generic_string(), (file.parent_path() / *owner).generic_string(), "", ""};
    const auto text = text_of(path_of(folder, left));
    if (!text) return;
    left.text = *text, left.when = time_of(path_of(folder, left));
    std::optional<std::string> present;
    try {
      present = folder.read(left.path);
    } catch (const Refused&) {  // no file that is served
    }
    if (present == left.text)
      remove_left_over(folder, left);
    else
      list.push_back(std::move(left));
  });
  std::ranges::sort(list, {}, &LeftOver::file);
  return list;
}

bool remove_left_over(const Folder& folder, const LeftOver& left) {
  std::error_code code;
  const std::string path = path_of(folder, left);
  return text_of(path) == left.text && fs::remove(path, code);
}

}  // namespace loopwright::studio

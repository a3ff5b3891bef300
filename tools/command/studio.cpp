#include "tools/studio/studio.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#include <filesystem>
#include <thread>
#include "tools/command/command.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;

struct StudioArguments {
  std::string path = ".";
  std::vector<std::string> libraries;
  int port = 0;
  bool no_open = false;
};

/// Asks the desktop to open the page; without a desktop the user opens the address that was printed.
void open_in_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  const pid_t child = ::fork();
  if (child == 0) {
    if (::fork() == 0) {  // the browser outlives this program
      ::setsid();
      const int nothing = ::open("/dev/null", O_RDWR);
      for (int stream : {0, 1, 2}) ::dup2(nothing, stream);
      ::execlp("xdg-open", "xdg-open", address.c_str(), static_cast<char*>(nullptr));
    }
    ::_exit(0);
  }
  if (child > 0) ::waitpid(child, nullptr, 0);
}

int run(const StudioArguments& a) {
  Problems problems;
  for (const std::string& library : a.libraries) load_block_library(library, problems);
  const bool is_folder = fs::is_directory(a.path);
  if (!is_folder && !fs::exists(a.path))
    problems.error({}, "", "", fmt::format("\"{}\" is not there", a.path)).expected =
        "a folder, or a diagram in it";
  if (problems.has_errors()) throw InputError(std::move(problems));
  const fs::path parent = fs::path(a.path).parent_path();
  const std::string folder = is_folder ? a.path : parent.empty() ? "." : parent.string();
  studio::Studio studio(folder, is_folder ? "" : fs::path(a.path).filename().string(), a.port);
  answer("{}\n", studio.server().address());
  finish_answers();
  tell("The studio serves {} on this machine; open the address above, once. Ctrl-C ends it.\n", folder);
  if (!a.no_open) open_in_browser(studio.server().address());
  std::atomic<bool> is_over{false};
  std::thread watcher([&] {
    constexpr auto pause = std::chrono::milliseconds(200);
    while (!interruption() && !is_over) std::this_thread::sleep_for(pause);
    studio.server().stop();
  });
  studio.server().run();
  is_over = true;
  watcher.join();
  return interruption() ? interrupted : done;
}

}  // namespace

void add_studio(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("studio", "See, edit and run diagrams in the browser, beside measurements");
  auto a = std::make_shared<StudioArguments>();
  command->add_option("path", a->path, "A folder, or a diagram in it; the present folder if left out")
      ->type_name("DIR|FILE");
  command->add_option("--port", a->port, "Port on this machine; any free one if left out")
      ->check(CLI::Range(0, 65535));
  command->add_option("--blocks", a->libraries, "Shared library with more blocks")
      ->type_name("FILE.so")
      ->allow_extra_args(false);
  command->add_flag("--no-open", a->no_open, "Do not open the browser");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright

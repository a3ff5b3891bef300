#include "tools/report/child_process.h"
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace loopwright::report {
namespace {

/// A file in memory. Unlike a pipe it never fills up, so neither side waits for the other.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("child", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  bool fill(std::string_view text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = write(descriptor_, text.data() + done, text.size() - done);
      if (count <= 0) return false;
      done += static_cast<std::size_t>(count);
    }
    return lseek(descriptor_, 0, SEEK_SET) == 0;
  }

  std::string content() const {
    std::string text;
    char buffer[65536];
    for (ssize_t count;
         (count = pread(descriptor_, buffer, sizeof buffer, static_cast<off_t>(text.size()))) > 0;)
      text.append(buffer, static_cast<std::size_t>(count));
    return text;
  }

 private:
  int descriptor_;
};

/// Waits for the end of a child; false on timeout.
bool ends_within(pid_t child, std::chrono::milliseconds time_limit) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  if (handle < 0) return true;  // cannot monitor it: the caller waits without a limit
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  pollfd watched{handle, POLLIN, 0};
  int ready = 0;
  do {
    const auto rest =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    ready = poll(&watched, 1, static_cast<int>(std::max<std::int64_t>(0, rest.count())));
  } while (ready < 0 && errno == EINTR);
  close(handle);
  return ready > 0;
}

pid_t start(const std::vector<std::string>& arguments, int input, int output, int errors, int& error) {
  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  pid_t child = -1;
  error = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return child;
}

}  // namespace

ChildResult run_program(const std::vector<std::string>& arguments, std::string_view input,
                        std::chrono::milliseconds time_limit) {
  const std::string& name = arguments.at(0);
  MemoryFile in, out, errors;
  if (in.descriptor() < 0 || out.descriptor() < 0 || errors.descriptor() < 0 || !in.fill(input))
    return {false, {}, fmt::format("no memory to talk to {}: {}", name, std::strerror(errno))};

  int error = 0;
  const pid_t child = start(arguments, in.descriptor(), out.descriptor(), errors.descriptor(), error);
  if (error) return {false, {}, fmt::format("{} could not be started: {}", name, std::strerror(error))};

  const bool in_time = ends_within(child, time_limit);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time)
    return {false, {}, fmt::format("{} took longer than {} s", name, time_limit.count() / 1000.0)};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {true, out.content(), {}};

  const std::string complaint = errors.content();
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("ended with code {}", WEXITSTATUS(status));
  return {false, {}, fmt::format("{} {}: {}", name, how, complaint.substr(0, complaint.find('\n')))};
}

}  // namespace loopwright::report

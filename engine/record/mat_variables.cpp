#include "engine/record/mat_variables.h"

#include <fcntl.h>
#include <matio.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string_view>

#include "engine/record/mat_layout.h"
#include "engine/record/mat_values.h"

namespace loopwright::mat {
namespace {

using Matvar = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

// ---- Between child and parent: the values as bytes
// ------------------------------------------------------------------

class Packer {
 public:
  explicit Packer(int file) : file_(file) {}
  bool put(const void* data, size_t size) {
    for (const char* at = static_cast<const char*>(data); size > 0;) {
      const ssize_t written = ::write(file_, at, size);
      if (written <= 0) return false;
      at += written;
      size -= static_cast<size_t>(written);
    }
    return true;
  }
  bool put(size_t number) { return put(&number, sizeof number); }
  bool put(const std::string& text) { return put(text.size()) && put(text.data(), text.size()); }
  bool put(const Variable& variable) {
    bool all = put(variable.name) && put(size_t(variable.kind)) && put(variable.rows) &&
               put(variable.columns) && put(size_t(variable.is_logical)) &&
               put(size_t(variable.is_log_of_matrices)) && put(variable.numbers.size()) &&
               put(variable.numbers.data(), variable.numbers.size() * sizeof(double)) &&
               put(variable.texts.size());
    for (const std::string& text : variable.texts) all = all && put(text);
    return all;
  }

 private:
  int file_;
};

/// Checks everything: a child whose memory matio overwrote may still exit normally.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
  bool get(void* data, size_t size) {
    if (size > bytes_.size()) return false;
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return true;
  }
  bool get(size_t& number) { return get(&number, sizeof number); }
  bool get(std::string& text) {
    size_t size = 0;
    if (!get(size) || size > bytes_.size()) return false;
    text.resize(size);
    return get(text.data(), size);
  }
  bool get(Variable& variable) {
    size_t kind = 0, is_logical = 0, is_log = 0, numbers = 0, texts = 0;
    if (!get(variable.name) || !get(kind) || !get(variable.rows) || !get(variable.columns) ||
        !get(is_logical) || !get(is_log) || !get(numbers))
      return false;
    variable.is_logical = is_logical != 0;
    variable.is_log_of_matrices = is_log != 0;
    if (kind > size_t(Variable::Kind::other) || numbers > bytes_.size() / sizeof(double)) return false;
    variable.kind = static_cast<Variable::Kind>(kind);
    variable.numbers.resize(numbers);
    if (!get(variable.numbers.data(), numbers * sizeof(double)) || !get(texts)) return false;
    if (texts > bytes_.size() / sizeof(size_t)) return false;
    variable.texts.resize(texts);
    for (std::string& text : variable.texts)
      if (!get(text)) return false;
    return is_consistent(variable);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  static bool is_consistent(const Variable& variable) {
    size_t count = 0;
    if (__builtin_mul_overflow(variable.rows, variable.columns, &count)) return false;
    switch (variable.kind) {
      case Variable::Kind::numbers:
        return variable.numbers.size() == count && variable.texts.empty();
      case Variable::Kind::texts:
        return variable.texts.size() == count && variable.numbers.empty();
      default:
        return variable.texts.size() == 1 && variable.numbers.empty();
    }
  }

  std::string_view bytes_;
};

// ---- The two processes
// ----------------------------------------------------------------------------------------------

#if !defined(__SANITIZE_ADDRESS__)
/// [bytes] The mapped memory of this process, which the child inherits.
size_t address_space() {
  size_t pages = 0;
  if (FILE* const file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<size_t>(::sysconf(_SC_PAGESIZE));
}
#endif

void limit_this_process(int time_limit, [[maybe_unused]] size_t memory_limit) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer itself maps terabytes of address space
  const size_t most = address_space() + memory_limit;
  const rlimit memory{most, most};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  // The limit of computing time ends an endless loop, even on a busy machine; the alarm ends a waiting child.
  const auto seconds = static_cast<rlim_t>(time_limit);
  const rlimit computing{seconds, seconds};
  ::setrlimit(RLIMIT_CPU, &computing);
  sigset_t deadlines;
  sigemptyset(&deadlines);
  for (const int deadline : {SIGXCPU, SIGALRM, SIGINT, SIGTERM}) {
    ::signal(deadline, SIG_DFL);
    sigaddset(&deadlines, deadline);
  }
  ::sigprocmask(SIG_UNBLOCK, &deadlines, nullptr);
  ::alarm(20 * static_cast<unsigned>(time_limit));
  // Messages of the C library or a sanitizer about a crash would only confuse: the parent reports the
  // failure.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
}

/// The work of the child. It returns the exit code: 0 if everything was transferred.
int read_in_child(const std::string& path, int result) {
  mat_t* const file = Mat_Open(path.c_str(), MAT_ACC_RDONLY);
  if (!file) return 1;
  Packer packer(result);
  bool all = true;
  std::vector<Variable> converted;
  while (all) {
    const Matvar source(Mat_VarReadNext(file), &Mat_VarFree);
    if (!source) break;
    converted.clear();
    append(converted, *source);
    all = packer.put(converted.size());
    for (const Variable& variable : converted) all = all && packer.put(variable);
  }
  return all ? 0 : 1;
}

std::string failure_of(int status, int time_limit) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  // At the hard limit of computing time the kernel sends SIGKILL.
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL)
    return fmt::format("reading did not come to an end within {} s of computing: the file is damaged",
                       time_limit);
  return "the file is damaged, or needs more memory than it may take";
}

bool unpack(int file, Variables& variables) {
  const off_t size = ::lseek(file, 0, SEEK_END);
  if (size <= 0) return size == 0;
  void* const mapped = ::mmap(nullptr, static_cast<size_t>(size), PROT_READ, MAP_PRIVATE, file, 0);
  if (mapped == MAP_FAILED) return false;
  Unpacker unpacker({static_cast<const char*>(mapped), static_cast<size_t>(size)});
  bool all = true;
  for (; all && !unpacker.at_end(); ++variables.count) {
    size_t parts = 0;
    all = unpacker.get(parts);
    for (size_t i = 0; all && i < parts; ++i) all = unpacker.get(variables.list.emplace_back());
  }
  ::munmap(mapped, static_cast<size_t>(size));
  return all;
}

}  // namespace

Variables read_variables(std::string_view file, const std::string& hdf5_path, const ReadOptions& options) {
  Variables variables;
  // A file in memory holds exactly the bytes that were checked, even if they came through a pipe.
  const int input = ::memfd_create("mat file", MFD_CLOEXEC),
            result = ::memfd_create("mat variables", MFD_CLOEXEC);
  const bool ready = input >= 0 && result >= 0 && Packer(input).put(file.data(), file.size());
  const std::string path = hdf5_path.empty() ? fmt::format("/proc/self/fd/{}", input) : hdf5_path;
  const int time_limit = std::max(1, options.time_limit) + static_cast<int>(file.size() >> 22);
  const pid_t child = ready ? ::fork() : -1;
  if (child == 0) {
    int code = 1;
    try {
      limit_this_process(time_limit, options.memory_limit + 64 * file.size());
      code = read_in_child(path, result);
    } catch (...) {  // out of memory: reported by the exit code
    }
    ::_exit(code);
  }
  if (child < 0) {
    variables.failure = fmt::format("no process to read the file in: {}", std::strerror(errno));
  } else {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    variables.failure = failure_of(status, time_limit);
    if (variables.failure.empty() && !unpack(result, variables)) variables.failure = "the file is damaged";
  }
  if (input >= 0) ::close(input);
  if (result >= 0) ::close(result);
  if (!variables.failure.empty()) variables.list.clear();
  return variables;
}

Variables read_all_variables(const SourceFile& file, const ReadOptions& options) {
  Variables failed;
  const std::optional<Layout> layout = outline(file.text);
  if (!layout) {
    failed.failure = "this is no MAT file";
    return failed;
  }
  if (!layout->damage.empty()) {
    failed.failure = fmt::format("byte {}: {}", layout->damage_offset, layout->damage);
    failed.hint = "was the copy complete?";
    return failed;
  }
  const bool is_hdf5 = layout->version == Layout::Version::seven_three;
  Variables variables = read_variables(file.text, is_hdf5 ? file.name : "", options);
  if (!variables.failure.empty() || !layout->variables || variables.count == *layout->variables)
    return variables;
  failed.failure = fmt::format("the file is damaged: {} of its {} variable{} can be read", variables.count,
                               *layout->variables, *layout->variables == 1 ? "" : "s");
  return failed;
}

}  // namespace loopwright::mat

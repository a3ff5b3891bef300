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

#include "engine/record/text.h"

namespace loopwright::mat {
namespace {

// ---- In the child: from matio to plain values
// ---------------------------------------------------------------------

using Matvar = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable unusable(std::string name, std::string reason) {
  Variable variable;
  variable.name = std::move(name);
  variable.texts = {std::move(reason)};
  return variable;
}

/// The number of elements, if the dimensions are those of a matrix and the data is complete.
std::optional<size_t> count_elements(const matvar_t& source) {
  if (source.rank != 2 || !source.dims) return std::nullopt;
  size_t count = 0, bytes = 0;
  if (__builtin_mul_overflow(source.dims[0], source.dims[1], &count)) return std::nullopt;
  if (source.data_size < 0 || __builtin_mul_overflow(count, size_t(source.data_size), &bytes))
    return std::nullopt;
  if (count > 0 && (!source.data || source.nbytes < bytes)) return std::nullopt;
  return count;
}

template <class Number>
bool copy_numbers(const matvar_t& source, size_t count, std::vector<double>& numbers) {
  if (source.data_size != sizeof(Number)) return false;
  numbers.resize(count);
  for (size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, static_cast<const char*>(source.data) + i * sizeof number, sizeof number);
    numbers[i] = static_cast<double>(number);
  }
  return true;
}

bool copy_numbers_of_any_class(const matvar_t& source, size_t count, std::vector<double>& numbers) {
  switch (source.class_type) {
    case MAT_C_DOUBLE:
      return copy_numbers<double>(source, count, numbers);
    case MAT_C_SINGLE:
      return copy_numbers<float>(source, count, numbers);
    case MAT_C_INT8:
      return copy_numbers<int8_t>(source, count, numbers);
    case MAT_C_UINT8:
      return copy_numbers<uint8_t>(source, count, numbers);
    case MAT_C_INT16:
      return copy_numbers<int16_t>(source, count, numbers);
    case MAT_C_UINT16:
      return copy_numbers<uint16_t>(source, count, numbers);
    case MAT_C_INT32:
      return copy_numbers<int32_t>(source, count, numbers);
    case MAT_C_UINT32:
      return copy_numbers<uint32_t>(source, count, numbers);
    case MAT_C_INT64:
      return copy_numbers<int64_t>(source, count, numbers);
    case MAT_C_UINT64:
      return copy_numbers<uint64_t>(source, count, numbers);
    default:
      return false;
  }
}

/// Eight-bit text is UTF-8, otherwise Latin-1.
std::string as_utf8(std::string_view text) {
  if (find_not_text(text) == std::string_view::npos) return std::string(text);
  std::u16string units;
  for (const char c : text) units += static_cast<unsigned char>(c);
  return from_utf16(units);
}

/// The text of a row of characters; nothing for other shapes.
std::optional<std::string> text_of(const matvar_t& source) {
  if (source.class_type == MAT_C_EMPTY) return "";
  const std::optional<size_t> count = count_elements(source);
  if (source.class_type != MAT_C_CHAR || !count || (*count > 0 && source.dims[0] != 1)) return std::nullopt;
  if (*count == 0) return "";
  const char* const data = static_cast<const char*>(source.data);
  if (source.data_size == 2) {
    std::u16string units(*count, u' ');
    std::memcpy(units.data(), data, 2 * *count);
    return from_utf16(units);
  }
  return source.data_size == 1 ? std::optional(as_utf8({data, *count})) : std::nullopt;
}

Variable cell_of_texts(std::string name, const matvar_t& source) {
  const std::optional<size_t> count = count_elements(source);
  Variable variable;
  for (size_t i = 0; count && i < *count; ++i) {
    const matvar_t* const cell = static_cast<matvar_t* const*>(source.data)[i];
    const std::optional<std::string> text = cell ? text_of(*cell) : "";
    if (!text) break;
    variable.texts.push_back(*text);
  }
  if (!count || variable.texts.size() != *count) return unusable(std::move(name), "a cell array");
  variable.name = std::move(name);
  variable.kind = Variable::Kind::texts;
  variable.rows = source.dims[0];
  variable.columns = source.dims[1];
  return variable;
}

Variable convert(std::string name, const matvar_t& source) {
  if (source.rank != 2)
    return unusable(std::move(name), fmt::format("an array of {} dimensions", source.rank));
  if (source.class_type == MAT_C_CELL) return cell_of_texts(std::move(name), source);
  if (source.class_type == MAT_C_STRUCT) return unusable(std::move(name), "a structure within a structure");
  if (source.class_type == MAT_C_SPARSE) return unusable(std::move(name), "a sparse matrix");
  if (source.isComplex) return unusable(std::move(name), "complex numbers");
  Variable variable;
  if (source.class_type == MAT_C_CHAR) {
    const std::optional<std::string> text = text_of(source);
    if (!text) return unusable(std::move(name), "text of several rows");
    variable.kind = Variable::Kind::text;
    variable.texts = {*text};
  } else {
    const std::optional<size_t> count = count_elements(source);
    if (!count || !copy_numbers_of_any_class(source, *count, variable.numbers))
      return unusable(std::move(name), "no numbers, or damaged ones");
    variable.kind = Variable::Kind::numbers;
    variable.rows = source.dims[0];
    variable.columns = source.dims[1];
  }
  variable.name = std::move(name);
  return variable;
}

void append(std::vector<Variable>& list, matvar_t& source) {
  const std::string name = as_utf8(source.name ? source.name : "");
  if (source.class_type != MAT_C_STRUCT) {
    list.push_back(convert(name, source));
    return;
  }
  if (source.rank != 2 || !source.dims || source.dims[0] != 1 || source.dims[1] != 1) {
    list.push_back(unusable(name, "an array of structures"));
    return;
  }
  const unsigned fields = Mat_VarGetNumberOfFields(&source);
  char* const* const names = Mat_VarGetStructFieldnames(&source);
  for (unsigned i = 0; names && i < fields; ++i) {
    const std::string field_name = name + "." + as_utf8(names[i] ? names[i] : "");
    const matvar_t* const field = Mat_VarGetStructFieldByIndex(&source, i, 0);
    list.push_back(field ? convert(field_name, *field) : unusable(field_name, "an empty field"));
  }
}

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
               put(variable.columns) && put(variable.numbers.size()) &&
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
    size_t kind = 0, numbers = 0, texts = 0;
    if (!get(variable.name) || !get(kind) || !get(variable.rows) || !get(variable.columns) || !get(numbers))
      return false;
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

}  // namespace loopwright::mat

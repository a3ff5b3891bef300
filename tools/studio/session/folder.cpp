#include "tools/studio/session/folder.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>
#include "tools/studio/session/draft.h"

namespace loopwright::studio {
namespace {

constexpr std::array<std::string_view, 3> known_suffixes = {".json", ".csv", ".mat"};
constexpr std::string_view own_folder = ".loopwright";
constexpr size_t longest_path = 1024, largest_text = 64u << 20;

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (size_t at = 0; at <= path.size();) {
    const size_t end = std::min(path.find('/', at), path.size());
    parts.push_back(path.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

[[noreturn]] void refuse(const std::string& path, std::string_view why) {
  throw Refused(fmt::format("\"{}\": {}", path, why));
}

/// Answers are JSON, which has no other texts.
bool is_utf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

/// The parts of a path that may be served. Throws Refused.
std::vector<std::string> served_parts(const std::string& path) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (path.empty() || path.size() > longest_path || std::ranges::any_of(path, is_control) || !is_utf8(path))
    refuse("path", "this is no path of a file");
  std::vector<std::string> parts = parts_of(path);
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty() || parts[i] == "." || parts[i] == "..")
      refuse(path, "the path must lead into the folder of the studio");
    const bool is_own = i == 0 && parts[i] == own_folder && parts.size() > 1;
    if (parts[i].starts_with('.') && !is_own) refuse(path, "hidden files are not served");
  }
  const bool is_known =
      std::ranges::any_of(known_suffixes, [&](std::string_view suffix) { return path.ends_with(suffix); });
  if (!is_known) refuse(path, "the studio reads and writes .json, .csv and .mat files");
  return parts;
}

std::optional<std::string> contents_of(int file) {
  std::string text;
  std::array<char, 1 << 16> buffer;
  while (true) {
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return {};
    if (count == 0) return text;
    text.append(buffer.data(), size_t(count));
    if (text.size() > largest_text) return {};
  }
}

/// Opens a regular file of a folder without following a link; never waits.
Handle open_in(int folder, const std::string& name) {
  Handle file(::openat(folder, name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat status {};
  if (!file || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) return Handle();
  return file;
}

/// Whether no other program has the file open for writing: only then are its contents final.
bool is_final(const Handle& file) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (::fcntl(file.number(), F_SETLEASE, F_RDLCK) == 0)
      return ::fcntl(file.number(), F_SETLEASE, F_UNLCK) == 0;
    if (errno != EAGAIN) return true;  // a file system without leases
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

/// A name that no other file beside the target has.
std::string hidden_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return fmt::format(".{}.studio-{}-{}", target.substr(0, 200), ::getpid(), counter++);
}

/// A hidden file beside the target, with the new text on the disk.
class NewFile {
 public:
  NewFile(int folder, const std::string& target, std::string_view text, mode_t mode)
      : folder_(folder), name_(hidden_name(target)) {
    Handle file(::openat(folder, name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!file) refuse(target, std::strerror(errno));
    is_there_ = true;
    for (size_t at = 0; at < text.size();) {
      const ssize_t count = ::write(file.number(), text.data() + at, text.size() - at);
      if (count < 0 && errno != EINTR) fail(target);
      if (count > 0) at += size_t(count);
    }
    if (::fchmod(file.number(), mode) != 0 || ::fsync(file.number()) != 0) fail(target);
  }
  ~NewFile() { remove(); }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  const std::string& name() const { return name_; }
  void keep() { is_there_ = false; }
  /// Exchanges it with the target; afterwards it has what the target had.
  bool exchange(const std::string& target) {
    return ::renameat2(folder_, name_.c_str(), folder_, target.c_str(), RENAME_EXCHANGE) == 0;
  }
  /// What it has now; nothing while another program writes it.
  std::optional<std::string> text() const {
    Handle file = open_in(folder_, name_);
    if (!file || !is_final(file)) return {};
    return contents_of(file.number());
  }

 private:
  [[noreturn]] void fail(const std::string& target) {
    const int error = errno;
    remove();
    refuse(target, std::strerror(error));
  }
  void remove() {
    if (is_there_) ::unlinkat(folder_, name_.c_str(), 0);
    is_there_ = false;
  }

  const int folder_;
  const std::string name_;
  bool is_there_ = false;
};

/// Read once, before there are threads: while it is read, there is no mask.
const mode_t usual_mode = [] {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}();

}  // namespace

Handle& Handle::operator=(Handle&& other) noexcept {
  if (number_ >= 0 && this != &other) ::close(number_);
  number_ = other.number_, other.number_ = -1;
  return *this;
}

Handle::~Handle() {
  if (number_ >= 0) ::close(number_);
}

namespace {

/// Without a slash at the end and without "./", so that paths of files begin with it: resolved paths have
/// neither.
std::string plain(const std::string& path) {
  std::string normal = std::filesystem::path(path).lexically_normal().string();
  while (normal.size() > 1 && normal.ends_with('/')) normal.pop_back();
  return normal.empty() ? "." : normal;
}

}  // namespace

Folder::Folder(std::string path)
    : path_(plain(path)), handle_(::open(path_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {
  if (!handle_)
    throw std::runtime_error(
        fmt::format("the folder \"{}\" cannot be opened: {}", path_, std::strerror(errno)));
}

Handle Folder::folder_of(const std::string& relative, std::string& name) const {
  const std::vector<std::string> parts = served_parts(relative);
  name = parts.back();
  Handle folder(::openat(handle_.number(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  for (size_t i = 0; i + 1 < parts.size() && folder; ++i)
    folder =
        Handle(::openat(folder.number(), parts[i].c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW));
  return folder;
}

std::string Folder::path_of(const std::string& relative) const {
  served_parts(relative);
  return path_ == "." ? relative : path_ + (path_.ends_with('/') ? "" : "/") + relative;
}

std::string Folder::relative(const std::string& path) const {
  const std::string begin = path_ == "." ? "" : path_ + (path_.ends_with('/') ? "" : "/");
  return path.starts_with(begin) ? path.substr(begin.size()) : path;
}

bool Folder::is_writable(const std::string& relative) const {
  std::string name;
  const Handle folder = folder_of(relative, name);
  if (!folder || ::faccessat(folder.number(), ".", W_OK, 0) != 0) return false;
  struct stat status {};
  if (::fstatat(folder.number(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return errno == ENOENT;
  return S_ISREG(status.st_mode) && ::faccessat(folder.number(), name.c_str(), W_OK, 0) == 0;
}

std::optional<std::string> Folder::read(const std::string& relative) const {
  const std::string path = path_of(relative);
  Handle file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file) {
    if (errno == ENOENT || errno == ENOTDIR) return {};
    refuse(relative, std::strerror(errno));
  }
  struct stat status {};
  if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode))
    refuse(relative, "it is not a regular file");
  auto text = contents_of(file.number());
  if (!text) refuse(relative, "it cannot be read, or has more than 64 MB");
  return text;
}

std::optional<Folder::Found> Folder::replace(const std::string& relative,
                                             const std::optional<std::string>& expected,
                                             std::string_view text) const {
  std::string name;
  const Handle folder = folder_of(relative, name);
  if (!folder || !is_writable(relative))
    refuse(relative,
           "it cannot be written: it is a link, read-only, or its folder is not below that of the studio");
  if (!expected) {
    NewFile fresh(folder.number(), name, text, usual_mode);
    if (::renameat2(folder.number(), fresh.name().c_str(), folder.number(), name.c_str(), RENAME_NOREPLACE) ==
        0) {
      fresh.keep();
      return {};
    }
    if (errno != EEXIST) refuse(relative, std::strerror(errno));
    return Found{read(relative)};
  }
  struct stat status {};
  if (::fstatat(folder.number(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return Found{};
  NewFile fresh(folder.number(), name, text, status.st_mode & 07777);
  if (!fresh.exchange(name)) {
    if (errno == ENOENT) return Found{};
    refuse(relative, std::strerror(errno));
  }
  const auto before = fresh.text();
  if (before && *before == *expected) {
    ::fsync(folder.number());
    return {};
  }
  // Another program wrote, or writes, what is now in the hidden file: it goes back. If yet another one
  // replaced the new text meanwhile, that is the newest, and stays.
  if (!fresh.exchange(name)) {
    fresh.keep();
    refuse(relative, "it was removed while it was written; its contents are in " + fresh.name());
  }
  if (const auto ours = fresh.text(); !ours || *ours != text) {
    if (!fresh.exchange(name)) fresh.keep();
  }
  return Found{read(relative)};
}

void Folder::remove(const std::string& relative, std::string_view expected) const {
  std::string name;
  const Handle folder = folder_of(relative, name);
  if (!folder || read(relative) != expected) return;
  // It is moved aside before it is compared for good: what another program writes in between goes back, and
  // is lost at no time.
  const std::string aside = hidden_name(name);
  const auto move = [&](const std::string& from, const std::string& to) {
    return ::renameat2(folder.number(), from.c_str(), folder.number(), to.c_str(), RENAME_NOREPLACE) == 0;
  };
  if (!move(name, aside)) return;
  const Handle file = open_in(folder.number(), aside);
  if (file && is_final(file) && contents_of(file.number()) == expected)
    ::unlinkat(folder.number(), aside.c_str(), 0);
  else if (!move(aside, name))
    refuse(relative, "it was replaced while it was removed; its former contents are in " + aside);
}

void Folder::make_own_folder(const std::string& name) const {
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path_) / own_folder / name, code);
}

namespace {

bool have_same_contents(int folder, const std::string& a, int other_folder, const std::string& b) {
  const Handle first = open_in(folder, a), second = open_in(other_folder, b);
  if (!first || !second) return false;
  std::vector<char> x(1 << 20), y(x.size());
  while (true) {
    const ssize_t count = ::read(first.number(), x.data(), x.size());
    if (count < 0) return false;
    ssize_t read = 0;
    while (read < std::max<ssize_t>(count, 1)) {
      const ssize_t more =
          ::read(second.number(), y.data() + read, size_t(std::max<ssize_t>(count, 1) - read));
      if (more <= 0) break;
      read += more;
    }
    if (read != count || !std::equal(x.begin(), x.begin() + count, y.begin())) return false;
    if (count == 0) return true;
  }
}

}  // namespace

void Folder::store_part(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) const {
  constexpr int64_t largest = int64_t(4) << 30;
  if (offset < 0 || offset > largest - int64_t(bytes.size())) refuse(name, "a record has at most 4 GB");
  std::string target;
  const Handle folder = folder_of(name, target);
  if (!folder || !is_writable(name)) refuse(name, "it cannot be written here");
  make_own_folder("");
  const Handle own(::openat(handle_.number(), std::string(own_folder).c_str(),
                            O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW));
  const std::string part = target + ".part";
  const int begin = offset == 0 ? O_CREAT | O_TRUNC : 0;
  const Handle file(
      ::openat(own.number(), part.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | begin, 0600));
  struct stat status {};
  if (!file || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode))
    refuse(name, "no part of it came before");
  if (status.st_size != offset) refuse(name, "a part of it is missing");
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t count =
        ::pwrite(file.number(), bytes.data() + at, bytes.size() - at, off_t(offset) + off_t(at));
    if (count < 0 && errno != EINTR) refuse(name, std::strerror(errno));
    if (count > 0) at += size_t(count);
  }
  if (!is_last) return;
  ::fchmod(file.number(), usual_mode);
  ::fsync(file.number());
  if (::renameat2(own.number(), part.c_str(), folder.number(), target.c_str(), RENAME_NOREPLACE) == 0) return;
  const bool is_same = errno == EEXIST && have_same_contents(own.number(), part, folder.number(), target);
  ::unlinkat(own.number(), part.c_str(), 0);
  if (!is_same) refuse(name, "there is a file of this name with other contents");
}

std::vector<Folder::File> Folder::files() const {
  namespace fs = std::filesystem;
  constexpr size_t most = 5000;
  constexpr int deepest = 8;
  std::vector<File> list;
  std::error_code code;
  for (fs::recursive_directory_iterator i(path_, fs::directory_options::skip_permission_denied, code), end;
       !code && i != end && list.size() < most; i.increment(code)) {
    const std::string name = i->path().filename().string();
    std::error_code own;
    const bool is_folder = i->is_directory(own);
    if (name.starts_with('.') || name == "node_modules" || i.depth() >= deepest) {
      if (is_folder) i.disable_recursion_pending();
      continue;
    }
    const bool is_known =
        std::ranges::any_of(known_suffixes, [&](std::string_view suffix) { return name.ends_with(suffix); });
    if (!i->is_regular_file(own) || !is_known || name.ends_with(".layout.json")) continue;
    // A link keeps its own name; what it leads to may be outside.
    list.push_back({i->path().lexically_relative(path_).generic_string(), int64_t(i->file_size(own))});
  }
  std::ranges::sort(list, {}, &File::path);
  return list;
}

}  // namespace loopwright::studio

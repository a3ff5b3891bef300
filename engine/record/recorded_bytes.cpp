#include "engine/record/recorded_bytes.h"

#include <limits>
#include <mutex>

#include "engine/file/regular_file.h"
#include "engine/json/nearest_file.h"

namespace loopwright {
namespace {

/// The last file and its hash. A diagnosis reads its records some twenty times, and to compare the bytes
/// costs a small part of hashing them.
class LastHashed {
 public:
  /// Records the file, and returns the one that is kept if it is the same.
  std::shared_ptr<const SourceFile> note(std::shared_ptr<const SourceFile> file, Problems& problems) {
    if (file->text.size() > most_bytes) {
      problems.note_file(file->name, file->text);
      return file;
    }
    const std::lock_guard lock(mutex_);
    if (!file_ || file_->name != file->name || file_->text != file->text) {
      noted_ = {};
      noted_.note_file(file->name, file->text);
      file_ = std::move(file);
    }
    problems.add(noted_);
    return file_;
  }

 private:
  static constexpr size_t most_bytes = 16 << 20;
  std::mutex mutex_;
  std::shared_ptr<const SourceFile> file_;
  Problems noted_;  // of it
};

}  // namespace

std::shared_ptr<const SourceFile> read_recorded_bytes(const std::string& path, Problems& problems) {
  static LastHashed last;
  auto file = std::make_shared<SourceFile>(SourceFile{path, {}});
  const std::string reason = read_regular_file(path, std::numeric_limits<uint32_t>::max(), file->text);
  if (reason.empty()) return last.note(std::move(file), problems);
  file->text.clear();
  problems.error({file, 0}, {}, {}, "the file cannot be read: " + reason).hint = nearest_file_hint(path);
  return nullptr;
}

}  // namespace loopwright

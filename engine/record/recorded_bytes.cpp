#include "engine/record/recorded_bytes.h"

#include <limits>

#include "engine/file/regular_file.h"
#include "engine/json/nearest_file.h"

namespace loopwright {

std::shared_ptr<const SourceFile> read_recorded_bytes(const std::string& path, Problems& problems) {
  auto file = std::make_shared<SourceFile>(SourceFile{path, {}});
  const std::string reason = read_regular_file(path, std::numeric_limits<uint32_t>::max(), file->text);
  if (reason.empty()) {
    problems.note_file(path, file->text);
    return file;
  }
  file->text.clear();
  problems.error({file, 0}, {}, {}, "the file cannot be read: " + reason).hint = nearest_file_hint(path);
  return nullptr;
}

}  // namespace loopwright

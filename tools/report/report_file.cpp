#include "engine/record/atomic_file.h"
#include "tools/report/report.h"

namespace loopwright::report {

void write_html(const std::filesystem::path& path, const Page& page) {
  write_file(path.string(), to_html(page));
}

}  // namespace loopwright::report

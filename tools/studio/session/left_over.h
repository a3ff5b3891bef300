/// Hidden files that a studio left behind because it was killed at the moment at which it wrote a file.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "tools/studio/session/folder.h"

namespace loopwright::studio {

/// `.axis.json.studio-4711-0`: a text that was to become the file, or that another one had just replaced.
struct LeftOver {
  std::string file;  ///< below the folder
  std::string path;  ///< of the file that it belongs to
  std::string text;
  std::string when;  ///< it was written, UTC
};

/// The name of the file that a hidden file belongs to, if a process that is gone has left it; otherwise
/// nothing.
std::optional<std::string> owner_of_left_over(const std::string& name);

/// All in the folder, sorted. Those with the present contents of their file are removed: they hold nothing
/// that is not there.
std::vector<LeftOver> take_left_over(const Folder& folder);

/// Removes one of them; false if its text is another by now.
bool remove_left_over(const Folder& folder, const LeftOver& left);

}  // namespace loopwright::studio

/// The files of a folder that name what is renamed in one of its diagrams: they change together.
#pragma once
#include "tools/studio/session/folder.h"
#include "tools/studio/session/intent.h"

namespace loopwright::studio {

/// A step that a person should agree to first, because of what the message says.
struct NeedsConsent : Refused {
  using Refused::Refused;
};

struct Following {
  std::vector<OtherFile> files;
  std::vector<std::string> left_behind;  ///< what keeps the old name and why, as sentences
};

/// Sweeps of the diagram, experiments in its folder all of whose ports lead to it, diagrams that contain it
/// as a subdiagram at any depth, and sweeps and experiments of those. `text`: of the diagram before.
/// Recordings keep the names of their columns, and so do training files, which name these.
Following followers(const Folder& folder, const std::string& path, const std::string& text,
                    const std::vector<Renaming>& renamings);

}  // namespace loopwright::studio

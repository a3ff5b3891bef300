/// What a page was sent of a view, so that what is as it was need not be sent again.
#pragma once
#include <map>
#include <string>
#include "tools/studio/session/checked_text.h"

namespace loopwright::studio {

class SentView {
 public:
  /// Puts names in place of blocks, and null in place of wires, that are as they were when this level was
  /// sent last (tools/studio/protocol.md).
  void shorten(Json& view);
  void forget() { *this = SentView(); }

 private:
  std::string inside_;
  std::map<std::string, std::string> blocks_;  ///< as JSON texts, by name
  std::string wires_;
};

}  // namespace loopwright::studio

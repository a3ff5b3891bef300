#include "tools/studio/session/sent_view.h"
#include <utility>

namespace loopwright::studio {
namespace {

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

void SentView::shorten(Json& view) {
  if (!view.is_object()) return forget();
  if (view["inside"] != inside_) forget();
  SentView now;
  now.inside_ = view["inside"], now.wires_ = text_of(view["wires"]);
  if (now.wires_ == wires_) view["wires"] = nullptr;
  for (Json& block : view["blocks"]) {
    const std::string name = block["name"];
    const std::string& text = now.blocks_[name] = text_of(block);
    const auto before = blocks_.find(name);
    if (before != blocks_.end() && before->second == text) block = name;
  }
  *this = std::move(now);
}

}  // namespace loopwright::studio

#include "tools/studio/session/inclusions.h"
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace loopwright::studio {
namespace {

void add(const Value& diagram, std::vector<std::string> path, std::vector<const Value*> around,
         std::vector<Inclusion>& found) {
  around.push_back(&diagram);
  const Value::Member* blocks = diagram.find("blocks");
  if (!blocks) return;
  for (const Value::Member& block : blocks->value.members) {
    path.push_back(block.name);
    each_body(block.value, [&](const Value& body) {
      const Value::Member* inner = body.find("diagram");
      if (inner && inner->value.kind == Value::Kind::text)
        found.push_back({path, around, &block.value, &body, &inner->value});
      else if (inner && inner->value.kind == Value::Kind::object)
        add(inner->value, path, around, found);
    });
    path.pop_back();
  }
}

}  // namespace

std::vector<Inclusion> inclusions(const Value& diagram) {
  std::vector<Inclusion> found;
  add(diagram, {}, {}, found);
  return found;
}

std::string path_from(const std::vector<std::string>& path, size_t first) {
  return fmt::format("{}", fmt::join(path.begin() + ptrdiff_t(first), path.end(), "."));
}

}  // namespace loopwright::studio

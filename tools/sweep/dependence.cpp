#include "tools/sweep/dependence.h"
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

/// How a number depends on the given paths, in increasing order.
enum class Dependence { none, equal, computed };

class Dependences {
 public:
  Dependences(const Diagram& diagram, const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
      for (size_t begin = 0; begin <= path.size();) {
        const size_t end = std::min(path.find('.', begin), path.size());
        names_[path.substr(begin, end - begin)] = Dependence::equal;
        begin = end + 1;
      }
    while (spread(diagram)) {
    }
    collect(diagram, "");
  }
  std::set<std::string> take() { return std::move(found_); }

 private:
  Dependence of_text(std::string_view expression) const {
    Dependence most = Dependence::none;
    for (const NameUse& use : names_in(expression))
      if (const auto known = names_.find(use.name); known != names_.end() && !use.is_function)
        most = std::max(most, known->second);
    const size_t begin = std::min(expression.find_first_not_of(' '), expression.size());
    const size_t end = expression.find_last_not_of(' ') + 1;
    const bool is_plain = is_name(expression.substr(begin, std::max(end, begin) - begin));
    return most == Dependence::none || is_plain ? most : Dependence::computed;
  }

  /// An evaluated number keeps the text of its expression.
  Dependence of(const Value& value) const {
    Dependence most = Dependence::none;
    if (value.kind == Value::Kind::number && value.text.starts_with('='))
      most = of_text(std::string_view(value.text).substr(1));
    for (const Value& item : value.items) most = std::max(most, of(item));
    return most;
  }

  /// From parameters to parameters; false if nothing is new.
  bool spread(const Diagram& diagram) {
    bool is_new = false;
    for (const Parameter& parameter : diagram.parameters)
      if (const Dependence now = of(parameter.value); now != Dependence::none) {
        Dependence& known = names_[parameter.name];
        is_new |= now > known;
        known = std::max(known, now);
      }
    for (const BlockEntry& block : diagram.blocks)
      if (block.subdiagram) is_new |= spread(*block.subdiagram);
    return is_new;
  }

  void collect(const Diagram& diagram, const std::string& prefix) {
    for (const BlockEntry& block : diagram.blocks) {
      const std::string path = prefix + block.name;
      if (block.subdiagram) {
        collect(*block.subdiagram, path + ".");
        continue;
      }
      collect(block.settings, path);
      if (block.sample_time) collect(*block.sample_time, path + ".sample_time");
      if (block.sample_offset) collect(*block.sample_offset, path + ".sample_offset");
    }
  }
  void collect(const Value& value, const std::string& path) {
    if (value.items.empty() && value.members.empty() && of(value) == Dependence::computed)
      found_.insert(path);
    for (size_t i = 0; i < value.items.size(); ++i) collect(value.items[i], fmt::format("{}.{}", path, i));
    for (const Value::Member& member : value.members) collect(member.value, path + "." + member.name);
  }

  std::map<std::string, Dependence, std::less<>> names_;
  std::set<std::string> found_;
};

}  // namespace

std::set<std::string> computed_settings(const Diagram& diagram, const std::vector<std::string>& paths) {
  return Dependences(diagram, paths).take();
}

}  // namespace loopwright

/// Reads the members of effect files.
#pragma once
#include <algorithm>
#include "engine/json/reader.h"
#include "tools/effects/effect.h"

namespace loopwright {

/// The largest number of passes, reversals … that an effect may require.
constexpr double most_counted = 1e6;

/// Values of one kind each, with a problem for any other.
struct MemberReader {
  Reader reader;

  /// A text that must be there.
  std::string text(const Value& owner, std::string_view key, std::string_view what) const;
  /// False if it is absent.
  bool flag(const Value& owner, std::string_view key) const;
  /// 0 or more.
  double number(const Value& owner, std::string_view key, double otherwise) const;
  int count(const Value& owner, std::string_view key, int otherwise) const;
  std::vector<std::string> texts(const Value& list, std::string_view what) const;
  /// Whether it is a number, or a text that begins with '='.
  bool expect_computed(const Value& value, std::string_view what) const;

  /// One word of a list; false, and a problem, if it is not in the list.
  template <class Meaning>
  bool word(const Value& item, const char* key, std::string_view what, const char* problem,
            const std::vector<std::pair<std::string, Meaning>>& known, Meaning& meaning) const {
    const std::string word = text(item, key, what);
    const auto found = std::ranges::find(known, word, [](const auto& k) { return k.first; });
    if (found != known.end()) return meaning = found->second, true;
    if (!item.find(key)) return false;
    KnownNames names;
    for (const auto& [name, unused] : known) names.add(name);
    names.explain(reader.error(*item.find(key), problem), word);
    return false;
  }
};

/// What a record must contain for the effect to be found.
Excitation read_needs(const Value& needs, const MemberReader& read);
/// The effects that may look alike, and the motions that separate them.
std::vector<ConfusableEffect> read_confusable(const Value& list, const MemberReader& read);

}  // namespace loopwright

/// Changes to a JSON text that leave the rest of it as its author wrote it.
#pragma once
#include <string>
#include <vector>
#include "engine/json/value.h"

namespace loopwright {

/// One past the last character of the value that begins at `begin`; the text must be valid JSON.
size_t end_of_value(const std::string& text, size_t begin);

/// Edits of one text, collected and then applied together: offsets are those of the text as it was read.
class TextEdits {
 public:
  void replace(size_t begin, size_t end, std::string text) {
    edits_.push_back({begin, end, std::move(text)});
  }
  void insert(size_t at, std::string text) { replace(at, at, std::move(text)); }
  bool empty() const { return edits_.empty(); }
  std::string apply(const std::string& text) const;

 private:
  struct Edit {
    size_t begin, end;
    std::string text;
  };
  std::vector<Edit> edits_;
};

/// The spaces at the beginning of the line of an offset.
std::string indentation_at(const std::string& text, size_t at);
/// True if only spaces precede the offset on its line.
bool begins_line(const std::string& text, size_t at);
/// Every line but the first indented further.
std::string indented(const std::string& text, const std::string& by);

/// Distance from the start of the names to the start of the values, if the values are aligned; otherwise 0.
size_t width_of_names(const Value& object);

/// A new member of an object before an existing one: on a line of its own if the existing one has its own
/// line, and with its value in the same column if those of the object are aligned.
std::string member_before(const Value& object, const Value::Member& next, const std::string& name,
                          const std::string& value);

/// At most seven digits: more than a fit determines, few enough to read.
std::string readable_number(double number);

}  // namespace loopwright

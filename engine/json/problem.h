/// What is wrong with an input, said so that a person can mend it. Problems are collected, never thrown one
/// by one.
#pragma once
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

class PointerTable;

/// The text of a file that the user wrote; places point into it.
struct SourceFile {
  std::string name;  ///< as the user gave it, for messages
  std::string text;
  mutable std::shared_ptr<const PointerTable> pointers{};  ///< of a JSON text; made by the first who asks
};

/// A spot in a file. Line, column and JSON pointer are worked out only when a message is written.
struct Place {
  std::shared_ptr<const SourceFile> file;
  uint32_t offset = 0;

  /// "/blocks/feedback/Kp": the JSON pointer (RFC 6901) of the value that stands there, or whose name does.
  std::string pointer() const;
};

/// One token of a JSON pointer: a slash and the name.
std::string pointer_token(std::string_view name);

/// Line and column of a place, both counted from 1; columns count characters, not bytes.
struct LineColumn {
  int line = 1, column = 1;
};
LineColumn line_column(const Place& place);

/// One finding. Empty members are left out of the message.
struct Problem {
  enum class Severity { warning, error };
  Severity severity = Severity::error;
  Place place;           ///< where in the file
  std::string pointer;   ///< JSON pointer, "/blocks/feedback/Kp"
  std::string block;     ///< path of the block, "stage.friction"
  std::string message;   ///< what is wrong
  std::string expected;  ///< what would have been right
  std::string found;     ///< what stands there
  std::string hint;      ///< how to mend it
};

/// file:line:column: error: message … as shown to a person, several lines without a trailing newline.
std::string to_string(const Problem& problem);

/// The findings of one load, in the order of their finding.
class Problems {
 public:
  Problem& error(Place place, std::string pointer, std::string block, std::string message);
  Problem& warning(Place place, std::string pointer, std::string block, std::string message);
  void add(Problem problem) { list_.push_back(std::move(problem)); }
  bool has_errors() const;
  const std::vector<Problem>& list() const { return list_; }
  /// Every problem, sorted by file and place, then a line that counts them.
  std::string text() const;

 private:
  std::vector<Problem> list_;
};

/// Thrown once at the end of a load that found errors: the program answers with exit code 2.
struct InputError : std::runtime_error {
  explicit InputError(Problems p) : std::runtime_error(p.text()), problems(std::move(p)) {}
  Problems problems;
};

/// The name among `candidates` that was probably meant, or nothing when none is near.
std::string nearest_name(std::string_view wrong, const std::vector<std::string>& candidates);

}  // namespace loopwright

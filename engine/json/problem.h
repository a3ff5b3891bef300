/// What is wrong with an input, said so that a person can mend it. Problems are collected, never thrown one
/// by one.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
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

/// Text from a file as a terminal may show it: UTF-8 stays, while control characters other than the end of a
/// line, and bytes that are not UTF-8, become \x1b and the like. Otherwise a file could move the cursor, or hide
/// what is said of it.
std::string printable(std::string_view text);

/// file:line:column: error: message … as shown to a person, printable, several lines without a trailing newline.
std::string to_string(const Problem& problem);

/// At most so many problems are written out; the others are counted. More are not read by anybody.
constexpr size_t most_problems_told = 200;

/// Problems as a person sees them, sorted by file and place, a line's end after each. Errors come before
/// warnings where not all can be told.
std::string to_text(std::span<const Problem> problems);

/// A file that was read: what its bytes say decided the result.
struct FileRead {
  std::string path;  ///< as it was opened
  std::string hash;  ///< content_hash() of its bytes; empty: only named
};

/// The findings of one load: problems in the order of their finding, and the files that were read.
class Problems {
 public:
  Problem& error(Place place, std::string pointer, std::string block, std::string message);
  Problem& warning(Place place, std::string pointer, std::string block, std::string message);
  void add(Problem problem) { list_.push_back(std::move(problem)); }
  /// The findings of a part of the load.
  void add(const Problems& part);
  bool has_errors() const;
  const std::vector<Problem>& list() const { return list_; }
  /// The problems as to_text() shows them, then a line that counts them all.
  std::string text() const;

  /// Everyone who reads a file notes it here.
  void note_file(const std::string& path, std::string_view bytes);
  /// Notes a file that somebody is about to read, with an empty hash.
  void note_file_name(const std::string& path) { files_.push_back({path, {}}); }
  const std::vector<FileRead>& files() const { return files_; }

 private:
  std::vector<Problem> list_;
  std::vector<FileRead> files_;
};

/// Thrown once at the end of a load that found errors: the program answers with exit code 2.
struct InputError : std::runtime_error {
  explicit InputError(Problems p) : std::runtime_error(p.text()), problems(std::move(p)) {}
  Problems problems;
};

/// The name among `candidates` that was probably meant, or nothing when none is near.
std::string nearest_name(std::string_view wrong, const std::vector<std::string>& candidates);

}  // namespace loopwright

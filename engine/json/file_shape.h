/// What a file of some kind contains, as data.
///
/// A reader written by hand takes the keys that it knows from here, and the JSON Schemas for editors
/// (tools/schema) are generated from the same lists, so that neither has a key that the other lacks.
#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

struct Reader;
struct Value;

/// What may stand at one place of a file.
struct FileShape {
  enum class Kind {
    anything,
    text,
    flag,
    number,
    whole,
    stated,    ///< a number with or without a unit, see stated_number()
    computed,  ///< a number, or an expression: a text that begins with '='
    choice,
    list,
    by_name,  ///< an object whose keys are names that the user chooses
    object,   ///< an object of these keys and no others
    either,   ///< one of several shapes
    block     ///< of a diagram
  };
  struct Key;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr size_t unlimited = std::numeric_limits<size_t>::max();

  Kind kind = Kind::anything;
  double low = -infinity, high = infinity;  ///< of a number
  bool low_is_open = false;
  /// A number or list that is read in a ParameterScope: also "=expression", {"value": …, "unit": …} (numbers)
  /// and
  /// {"file": …, "name": …}.
  bool is_evaluated = false;
  size_t fewest = 0, most = unlimited;    ///< characters of a text, items of a list, names of an object
  std::vector<std::string_view> choices;  ///< of a choice
  std::vector<Key> keys;                  ///< of an object
  std::vector<FileShape> parts;  ///< one for the items of a list or by name; all alternatives of `either`
  std::string sentence;          ///< for people
  std::string default_text;      ///< as JSON; empty: none

  /// The keys that an object of this shape may have; of `either`, those of any alternative.
  std::vector<std::string_view> names() const;
};

struct FileShape::Key {
  std::string_view name;
  FileShape shape;
  bool is_required = false;
};

/// Reports a problem for every member that an object of this shape does not have.
void reject_unknown(const Reader& reader, const Value& object, const FileShape& shape,
                    std::string_view owner);

/// Short words for shapes: `object({required("column", text(1), "Name of a column"), …})`.
namespace shapes {
FileShape anything();
FileShape text(size_t fewest = 0);
FileShape flag();
FileShape number(double low = -FileShape::infinity, double high = FileShape::infinity);
FileShape whole(double low, double high);
FileShape stated(double low = -FileShape::infinity);
FileShape computed();
FileShape choice(std::vector<std::string_view> choices);
FileShape list(FileShape item, size_t fewest = 0, size_t most = FileShape::unlimited);
FileShape by_name(FileShape item, size_t fewest = 0);
FileShape object(std::vector<FileShape::Key> keys);
FileShape either(std::vector<FileShape> alternatives);
FileShape block();
/// A whole file: an object of these keys, and of those that every kind of file has.
FileShape file(std::vector<FileShape::Key> keys);

FileShape::Key required(std::string_view name, FileShape shape, std::string sentence = "");
FileShape::Key optional(std::string_view name, FileShape shape, std::string sentence = "");
}  // namespace shapes

}  // namespace loopwright

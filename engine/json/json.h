/// JSON with source locations: every value and member name has its location in the file.
#pragma once
#include <memory>
#include <string>
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

/// The text of a regular file of at most 64 MB; null after a problem, which is reported at `reference` (where
/// the file was named).
std::shared_ptr<const SourceFile> read_source(const std::string& path, const Place& reference,
                                              Problems& problems);

/// The value in a JSON text (RFC 8259, UTF-8, no comments); null after a problem. Reported with their source
/// locations are syntax errors, duplicate member names, bytes that are not UTF-8, numbers beyond the range of
/// a double, nesting deeper than 64 levels, and texts whose values would need more than 512 MB of memory.
Value parse_json(std::shared_ptr<const SourceFile> file, Problems& problems);

/// The shortest JSON text of a value: members in their order, doubles that read back bit by bit. Units are
/// omitted.
std::string to_json(const Value& value);

}  // namespace loopwright

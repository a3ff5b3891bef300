/// A diagram file as far as it can be read, with its problems and their places.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include "tools/run/checked_diagram.h"
#include "tools/studio/session/draft.h"
#include "tools/studio/session/layout_file.h"

namespace loopwright::studio {

using Json = nlohmann::ordered_json;

/// null in the place of a number that JSON does not have.
inline Json finite(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

struct CheckedText {
  std::shared_ptr<const ParsedText> parsed;
  CheckedDiagram checked;
  Problems problems;
  bool loads() const { return !checked.summary().empty() && !problems.has_errors(); }
};

/// `path`: of the file, as the engine names it.
CheckedText check_text(const std::string& path, const std::string& text, const LoadOptions& options);

/// One problem, with UTF-16 places if it is in the file of `parsed`. `folder`: left out of names of files.
Json problem_json(const Problem& problem, const ParsedText& parsed, const Utf16& places,
                  const std::string& folder);
Json problems_json(std::span<const Problem> problems, const ParsedText& parsed, const std::string& folder);

/// One level of the diagram: blocks, ports, wires, values (tools/studio/protocol.md). Null if the text is no
/// JSON object. Throws Refused if `inside` leads nowhere.
Json view_json(const CheckedText& text, const std::string& inside, const Variants& variants,
               const Layout& layout);

/// What a block looks like.
Json picture_json(const std::string& type, const Value& settings);

}  // namespace loopwright::studio

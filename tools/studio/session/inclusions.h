/// Where a diagram file contains other files as subdiagrams.
#pragma once
#include <string>
#include <vector>
#include "engine/json/value.h"

namespace loopwright::studio {

/// A block, or one of its variants, whose diagram is a file.
struct Inclusion {
  std::vector<std::string> path;     ///< of the block: "stage", "motor"
  std::vector<const Value*> around;  ///< the diagrams around it in this file, one for each part of the path
  const Value* block;                ///< the last one of the path
  const Value* body;                 ///< of the variant; of the block if it has none
  const Value* file;                 ///< the text that names the file
};

/// Of all levels that are written in this file, and of all variants.
std::vector<Inclusion> inclusions(const Value& diagram);

/// The parts of a path from one of them on, with dots between.
std::string path_from(const std::vector<std::string>& path, size_t first);

/// f(body) for a block, and for each of its variants.
template <class F> void each_body(const Value& block, F&& f) {
  f(block);
  if (const Value::Member* variants = block.find("variants"))
    for (const Value::Member& variant : variants->value.members) f(variant.value);
}

}  // namespace loopwright::studio

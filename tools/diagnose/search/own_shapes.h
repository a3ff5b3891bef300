/// Shapes of terms that stand in effect files.
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "tools/diagnose/search/shape.h"

namespace loopwright::diagnosis {

/// Shapes, and what their texts and formulas refer to.
class ShapeCatalogue {
 public:
  /// The built-in shapes, then those of `more`; or with `instead` those of its folders in the place of the
  /// built-in ones. One of the name of an earlier one takes its place. Throws InputError with every problem
  /// of the files, and if folders are named in which no effect acts at a site.
  ShapeCatalogue(const std::vector<std::string>& instead, const std::vector<std::string>& more);

  std::span<const TermShape> shapes() const { return shapes_; }

 private:
  std::vector<std::shared_ptr<const void>> kept_;
  std::vector<TermShape> shapes_;
};

}  // namespace loopwright::diagnosis

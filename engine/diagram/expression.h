/// Expressions such as "=2*pi*observer_cutoff" over named parameters, evaluated by muParser, with the unit of
/// the result.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "engine/json/problem.h"
#include "engine/unit/rescaling.h"

namespace loopwright {

/// A name in an expression, and where it stands (in bytes).
struct NameUse {
  std::string_view name;
  size_t offset = 0;
  bool is_function = false;
};

/// The names in an expression, in their order; pi and e are left out.
std::vector<NameUse> names_in(std::string_view expression);

/// True for what an expression cannot use as the name of a parameter: pi and e.
bool is_constant_name(std::string_view name);

/// Where a message about an expression points, and what its names mean.
struct ExpressionSite {
  Place place;  ///< of the text in the file: its opening quote
  std::string block;
  /// The quantity of a name; null when the name stands for no number, which `lookup` has then reported.
  std::function<const Quantity*(const NameUse& use, const Place& place)> lookup;
};

/// The value of an expression (without its '='), or nothing after a problem. Known are + - * / ^,
/// comparisons, ?:,
/// && and ||, pi, e, and sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh sqrt exp ln log
/// log2 log10 abs sign rint min max sum avg.
///
/// The unit of the result is found by rescaling (engine/unit/rescaling.h); mixing units is a problem. A
/// result of parameters without units is a bare number. A parameter in Hz is its number of cycles per second.
std::optional<Quantity> evaluate(std::string_view expression, const ExpressionSite& site, Problems& problems);

}  // namespace loopwright

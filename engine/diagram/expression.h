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

/// A name in an expression, and its position (in bytes).
struct NameUse {
  std::string_view name;
  size_t offset = 0;
  bool is_function = false;
};

/// The names in an expression in order, without pi and e.
std::vector<NameUse> names_in(std::string_view expression);

/// True for a name that an expression cannot use for a parameter: pi and e.
bool is_constant_name(std::string_view name);

/// The source location of an expression for messages, and the meaning of its names.
struct ExpressionSite {
  Place place;  ///< of the text in the file: its opening quote
  std::string block;
  /// The quantity of a name; null if the name is not a number, which `lookup` has then reported.
  std::function<const Quantity*(const NameUse& use, const Place& place)> lookup;
};

/// The value of an expression (without its '='), or nothing after a problem. It may use + - * / ^,
/// comparisons, ?:, &&, || and !, pi, e, and sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh
/// atanh sqrt exp ln log log2 log10 abs sign rint min max sum avg.
///
/// The unit of the result is determined by rescaling (engine/unit/rescaling.h); mixing units is a problem. A
/// result of parameters without units is a bare number. A parameter in Hz has the value of its cycles per
/// second.
std::optional<Quantity> evaluate(std::string_view expression, const ExpressionSite& site, Problems& problems);

}  // namespace loopwright

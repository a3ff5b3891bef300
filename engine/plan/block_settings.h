/// What the settings of a block mean for its type: numbers that differ by element, and parameters of the
/// diagram inside its formula.
#pragma once
#include <optional>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"
#include "engine/json/reader.h"

namespace loopwright {

/// Whether a number of the block may be a list, with an element for each element of its signals: a block that
/// is repeated for the elements of vectors, and whose unit does not depend on its numbers.
bool takes_numbers_by_element(const BlockInfo& info);

/// The settings with matrices in the form that each parameter has: a single number as a list, one row or one
/// column as a list of rows (engine/json/matrix_form.h). Nothing if there is no matrix. A matrix of several
/// rows and columns for a list is a problem.
std::optional<Value> settings_in_form(const BlockInfo& info, const Value& settings, const Reader& reader);

/// Settings in which numbers are lists, one for each element; empty: all elements have the same settings.
/// Lists of different lengths are a problem.
std::vector<Value> settings_by_element(const BlockInfo& info, const Value& settings, const std::string& path,
                                       Problems& problems);

/// The settings of a block that has formulas and "constants", with a constant for every number among the
/// parameters of the diagram that its formulas name. Formulas are the texts "formula" and "when", also inside
/// lists. A name in "names", "inputs" or "constants" hides the parameter.
/// Nothing for other blocks, and for formulas without such names.
std::optional<Value> settings_with_constants(const BlockInfo& info, const Value& settings,
                                             const std::vector<Parameter>& parameters);

}  // namespace loopwright

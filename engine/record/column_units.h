/// Columns of recordings as quantities: their units, and which of them is the time.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include "engine/json/problem.h"
#include "engine/record/recording.h"
#include "engine/unit/unit.h"

namespace loopwright {

/// Creates a problem at the source location where the user names the column.
using ColumnError = std::function<Problem&(std::string message)>;

/// The unit of the numbers of the column: from its heading, or `stated` if the heading has none. Nothing, and
/// a problem, if a unit cannot be read or if the two differ, as it is then unknown which is right.
std::optional<Unit> unit_of(const Column& column, const std::string& stated, const ColumnError& error);

/// The same column in SI, with its SI unit.
Column in_si(const Column& column, const Unit& unit);

/// The column with this name; if there is none, null and a problem with the existing names.
const Column* find_column(const Recording& recording, const std::string& name, const ColumnError& error);

/// The time in s, converted from the unit in its heading (t [ms], time [min]); without a unit it is in s.
/// `name` empty: a column named time or t, or otherwise the first, if the columns of the file are ordered.
/// Nothing, and a problem, if the time column cannot be determined or its unit is not a unit of time.
std::optional<Column> time_in_seconds(const Recording& recording, const std::string& name,
                                      const ColumnError& error);

}  // namespace loopwright

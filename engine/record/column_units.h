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

/// Whether every cell of a column that is used holds a number. Otherwise a problem for each of the first that
/// do not, at their places in the file of the recording.
bool is_without_holes(const Column& column, const ColumnError& error);

/// The column with this name; if there is none, null and a problem with the existing names. A column with
/// holes is refused, too.
const Column* find_column(const Recording& recording, const std::string& name, const ColumnError& error);

/// The time in s, converted from the unit in its heading (t [ms], time [min]); without a unit it is in s.
/// `name` empty: a column named time or t, or otherwise the first, if the columns of the file are ordered.
/// Nothing, and a problem, if the time column cannot be determined or its unit is not a unit of time.
std::optional<Column> time_in_seconds(const Recording& recording, const std::string& name,
                                      const ColumnError& error);

/// Makes the time, in s, the first column, as pages show it. Of several columns that are called time, it is
/// the first of the file. False, and a problem, if there is no such column.
bool put_time_first(Recording& recording, const ColumnError& error);

}  // namespace loopwright

/// Columns of recordings as quantities: which unit they are in, and which of them is the time.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include "engine/json/problem.h"
#include "engine/record/recording.h"
#include "engine/unit/unit.h"

namespace loopwright {

/// Makes a problem at the place where the user names the column.
using ColumnError = std::function<Problem&(std::string message)>;

/// The unit of the column's numbers: that of its heading, or `stated` where the heading has none. Nothing,
/// and a problem, when a unit cannot be read, or when the two differ: one of them is wrong then, and nobody
/// can know which.
std::optional<Unit> unit_of(const Column& column, const std::string& stated, const ColumnError& error);

/// The same column in SI, its unit written so.
Column in_si(const Column& column, const Unit& unit);

/// The column of a name; null, and a problem with the names that there are, when there is none.
const Column* find_column(const Recording& recording, const std::string& name, const ColumnError& error);

/// The time in s, from whatever unit its heading says (t [ms], time [min]); without a unit it is in s. `name`
/// empty: a column called time or t, or else the first, if the file has its columns in an order. Nothing, and
/// a problem, when it cannot be told which column is the time, or when its unit is none of time.
std::optional<Column> time_in_seconds(const Recording& recording, const std::string& name,
                                      const ColumnError& error);

}  // namespace loopwright

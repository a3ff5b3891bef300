/// An input that stands in the record later than the machine got it.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// How many rows earlier the machine got its input, if the records show it beside what was found: a log that
/// writes a row before it computes the next command holds the one before. Of the difference between the input
/// and that of the next row, or of the one after it, a share is taken as a parameter: it is one where the log
/// is late by so much, and no effect makes it so; only a diagram that delays its input too much does. Empty:
/// the input is where it belongs, or late in the machine.
std::optional<size_t> rows_logged_late(Trials& trials, const Estimate& found,
                                       std::vector<std::string>& trail);

}  // namespace loopwright::diagnosis

/// From the journal of a deployment to the log that a person asked for.
#pragma once
#include <functional>
#include <string>
#include "engine/record/journal.h"

namespace loopwright {

/// Where a deployment keeps the log that will be `target`: "log.csv" → "log.csv.journal".
std::string journal_of(const std::string& target);

/// Throws InputError when a journal is there already: it may hold the only copy of a log.
void require_no_journal(const std::string& journal);

/// How many rows, how far, and everything that is lost; a few lines.
std::string to_text(const JournalReader& journal);

}  // namespace loopwright

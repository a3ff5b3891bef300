/// Converts the journal of a deployment to the requested log.
#pragma once
#include <functional>
#include <string>
#include "engine/record/journal.h"

namespace loopwright {

/// The file in which a deployment keeps the log that will become `target`: "log.csv" → "log.csv.journal".
std::string journal_of(const std::string& target);

/// Throws InputError if a journal already exists: it may hold the only copy of a log.
void require_no_journal(const std::string& journal);

/// Number of rows, time reached, and everything that was lost; a few lines.
std::string to_text(const JournalReader& journal);

}  // namespace loopwright

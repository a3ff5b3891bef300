/// The effects of the catalogue as candidates: each runs its own blocks.
#pragma once
#include "tools/diagnose/search/candidate.h"
#include "tools/diagnose/search/record_sizes.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// The effects of a catalogue, compiled for a machine.
struct Catalogue {
  std::vector<Effect> effects;
  std::vector<Candidate> candidates;  ///< one per effect, in the same order
  std::vector<NotLookedFor> left_out;
};

/// Why an effect cannot be added to the diagram; empty: it can be added.
using WhyNot = std::function<std::string(const Effect&)>;

/// Why a map of balances contains no information about an effect; empty: it contains some.
std::string not_in_a_map(const Effect& effect);

/// Whether samples of one of them differ in length.
bool has_uneven_rows(const std::vector<std::shared_ptr<const Path>>& paths);

/// Why noise of the recorded input hides an effect; empty: it does not. When a noisy input acts cannot be
/// told.
std::string hidden_by_input_noise(const Effect& effect);

/// Why an effect cannot be told from a controller that knows more than the record, by readings that the
/// record lacks; empty: it can.
std::string hidden_by_controller(const Effect& effect);

/// Effects that cannot be added, and effects whose numbers cannot be computed for these records, are left
/// out. `rows_are_uneven`: see has_uneven_rows(). Throws InputError with every problem of the effect files.
Catalogue make_catalogue(const std::vector<std::string>& folders, const MachineUnits& units,
                         const RecordSizes& of_records, const WhyNot& why_not, bool rows_are_uneven);

}  // namespace loopwright::diagnosis

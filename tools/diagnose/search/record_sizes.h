/// What the motion of the records extends over.
#pragma once
#include <memory>
#include <vector>
#include "tools/diagnose/predict/axis_model.h"
#include "tools/diagnose/predict/responses.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// Extents over all records.
RecordSizes sizes_of(const std::vector<std::shared_ptr<const Path>>& paths,
                     const std::vector<const AxisModel*>& models);

/// [position] What repeats sooner than the first along these records is not looked for, and what repeats
/// sooner than the second must matter.
double shortest_pitch(const RecordSizes& sizes);
double fine_pitch(const RecordSizes& sizes);

}  // namespace loopwright::diagnosis

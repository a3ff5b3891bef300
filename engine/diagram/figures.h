/// The key "figures" of a diagram: which logged signal is to follow which reference, so that a run can be
/// judged. It has no influence on the simulation.
#pragma once
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/json/file_shape.h"
#include "engine/json/reader.h"

namespace loopwright {

/// `{"signal": "stage.position", "reference": "reference.position", "band": {"value": 1, "unit": "um"}}`
struct FigureRequest {
  Wire signal, reference;
  Value band;  ///< a number, perhaps with its unit; null if it was omitted
};

/// The keys of an entry.
FileShape figure_shape();

/// Reads the list. A mistake is reported, and its entry omitted.
std::vector<FigureRequest> read_figures(const Value& list, const Reader& reader);

/// Reads the list again from the file of a diagram that was loaded.
std::vector<FigureRequest> figures_of(const Diagram& diagram, Problems& problems);

}  // namespace loopwright

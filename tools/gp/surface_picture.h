/// The learned disturbance as a surface over position and velocity, with samples: the paper's Fig. 6.
#pragma once
#include "models/gp/table.h"
#include "tools/report/report.h"

namespace loopwright {

struct SurfaceOptions {
  gp::Range position;  ///< m, relative to the model's origin
  gp::Range velocity;  ///< m/s
  std::string label_unit;
};

/// The posterior mean as a mesh seen from above and from the side; `samples` as dots, hidden where the
/// surface is in front of them.
report::Picture surface_picture(const gp::MeanTable& mean, const gp::Samples& samples,
                                const SurfaceOptions& options);

}  // namespace loopwright

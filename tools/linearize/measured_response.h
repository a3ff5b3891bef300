/// Frequency responses as in an experiment: a sine is added to the running diagram, and the output at its
/// frequency is compared with the input.
#pragma once
#include <complex>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/run/simulation.h"

namespace loopwright {

struct MeasuredPoint {
  double frequency = 0;           ///< rad/s
  std::complex<double> response;  ///< output per added signal
};

struct SineTest {
  std::string from;           ///< input port of an outermost block, "stage.force", "sum.terms[1]"
  std::string to;             ///< any port
  double amplitude = 1;       ///< SI, of the added sine
  double settle = 0;          ///< s before the measurement; the sine is on from the start
  int periods = 10;           ///< minimum number of measured periods per sine; rounded up to whole samples
  double sample_time = 1e-3;  ///< s between the rows used
  bool holds = true;          ///< the sine is held between rows, as by a sampled controller
  std::vector<double> frequencies;  ///< rad/s; adjusted slightly so that whole periods fit whole rows
};

/// The diagram with the output `block.y` of a source added to what an input port of an outermost block reads.
/// Problems for a port that does not exist or is inside a subdiagram.
Diagram with_added_signal(const Diagram& diagram, const std::string& port, const BlockEntry& source,
                          Problems& problems);

/// One run per frequency; the mean output and linear drifts over the measured rows cancel. Throws InputError,
/// or std::runtime_error when a run fails.
std::vector<MeasuredPoint> measure_response(const Diagram& diagram, const SineTest& test,
                                            const RunOptions& options = {});

}  // namespace loopwright

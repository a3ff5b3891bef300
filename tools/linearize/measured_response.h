/// Frequency responses as in an experiment: a sine is added to the running diagram, and the output at its
/// frequency is compared with the input.
#pragma once
#include <complex>
#include <optional>
#include <vector>
#include "engine/diagram/diagram.h"
#include "engine/run/simulation.h"

namespace loopwright {

struct MeasuredPoint {
  double frequency = 0;           ///< rad/s
  std::complex<double> response;  ///< output per added signal
};

struct SineTest {
  std::string from;               ///< input port of an outermost block, "stage.force", "sum.terms[1]"
  std::string to;                 ///< any port
  std::vector<std::string> open;  ///< input ports of outermost blocks: held at the operating point
  std::optional<double> at;       ///< s; none: the start. Sine and cuts begin at the operating point
  double amplitude = 1;           ///< SI, of the added sine
  double settle = 0;              ///< s with the sine before it is measured
  int periods = 10;           ///< minimum number of measured periods per sine; rounded up to whole samples
  double sample_time = 1e-3;  ///< s between the rows used
  bool holds = true;          ///< the sine is held between rows, as by a sampled controller
  std::vector<double> frequencies;  ///< rad/s; adjusted slightly so that whole periods fit whole rows
};

/// Two runs for each frequency; the mean output and linear drifts over the measured rows cancel. The ports
/// are those of the linear system of the same names: throws InputError for ports of several numbers and for
/// ports where nothing can be added or cut, Interrupted, and std::runtime_error when a run fails.
std::vector<MeasuredPoint> measure_response(const Diagram& diagram, const SineTest& test,
                                            const RunOptions& options = {});

}  // namespace loopwright

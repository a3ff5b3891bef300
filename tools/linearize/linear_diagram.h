/// A diagram with every block replaced by its slopes at an operating point.
///
///   const LinearDiagram linear = linearize_at_start(*plan);
///   const LinearSystem loop = sampled_system(linear, {.from = {"stage.force"}, .to = {"stage.position"}});
#pragma once
#include "engine/run/simulation.h"
#include "models/linear/state_space.h"
#include "tools/linearize/block_slopes.h"

namespace loopwright {

/// The plan must outlive it.
struct LinearDiagram {
  const Plan* plan = nullptr;
  double time = 0;                      ///< s, of the operating point
  std::vector<LinearBlock> blocks;      ///< one per block of the plan
  std::vector<double> operating_point;  ///< every number of the plan
  std::vector<LinearizationNote> notes;
};

/// At the present instant of a run whose signals are computed. Modes are held, quantizers replaced by
/// straight lines, time is constant; `notes` list where.
LinearDiagram linearize(const Run<double>& run);
/// Before the first step.
LinearDiagram linearize_at_start(const Plan& plan);
/// After simulating up to a time, rounded to a tick. Throws Interrupted, or std::runtime_error when the run
/// fails before.
LinearDiagram linearize_at(const Plan& plan, double time, const RunOptions& options = {});

/// The signals between which the system is computed. A port is named as in the diagram: "stage.position",
/// "command.terms[1]", an input or output of a block or of a subdiagram; "encoder.in.position" is the input
/// if a block has an output of the same name.
struct Access {
  /// Where a signal is added. At an input port it is added to what this port reads, at an output port to what
  /// all its readers read; loops stay closed.
  std::vector<std::string> from;
  /// The outputs: what a block computes at this port, or what feeds it, before anything is added.
  std::vector<std::string> to;
  /// Ports that are cut: readers read only the added signal, or zero.
  std::vector<std::string> open;
};

/// A linear system and the meaning of its numbers, in SI.
struct LinearSystem {
  StateSpace matrices;
  std::vector<std::string> states, inputs, outputs;
  std::vector<std::string> input_units, output_units;  ///< empty: unknown
};

/// The continuous part, with discrete signals held:  x' = A x + B u,  y = C x + D u. Transport delays are the
/// delays of the system. Throws InputError for ports that do not exist.
LinearSystem continuous_part(const LinearDiagram& diagram, const Access& access);

struct SampledSystem : LinearSystem {
  /// Samples in a common period of all rates. With several, `matrices` are lifted: they map one period to the
  /// next, inputs and outputs are stacked sample after sample, matrices.sample_time is the whole period.
  int lifted = 1;
  double base_period = 0;  ///< s, between samples
};

/// The whole diagram, continuous and sampled parts together, from sample to sample. Inputs are held between
/// samples; outputs are read after everything due at the sample was computed; continuous parts advance
/// exactly. States are those just before the sample.
///
/// The sample time is the greatest common divisor of all rates; `sample_time` sets it for a diagram without
/// any, and must otherwise be one of them. A transport delay of a signal that is held between samples is
/// exact; of any other signal it is a Padé approximation of order 6. With `subdivisions`, inputs may change
/// and outputs are read that many times in each sample, lifted: this shows the continuous parts between
/// samples. Throws InputError for ports that do not exist.
SampledSystem sampled_system(const LinearDiagram& diagram, const Access& access, double sample_time = 0,
                             int subdivisions = 1);

/// Throws InputError if the diagram has rates and none of them is this sample time [s]; 0: none is asked for.
void refuse_other_sample_time(const LinearDiagram& diagram, double sample_time);

/// Whether anything in the diagram is sampled.
bool has_samples(const LinearDiagram& diagram);

}  // namespace loopwright

/// Results of `loopwright linearize` for a diagram: matrices, poles, zeros, responses, margins.
#pragma once
#include <optional>
#include "models/linear/margins.h"
#include "models/linear/poles.h"
#include "tools/linearize/linear_diagram.h"
#include "tools/linearize/measured_response.h"
#include "tools/report/report.h"

namespace loopwright {

struct LinearizeRequest {
  Access access;
  std::optional<double> at;  ///< s; none: the start
  std::string break_point;   ///< port at which the loop is cut for margins; empty: none
  bool continuous = false;   ///< only the continuous part, discrete signals held
  double sample_time = 0;    ///< s; sample time for a diagram without rates
  int frequencies = 400;     ///< of the plots
};

/// The loop as seen from a break point, with negative feedback: the response to 1, times -1.
struct LoopAnalysis {
  std::string port;
  Margins margins;
  std::vector<double> frequency;               ///< rad/s
  std::vector<std::complex<double>> response;  ///< loop gain L
  std::vector<std::string> outside;            ///< Margins::outside in words

  /// Whether a signal returns to the port. Otherwise there is nothing to judge.
  bool is_loop() const;
};

struct LinearAnalysis {
  std::string title, plan;  ///< hash
  double time = 0;          ///< s, of the operating point
  LinearSystem system;
  int lifted = 1;
  std::vector<Pole> poles;
  std::optional<std::vector<std::complex<double>>> zeros;  ///< empty: not a square system, or lifted
  std::vector<double> frequency;                           ///< rad/s
  std::vector<Eigen::MatrixXcd> response;                  ///< outputs by inputs, one matrix per frequency
  std::optional<LoopAnalysis> loop;
  std::vector<MeasuredPoint> measured;  ///< of the first channel, by simulation
  size_t sines = 0;                     ///< that were to be measured; more than `measured`: interrupted
  std::vector<LinearizationNote> notes;

  bool is_sampled() const { return system.matrices.sample_time > 0; }
};

/// Throws InputError for ports that do not exist or a break point of several numbers, Interrupted, and
/// std::runtime_error when the run up to the operating point fails.
LinearAnalysis analyse(const Plan& plan, const LinearizeRequest& request, const RunOptions& options = {});

/// Stable keys: time, sample_time, lifted, states, inputs, outputs, A, B, C, D, delays, poles[], zeros[],
/// response.{frequency,channels[]}, loop.{port,margins…,outside[]}, measured[], sines, notes[].
std::string to_json(const LinearAnalysis& analysis);
/// One row per frequency: gain, phase of every channel.
Recording to_recording(const LinearAnalysis& analysis);
std::string to_text(const LinearAnalysis& analysis);
report::Page linear_page(const LinearAnalysis& analysis);

/// Phase in degrees, continued over frequency without jumps.
std::vector<double> unwrapped_degrees(const std::vector<std::complex<double>>& response);
/// One channel of the response over frequency.
std::vector<std::complex<double>> channel_response(const LinearAnalysis& analysis, Eigen::Index input,
                                                   Eigen::Index output);
/// "feedback.command 62 %, stage.mass.velocity 30 %": participation of the states in a pole.
std::string owners(const Pole& pole, const std::vector<std::string>& states);
/// "z = 0.98 ± 0.1j (stage.mass.velocity 92 %)"
std::string text_of(const Pole& pole, double sample_time, const std::vector<std::string>& states);
/// One sentence for each mode that is not judged, with its states; a pair of poles is one mode.
std::vector<std::string> texts_of(const std::vector<Modes::Outside>& modes, double sample_time,
                                  const std::vector<std::string>& states);
/// "stable", "at the boundary of stability", "UNSTABLE"
std::string_view text_of(Stability stability);

}  // namespace loopwright

#include "tools/linearize/analysis.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/linear/frequency_range.h"
#include "models/linear/frequency_response.h"
#include "tools/linearize/ports.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;

struct Sampling {
  LinearSystem system;
  int lifted = 1;
};

Sampling system_between(const LinearDiagram& diagram, const Access& access, const LinearizeRequest& request) {
  if (request.continuous || (!has_samples(diagram) && request.sample_time == 0))
    return {continuous_part(diagram, access), 1};
  SampledSystem sampled = sampled_system(diagram, access, request.sample_time);
  return {sampled, sampled.lifted};
}

LoopAnalysis analyse_loop(const LinearDiagram& diagram, const LinearizeRequest& request) {
  const std::string& port = request.break_point;
  Problems problems;
  if (const auto found = find_port(*diagram.plan, port, problems); found.size() > 1)
    problems
        .error({}, "", "",
               fmt::format("the loop cannot be cut at \"{}\": it has {} numbers", port, found.size()))
        .hint = "give one of them an index, as in sum.terms[0]";
  if (problems.has_errors()) throw InputError(std::move(problems));
  std::vector<std::string> open = request.access.open;  // other loops that the user has cut stay cut
  if (std::ranges::find(open, port) == open.end()) open.push_back(port);
  Sampling loop = system_between(diagram, {{port}, {port}, open}, request);
  loop.system.matrices.C *= -1, loop.system.matrices.D *= -1;
  if (!loop.system.matrices.delays.empty()) {  // inputs of the delays keep their sign
    const Index delays = Index(loop.system.matrices.delays.size());
    loop.system.matrices.C.bottomRows(delays) *= -1, loop.system.matrices.D.bottomRows(delays) *= -1;
  }
  LoopAnalysis result;
  result.port = port;
  result.margins = margins(loop.system.matrices, loop.lifted);
  result.outside = texts_of(result.margins.outside, loop.system.matrices.sample_time, loop.system.states);
  result.frequency = loop_frequencies(loop.system.matrices, request.frequencies, loop.lifted);
  const FrequencyResponse response(loop.system.matrices, loop.lifted);
  for (double frequency : result.frequency) result.response.push_back(response.at(frequency)(0, 0));
  return result;
}

}  // namespace

LinearAnalysis analyse(const Plan& plan, const LinearizeRequest& request, const RunOptions& options) {
  const LinearDiagram diagram =
      request.at ? linearize_at(plan, *request.at, options) : linearize_at_start(plan);
  LinearAnalysis analysis;
  analysis.title = plan.title, analysis.plan = plan.hash, analysis.time = diagram.time;
  analysis.notes = diagram.notes;
  const Sampling found = system_between(diagram, request.access, request);
  analysis.system = found.system, analysis.lifted = found.lifted;
  const StateSpace& matrices = analysis.system.matrices;
  analysis.poles = poles(with_approximate_delays(matrices, 6));
  const Index inputs = matrices.inputs(), outputs = matrices.outputs();
  if (inputs > 0 && inputs == outputs && found.lifted == 1 && matrices.delays.empty())
    analysis.zeros = transmission_zeros(matrices);
  if (inputs > 0 && outputs > 0) {
    analysis.frequency = interesting_frequencies(matrices, request.frequencies, found.lifted);
    const FrequencyResponse response(matrices, found.lifted);
    for (double frequency : analysis.frequency) analysis.response.push_back(response.at(frequency));
  }
  if (!request.break_point.empty()) analysis.loop = analyse_loop(diagram, request);
  return analysis;
}

bool LoopAnalysis::is_loop() const {
  return std::ranges::any_of(response, [](const Complex& value) { return value != 0.0; });
}

std::vector<Complex> channel_response(const LinearAnalysis& analysis, Index input, Index output) {
  std::vector<Complex> response;
  for (const Eigen::MatrixXcd& all : analysis.response) response.push_back(all(output, input));
  return response;
}

std::vector<double> unwrapped_degrees(const std::vector<Complex>& response) {
  std::vector<double> degrees;
  for (const Complex& value : response) {
    double phase = std::arg(value) * 180 / std::numbers::pi;
    if (!degrees.empty()) phase += 360 * std::round((degrees.back() - phase) / 360);
    degrees.push_back(phase);
  }
  return degrees;
}

}  // namespace loopwright

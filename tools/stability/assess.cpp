#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include "models/linear/structure.h"
#include "tools/linearize/analysis.h"
#include "tools/linearize/ports.h"
#include "tools/stability/certificates.h"
#include "tools/stability/kick.h"
#include "tools/stability/nonlinearities.h"
#include "tools/stability/paper_condition.h"

namespace loopwright {
namespace {

constexpr int subdivisions = 4;              ///< of a sample, for functions of continuous signals
constexpr double continuous_samples = 1e-4;  ///< s; for a loop without any rate

class Assessment {
 public:
  Assessment(const std::string& path, const LoadOptions& load, const StabilityRequest& request,
             const RunOptions& options)
      : path_(path), load_(load), request_(request), options_(options) {
    Problems problems;
    diagram_ = load_diagram(path, load, problems);
    plan_ = diagram_ ? compile(*diagram_, problems) : nullptr;
    if (!plan_) throw InputError(std::move(problems));
    roles_ = find_roles(*plan_, *diagram_, request.disturbance, problems);
    if (!roles_.learned.empty()) learned_ = read_learned(*diagram_, roles_.learned, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
  }

  StabilityReport assess() {
    name();
    linearize_loop();
    judge_linear_part();
    certify_functions();
    report_.paper = paper_condition(linear_, roles_, learned_, report_.alpha, unit_, sample_time_);
    if (request_.kicks) kick_all();
    return std::move(report_);
  }

 private:
  void name() {
    report_.title = plan_->title, report_.plan = plan_->hash;
    report_.disturbance = roles_.disturbance, report_.position = roles_.position;
    report_.observer = roles_.observer, report_.feedback = roles_.feedback, report_.learned = roles_.learned;
    report_.lead = learned_.lead;
    report_.position_unit = unit_of(roles_.position), report_.command_unit = unit_of(roles_.disturbance);
  }
  std::string unit_of(const std::string& port) {
    Problems problems;
    const auto found = find_port(*plan_, port, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    if (port == roles_.position) measured_ = plan_->name_of(found[0].number);
    const auto unit = plan_->unit_of(found[0].number);
    return unit ? to_string(*unit) : "";
  }

  void linearize_loop() {
    const VisitedRanges visited =
        visit(*plan_, options_, [&](Run<double>& run) { linear_ = linearize(run); });
    // That run no longer exists; blocks without memory are the same in a new one.
    Run<double> run(*plan_);
    run.evaluate(run.due(), true);
    linear_.plan = plan_.get();
    report_.nonlinearities = find_nonlinearities(run, visited, linear_);
    report_.notes = linear_.notes;
    sample_time_ = has_samples(linear_) ? 0 : continuous_samples;
    cut_learned();
  }
  /// The learned block is removed from the linear part; its factor is read from the filter after it.
  void cut_learned() {
    if (roles_.learned.empty()) return;
    for (size_t b = 0; b < plan_->blocks.size(); ++b)
      if (plan_->blocks[b].path == roles_.learned) linear_.blocks[b].D.setZero();
    unit_ = 1;
    if (!roles_.weighting.empty()) {
      const std::string prediction = roles_.weighting + ".in.prediction";
      const SampledSystem filter = sampled_system(
          linear_, {{prediction}, {roles_.weighting + ".compensation"}, {prediction}}, sample_time_);
      unit_ = std::abs((filter.matrices.C *
                            (Eigen::MatrixXd::Identity(filter.matrices.states(), filter.matrices.states()) -
                             filter.matrices.A)
                                .inverse() *
                            filter.matrices.B +
                        filter.matrices.D)(0, 0));
    }
    report_.alpha = unit_;
    if (unit_ == 0)
      report_.warnings.push_back(
          "the weight of the learned compensation is zero at the end of the run: nothing of it is judged");
    Nonlinearity function;
    function.block = roles_.learned, function.output = roles_.learned + ".prediction";
    function.is_learned = true, function.bound = learned_.greatest;
    function.source = "bounds from the model's kernel and its curvature";
    function.inputs = {{roles_.learned + ".in.position", 0, learned_.by_position, 0, 0},
                       {roles_.learned + ".in.velocity", 0, learned_.by_velocity, 0, 0}};
    std::erase_if(report_.nonlinearities, [&](const Nonlinearity& n) { return n.block == roles_.learned; });
    report_.nonlinearities.insert(report_.nonlinearities.begin(), function);
    if (!learned_.holds_beyond_training)
      report_.warnings.push_back(
          "beyond the trained velocities the learned block follows its kernel: the slopes hold "
          "within them only (\"untrained\": \"hold\" makes them hold everywhere)");
  }

  void judge_linear_part() {
    // What the plant's input moves, and what shows at this input or in the position. An integral that is only
    // recorded is outside.
    const SampledSystem loop = sampled_system(
        linear_, {{roles_.disturbance}, {roles_.disturbance, roles_.position}, {}}, sample_time_);
    const Modes modes = modes_between(loop.matrices);
    report_.sample_time = loop.matrices.sample_time / loop.lifted;
    report_.linear_part = modes.stability, report_.largest_pole = modes.outermost;
    for (std::string& mode : texts_of(modes.outside, loop.matrices.sample_time, loop.states))
      report_.warnings.push_back(std::move(mode));
    SampledSystem cut = sampled_system(
        linear_, {{roles_.disturbance}, {roles_.disturbance}, {roles_.disturbance}}, sample_time_);
    cut.matrices.C *= -1, cut.matrices.D *= -1;
    report_.margins = margins(cut.matrices, cut.lifted);
  }

  void certify_functions() {
    std::vector<BoundedFunction> functions;
    for (const Nonlinearity& n : report_.nonlinearities) {
      if (n.has_jumps) {
        report_.warnings.push_back(
            fmt::format("{} jumps: no slope bounds it, and the certificates say nothing about it", n.block));
        continue;
      }
      BoundedFunction function{n.output, {}, n.is_learned};
      for (const Nonlinearity::Input& input : n.inputs)
        function.inputs.push_back({{{input.port, 1.0}}, input.deviation});
      if (n.is_learned && learned_.lead != 0)
        function.inputs[0].ports.push_back({n.inputs[1].port, learned_.lead});
      functions.push_back(std::move(function));
    }
    if (!report_.linear_part_is_stable()) return;
    if (unit_ == 0) return;
    const auto certificate = [&](GainOf gain, int parts) {
      return certify(small_gain_matrix(linear_, functions, unit_, sample_time_, parts, gain), functions,
                     report_.alpha);
    };
    report_.peak = certificate(GainOf::peak, subdivisions), report_.energy = certificate(GainOf::energy, 1);
    if (!roles_.learned.empty())
      report_.displacement =
          learned_.greatest *
          gain_bound(
              sampled_system(linear_, {{roles_.learned + ".prediction"}, {roles_.position}, {}}, sample_time_)
                  .matrices,
              GainOf::peak);
  }

  /// At the diagram's α, and, with a learned block, at the largest certified α and at twice that.
  void kick_all() {
    double floor = 0;
    for (const LinearizationNote& note : linear_.notes)
      if (note.kind == LinearizationNote::Kind::staircase) floor = std::max(floor, 2 * note.size);
    std::vector<double> alphas{report_.alpha};
    const double largest = report_.peak.largest_alpha;
    if (!roles_.weighting.empty() && std::isfinite(largest) && largest > 0)
      alphas.insert(alphas.end(), {largest, 2 * largest});
    for (double alpha : alphas) {
      LoadOptions load = load_;
      if (alpha != report_.alpha)
        load.set.emplace_back(roles_.weighting + ".weight", fmt::format("{}", alpha));
      Problems problems;
      const auto diagram = load_diagram(path_, load, problems);
      if (!diagram || problems.has_errors()) throw InputError(std::move(problems));
      KickTest test = kick(*diagram, roles_.disturbance, measured_, request_.kick, request_.kick_duration,
                           floor, options_);
      test.alpha = alpha;
      report_.kicks.push_back(std::move(test));
    }
  }

  const std::string path_;
  const LoadOptions& load_;
  const StabilityRequest& request_;
  const RunOptions& options_;
  std::shared_ptr<const Diagram> diagram_;
  std::shared_ptr<const Plan> plan_;
  LoopRoles roles_;
  LearnedFunction learned_;
  LinearDiagram linear_;
  StabilityReport report_;
  std::string measured_;  ///< the output that the position port reads
  double unit_ = 1, sample_time_ = 0;
};

}  // namespace

StabilityReport assess_stability(const std::string& path, const LoadOptions& load,
                                 const StabilityRequest& request, const RunOptions& options) {
  return Assessment(path, load, request, options).assess();
}

}  // namespace loopwright

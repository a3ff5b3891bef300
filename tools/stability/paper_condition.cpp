#include "tools/stability/paper_condition.h"
#include "models/linear/frequency_response.h"
#include "models/linear/structure.h"
#include "tools/stability/certificates.h"

namespace loopwright {
namespace {

class Gains {
 public:
  Gains(const LinearDiagram& linear, double sample_time) : linear_(linear), sample_time_(sample_time) {}
  StateSpace system(const std::string& from, const std::string& to, std::vector<std::string> open) const {
    return connected_part(sampled_system(linear_, {{from}, {to}, std::move(open)}, sample_time_).matrices);
  }
  /// ‖·‖₁ of a block by itself: all its inputs are cut.
  double of(const std::string& from, const std::string& to, std::vector<std::string> open) const {
    return gain_bound(system(from, to, std::move(open)), GainOf::peak);
  }

 private:
  const LinearDiagram& linear_;
  double sample_time_;
};

double at_rest(const StateSpace& system) { return std::abs(FrequencyResponse(system).at(0)(0, 0)); }

}  // namespace

std::optional<PaperCondition> paper_condition(const LinearDiagram& linear, const LoopRoles& roles,
                                              const LearnedFunction& learned, double alpha, double unit,
                                              double sample_time) {
  if (roles.observer.empty() || roles.feedback.empty()) return {};
  const Gains gains(linear, sample_time);
  const std::string estimate = roles.observer + ".disturbance", seen = roles.observer + ".in.measured",
                    sent = roles.observer + ".in.command", error = roles.feedback + ".in.measured",
                    command = roles.feedback + ".command";
  PaperCondition c;
  c.alpha = alpha;
  const StateSpace SP = gains.system(roles.disturbance, roles.position, {estimate}),
                   QP = gains.system(seen, estimate, {seen, sent}),
                   Q = gains.system(sent, estimate, {seen, sent}), C = gains.system(error, command, {error});
  c.gamma_dx = gain_bound(SP, GainOf::peak);
  c.gamma_q = gain_bound(QP, GainOf::peak), c.gain_q = gain_bound(Q, GainOf::peak);
  c.gamma_xu = gain_bound(C, GainOf::peak);
  c.gamma_xd = gains.of(roles.feedback + ".in.reference", roles.position, {estimate});
  if (!roles.velocity_estimator.empty()) {
    const std::string position = roles.velocity_estimator + ".in.position";
    c.gamma_v = gains.of(position, roles.velocity_estimator + ".velocity", {position});
  }
  if (!roles.weighting.empty()) {
    const std::string prediction = roles.weighting + ".in.prediction";
    c.gamma_g = gains.of(prediction, roles.weighting + ".compensation", {prediction}) / unit;
  }
  c.K = learned.by_position + (learned.by_velocity + learned.by_position * learned.lead) * c.gamma_v;
  const double compensation = c.gamma_g * c.K;
  c.rho_printed = c.gamma_dx * (c.gamma_q * (1 + c.gamma_xu) + alpha * compensation);
  c.rho_corrected = c.gamma_dx * (c.gamma_q + c.gain_q * c.gamma_xu + alpha * compensation);
  c.least_rho = at_rest(SP) * (std::abs(QP.D(0, 0)) + at_rest(Q) * at_rest(C));
  c.c0_factor = c.gamma_dx * c.gamma_g * alpha;
  if (compensation > 0) {
    c.alpha_printed = (1 / c.gamma_dx - c.gamma_q * (1 + c.gamma_xu)) / compensation;
    c.alpha_corrected = (1 / c.gamma_dx - c.gamma_q - c.gain_q * c.gamma_xu) / compensation;
  }
  return c;
}

}  // namespace loopwright

#include "engine/run/ring.h"

namespace loopwright {

void RingSolver<double>::build(std::vector<Call<double>> calls, double* numbers, const std::vector<Number>& tears) {
  calls_ = std::move(calls);
  for (Number n : tears) tears_.push_back(numbers + n);
  y_.resize(tears_.size());
  newton_ = std::make_unique<NewtonSolver>(NewtonOptions{}, AlgebraicSystem{this, int(tears_.size()), &residual});
}

bool RingSolver<double>::residual(void* self, const double* y, double* r) {
  auto& ring = *static_cast<RingSolver*>(self);
  for (size_t i = 0; i < ring.tears_.size(); ++i) *ring.tears_[i] = y[i];
  uint64_t bad = 0;
  for (const Call<double>& c : ring.calls_) bad |= c.step(c);
  for (size_t i = 0; i < ring.tears_.size(); ++i) r[i] = *ring.tears_[i] - y[i];
  return bad == 0;
}

uint64_t RingSolver<double>::step(const Call<double>& call) {
  auto& ring = *const_cast<RingSolver*>(static_cast<const RingSolver*>(call.block));
  for (size_t i = 0; i < ring.tears_.size(); ++i) ring.y_[i] = std::isfinite(*ring.tears_[i]) ? *ring.tears_[i] : 0.0;
  const NewtonResult result = ring.newton_->solve(ring.y_);
  if (result.status != NewtonStatus::converged)
    return report_fault(*call.report, call.index, {1, "the ring of direct feedthrough that it stands in has no solution that Newton's method can find"});
  std::vector<double>& y = ring.y_;
  for (size_t i = 0; i < ring.tears_.size(); ++i) *ring.tears_[i] = y[i];
  for (const Call<double>& c : ring.calls_) c.step(c);
  return 0;
}

}  // namespace loopwright

#include "models/gp/model.h"

namespace loopwright::gp {
namespace {

using Solved = std::variant<StructuredPosterior, DensePosterior>;

Solved solve(const Model& model) {
  if (const auto* samples = std::get_if<Samples>(&model.data)) return DensePosterior(model.kernel, *samples);
  return StructuredPosterior(model.kernel, std::get<Statistics>(model.data));
}

}  // namespace

Posterior::Posterior(const Model& model)
    : terms_(model.kernel.terms),
      label_mean_(model.label_mean),
      trained_(model.trained),
      solved_(solve(model)) {}

double Posterior::mean(const Point& at) const {
  return label_mean_ + std::visit([&](const auto& p) { return p.mean(at); }, solved_);
}
double Posterior::variance(const Point& at) const {
  return std::visit([&](const auto& p) { return p.variance(at); }, solved_);
}
Jet Posterior::term(size_t index, const Point& at) const {
  return std::visit([&](const auto& p) { return p.term(index, at); }, solved_);
}
double Posterior::term_norm(size_t index) const {
  return std::visit([&](const auto& p) { return p.term_norm(index); }, solved_);
}
double Posterior::weight_sum() const {
  return std::visit([](const auto& p) { return p.weight_sum(); }, solved_);
}

}  // namespace loopwright::gp

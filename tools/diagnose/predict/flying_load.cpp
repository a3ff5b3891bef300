#include "tools/diagnose/predict/flying_load.h"
#include <algorithm>
#include "tools/diagnose/predict/linear_load.h"

namespace loopwright::diagnosis {

FlyingLoad::FlyingLoad(std::unique_ptr<SwitchedSample> load, const LinearAxis& axis, const Noise& noise,
                       double nominal_inertia)
    : load_(std::move(load)),
      gains_(GainSteps::of(axis, load_->follows(), noise, nominal_inertia)),
      memory_(noise.memory) {
  flight_.steps.without = axis, flight_.steps.load = load_->follows();
}

void FlyingLoad::start(double position, double velocity) { states_ = load_->start(position, velocity); }

void FlyingLoad::correct(const double* gains, double error) {
  const size_t first = size_t(flight_.steps.without.A.rows());
  for (size_t i = 0; i < states_.size(); ++i) states_[i] += gains[first + i] * error;
}

FlyingLoad::Push FlyingLoad::step(double position, double velocity, double free_acceleration, double input,
                                  double force) {
  const LinearAxis& axis = flight_.steps.without;
  flight_.states.insert(flight_.states.end(), states_.begin(), states_.end());
  flight_.free_acceleration.push_back(free_acceleration);
  const GivenSignals given{{position, velocity, free_acceleration, free_acceleration, 0, input, force}};
  const std::vector<double>& result = load_->from(states_, given);
  const Push push{result[states_.size()], result[states_.size() + 1]};
  const std::vector<double> next(result.begin(), result.begin() + std::ptrdiff_t(states_.size()));
  const uint32_t map = load_->map_of(states_, given);
  for (size_t i = flight_.steps.A.size(); i < load_->maps().size(); ++i)
    flight_.steps.A.push_back(with_load(axis, load_->maps()[i]).A);
  flight_.steps.of_row.push_back(map);
  gains_->advance(flight_.steps.A[map]);
  states_ = next;
  return push;
}

std::pair<LinearAxis, Gains> along_flight(LinearAxis axis, const std::shared_ptr<const Flight>& flight,
                                          const Noise& noise, double nominal_inertia) {
  const Eigen::Index own = axis.A.rows(), added = Eigen::Index(flight->steps.load.size()), n = own + added;
  const auto push_of_load = [&](const Eigen::MatrixXd& A) {
    return A.topRightCorner(own, added).cwiseAbs().maxCoeff();
  };
  for (Eigen::VectorXd* vector : {&axis.push, &axis.input_push, &axis.noise_push, &axis.slope_share})
    vector->conservativeResizeLike(Eigen::VectorXd::Zero(n));
  axis.C.conservativeResizeLike(Eigen::MatrixXd::Zero(axis.C.rows(), n));
  axis.A = *std::ranges::max_element(flight->steps.A, {}, push_of_load), axis.load_states += added;
  Gains gains = gains_of(axis, noise, nominal_inertia);
  gains.rows = {flight, &flight->gains}, axis.steps = {flight, &flight->steps};
  return {std::move(axis), std::move(gains)};
}

Columns load_derivatives(SwitchedSample& load, std::span<const std::unique_ptr<SwitchedSample>> changed,
                         std::span<const double> steps, const Path& path, const Flight& flight) {
  const size_t rows = path.samples(), own = load.follows().size();
  std::vector<std::vector<float>> numbers(changed.size() * (own + 2), std::vector<float>(rows));
  std::vector<double> now(own);
  for (size_t k = 0; k < rows; ++k) {
    std::copy_n(flight.states.begin() + std::ptrdiff_t(k * own), own, now.begin());
    const double free = flight.free_acceleration[k];
    const GivenSignals given{
        {path.position[k], path.velocity[k], free, free, 0, path.input[k], path.force[k]}};
    const std::vector<double>& here = load.from(now, given);
    for (size_t i = 0; i < changed.size(); ++i) {
      const std::vector<double>& there = changed[i]->from(now, given);
      for (size_t j = 0; j < own + 2; ++j)
        numbers[i * (own + 2) + j][k] = float((there[j] - here[j]) / steps[i]);
    }
  }
  Columns columns;
  for (size_t i = 0; i < changed.size(); ++i) {
    auto* of_this = &numbers[i * (own + 2)];
    Column column(std::move(of_this[own]), std::move(of_this[own + 1]));
    for (size_t j = 0; j < own; ++j)
      column.load.push_back(std::make_shared<const std::vector<float>>(std::move(of_this[j])));
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace loopwright::diagnosis

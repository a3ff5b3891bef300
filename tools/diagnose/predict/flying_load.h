/// A load that touches and flies, as states of the predictor (extended Kalman filter): it is moved from where
/// the measurements of the past have put it, and the gains of each row follow from whether it touches.
#pragma once
#include <utility>
#include "tools/diagnose/predict/noise.h"
#include "tools/diagnose/predict/responses.h"

namespace loopwright::diagnosis {

/// What the load adds to a prediction, row by row.
struct Flight {
  AxisSteps steps;
  Gains::Rows gains;
  std::vector<double> states;             ///< rows × states, after the correction
  std::vector<double> free_acceleration;  ///< of the axis without the load, in the sample after each row
};

class FlyingLoad {
 public:
  /// `axis`: without the load, its position and velocity are states.
  FlyingLoad(std::unique_ptr<SwitchedSample> load, const LinearAxis& axis, const Noise& noise,
             double nominal_inertia);

  void start(double position, double velocity);
  /// The gains of the next row: by columns, of the states of the axis, those of the load, and the slow force.
  const double* gains() { return gains_->correct(flight_.gains); }
  /// (n + 1): where the column of the next port begins.
  size_t gains_a_port() const { return size_t(flight_.steps.without.A.rows()) + states_.size() + 1; }
  double memory() const { return memory_; }  ///< of the slow force: see Noise
  /// By the error of a measured port, and its column of the gains.
  void correct(const double* gains, double error);

  /// The force that it takes from the axis over a sample.
  struct Push {
    double mean = 0, slope = 0;
  };
  /// Moves the load over a sample that begins with this motion; `free_acceleration`: the mean that the axis
  /// would have without it.
  Push step(double position, double velocity, double free_acceleration, double input, double force);
  Flight take() { return std::move(flight_); }

 private:
  std::unique_ptr<SwitchedSample> load_;
  std::unique_ptr<GainSteps> gains_;
  Flight flight_;
  const double memory_;
  std::vector<double> states_;
};

/// The axis with the load and the gains as they were along a flight. A row on which the load acts stands for
/// all where only one is asked for.
std::pair<LinearAxis, Gains> along_flight(LinearAxis axis, const std::shared_ptr<const Flight>& flight,
                                          const Noise& noise, double nominal_inertia);

/// What each parameter changes of one sample of the load, at every row of a prediction: as columns with the
/// states of the load. `changed`: the load with each parameter changed by its step.
Columns load_derivatives(SwitchedSample& load, std::span<const std::unique_ptr<SwitchedSample>> changed,
                         std::span<const double> steps, const Path& path, const Flight& flight);

}  // namespace loopwright::diagnosis

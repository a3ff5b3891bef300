/// The common job (diagrams/linear_motor/common_job.json and common_job_continuous.json) written by hand
/// without an engine: one loop, one plant, libm. It is the reference for the speed of the engine.
#pragma once
#include <cstddef>
#include <vector>

namespace loopwright::by_hand {

/// A sampled or continuous controller makes a linear motor follow 0 → 0.6 m in 2.6 s.
struct Job {
  struct Segment {
    double duration, velocity;
  };  ///< [s], [m/s] at its end
  std::vector<Segment> segments{{0.05, 0},      {0.2, 0.15}, {0.7375, 0.15}, {0.2, 0.35},
                                {1.0625, 0.35}, {0.3, 0},    {0.05, 0}};
  double stop = 2.6;                                         ///< [s]
  double sample_time = 0.001;                                ///< [s]
  double encoder_resolution = 2e-7;                          ///< [m]; 0: not quantized
  double Kp = 2000, Kd = 30;                                 ///< [N/m], [N s/m]
  double derivative_pole = 1000;                             ///< [rad/s]
  double nominal_mass = 0.2621;                              ///< [kg]
  double nominal_damping = 3;                                ///< [N s/m]
  double observer_cutoff = 2 * 3.14159265358979323846 * 20;  ///< [rad/s]
  double mass = 0.2621;                                      ///< [kg]
  double damping = 3;                                        ///< [N s/m]
  double cogging = 2;                                        ///< [N]
  double pole_pitch = 0.0225;                                ///< [m]
  double coulomb = 0.3;                                      ///< [N]
  double transition_speed = 0.05;                            ///< [m/s]
};

struct Wanted {
  double position, velocity, acceleration;  ///< [m], [m/s], [m/s²]
};

struct Outcome {
  double final_position = 0;  ///< [m]
  double peak_error = 0;      ///< [m] largest |reference - position| over the rows
};

/// The signals that the diagrams log, one value a millisecond. Memory is reserved before the run.
struct Rows {
  explicit Rows(size_t rows) {
    for (auto* column : {&time, &reference, &position, &error, &command, &disturbance}) column->reserve(rows);
  }
  void clear() {
    for (auto* column : {&time, &reference, &position, &error, &command, &disturbance}) column->clear();
  }
  void add(double t, double r, double x, double u, double d) {
    time.push_back(t), reference.push_back(r), position.push_back(x), error.push_back(r - x),
        command.push_back(u), disturbance.push_back(d);
  }
  Outcome outcome() const;
  std::vector<double> time, reference, position, error, command, disturbance;
};

/// Sampled controller; the plant by the classical Runge-Kutta method with `steps_per_sample` steps a sample.
/// No rows.
Outcome run_rk4(const Job& job, int steps_per_sample);

/// Sampled controller; the plant by Dormand & Prince 5(4). The step size is carried across samples.
void run_dormand_prince(const Job& job, double relative_tolerance, double absolute_tolerance, Rows& rows);

/// Continuous controller; CVODE, BDF and dense Newton, from one segment border to the next, where the third
/// derivative of the reference jumps: stop time before it, restart after it. Rows are interpolated.
void run_cvode(const Job& job, double relative_tolerance, double absolute_tolerance, Rows& rows);

}  // namespace loopwright::by_hand

/// Compiled once for every instruction set. Everything is inlined, so that the linker cannot use a function
/// from here in code for other machines.
#pragma once
#include "models/real/functions.h"
#include "tests/benchmarks/common_job_lanes_by_hand.h"

namespace loopwright::by_hand {

template <class Real> struct LanePlant {
  double damping, cogging, wave_number, coulomb, per_speed;
  Real per_mass;
  LW_INLINE Real acceleration(const Real& x, const Real& v, const Real& force) const {
    return (force - damping * v - cogging * sine(wave_number * x) -
            coulomb * hyperbolic_tangent(v * per_speed)) *
           per_mass;
  }
};

template <class Real> struct LaneSection {
  double b0, b1, b2, a1, a2;
  Real s1 = 0.0, s2 = 0.0;
  LW_INLINE Real next(const Real& u) {
    const Real y = b0 * u + s1;
    s1 = b1 * u - a1 * y + s2;
    s2 = b2 * u - a2 * y;
    return y;
  }
};

/// The controller of run_rk4, one run for each lane.
template <class Real> struct LaneController {
  const Job& job;
  double keep, slope;
  LaneSection<Real> measured, commanded;
  Real rate = 0.0, last_error = 0.0, last_command = 0.0;

  LW_INLINE explicit LaneController(const Job& j) : job(j) {
    const double turn = job.derivative_pole * job.sample_time;
    keep = (2 - turn) / (2 + turn), slope = 2 * job.derivative_pole / (2 + turn);
    const double c = 2 / job.sample_time, w = job.observer_cutoff, M = job.nominal_mass,
                 B = job.nominal_damping;
    const double scale = w * w / ((c + w) * (c + w)), pole = (c - w) / (c + w);
    measured = {scale * (M * c * c + B * c), scale * -2 * M * c * c, scale * (M * c * c - B * c), -2 * pole,
                pole * pole};
    commanded = {scale, 2 * scale, scale, -2 * pole, pole * pole};
  }
  LW_INLINE Real command(const Wanted& wanted, const Real& position) {
    const Real counted = job.encoder_resolution * round_even(position * (1 / job.encoder_resolution));
    const Real error = wanted.position - counted;
    rate = keep * rate + slope * (error - last_error);
    last_error = error;
    const Real disturbance = measured.next(counted) - commanded.next(last_command);
    const double feedforward = job.nominal_mass * wanted.acceleration + job.nominal_damping * wanted.velocity;
    return last_command = job.Kp * error + job.Kd * rate + feedforward - disturbance;
  }
};

template <class Real>
LW_INLINE void run_lanes(const Job& job, std::span<const Wanted> reference, int steps_per_sample,
                         const double* masses, Outcome* outcomes) {
  Real mass;
  for (int l = 0; l < lanes_of<Real>; ++l) set_lane(mass, l, masses[l]);
  LaneController<Real> controller(job);
  const LanePlant<Real> plant{job.damping,
                              job.cogging,
                              2 * 3.14159265358979323846 / job.pole_pitch,
                              job.coulomb,
                              1 / job.transition_speed,
                              1.0 / mass};
  const double h = job.sample_time / steps_per_sample, half = 0.5 * h, sixth = h / 6;
  Real x = 0.0, v = 0.0, peak_error = 0.0;
  for (size_t k = 0; k + 1 < reference.size(); ++k) {
    const Real u = controller.command(reference[k], x);
    peak_error = maximum(peak_error, absolute(reference[k].position - x));
    for (int i = 0; i < steps_per_sample; ++i) {
      const Real a1 = plant.acceleration(x, v, u);
      const Real v2 = v + half * a1, a2 = plant.acceleration(x + half * v, v2, u);
      const Real v3 = v + half * a2, a3 = plant.acceleration(x + half * v2, v3, u);
      const Real v4 = v + h * a3, a4 = plant.acceleration(x + h * v3, v4, u);
      x += sixth * (v + 2.0 * (v2 + v3) + v4);
      v += sixth * (a1 + 2.0 * (a2 + a3) + a4);
    }
  }
  peak_error = maximum(peak_error, absolute(reference.back().position - x));
  for (int l = 0; l < lanes_of<Real>; ++l) outcomes[l] = {lane(x, l), lane(peak_error, l)};
}

}  // namespace loopwright::by_hand

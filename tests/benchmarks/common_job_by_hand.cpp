#include "tests/benchmarks/common_job_by_hand.h"
#include "tests/benchmarks/common_job_lanes_by_hand.h"
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopwright::by_hand {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Velocity ramps w = (1 - cos πs)/2 between given velocities.
class Reference {
 public:
  explicit Reference(const Job& job) {
    double begin = 0, position = 0, velocity = 0;
    for (const auto& [duration, next_velocity] : job.segments) {
      pieces_.push_back({begin, begin + duration, position, velocity, next_velocity - velocity, duration});
      begin += duration, position += 0.5 * (velocity + next_velocity) * duration, velocity = next_velocity;
    }
    pieces_.push_back({begin, HUGE_VAL, position, velocity, 0, 1});
  }
  size_t pieces() const { return pieces_.size() - 1; }
  double end_of(size_t piece) const { return pieces_[piece].end; }
  /// Only time advances between calls.
  Wanted at(double time) {
    while (time >= pieces_[now_].end) ++now_;
    return within(now_, time);
  }
  Wanted within(size_t piece, double time) const {
    const Piece& p = pieces_[piece];
    const double t = time - p.begin, s = t / p.duration, sine = std::sin(pi * s), cosine = std::cos(pi * s);
    return {p.position + p.velocity * t + p.change * p.duration * 0.5 * (s - sine / pi),
            p.velocity + p.change * 0.5 * (1 - cosine), p.change * 0.5 * pi * sine / p.duration};
  }

 private:
  struct Piece {
    double begin, end, position, velocity, change, duration;
  };
  std::vector<Piece> pieces_;
  size_t now_ = 0;
};

struct Plant {
  explicit Plant(const Job& job)
      : damping(job.damping),
        cogging(job.cogging),
        wave_number(2 * pi / job.pole_pitch),
        coulomb(job.coulomb),
        per_speed(1 / job.transition_speed),
        per_mass(1 / job.mass) {}
  double acceleration(double x, double v, double force) const {
    return (force - damping * v - cogging * std::sin(wave_number * x) - coulomb * std::tanh(v * per_speed)) *
           per_mass;
  }
  double damping, cogging, wave_number, coulomb, per_speed, per_mass;
};

/// (b₀ + b₁ z⁻¹ + b₂ z⁻²)/(1 + a₁ z⁻¹ + a₂ z⁻²), transposed direct form II.
struct Section {
  double b0, b1, b2, a1, a2, s1 = 0, s2 = 0;
  double next(double u) {
    const double y = b0 * u + s1;
    s1 = b1 * u - a1 * y + s2;
    s2 = b2 * u - a2 * y;
    return y;
  }
};

/// Quantizer, proportional and derivative feedback, feedforward and disturbance observer, all by Tustin's
/// rule.
class Controller {
 public:
  explicit Controller(const Job& job) : job_(job), reference_(job), per_count_(1 / job.encoder_resolution) {
    const double turn = job.derivative_pole * job.sample_time;
    keep_ = (2 - turn) / (2 + turn), slope_ = 2 * job.derivative_pole / (2 + turn);
    // ω² (M s² + B s)/(s + ω)² and ω²/(s + ω)² with s = c (z - 1)/(z + 1)
    const double c = 2 / job.sample_time, w = job.observer_cutoff, M = job.nominal_mass,
                 B = job.nominal_damping;
    const double scale = w * w / ((c + w) * (c + w)), pole = (c - w) / (c + w);
    measured_ = {scale * (M * c * c + B * c), scale * -2 * M * c * c, scale * (M * c * c - B * c), -2 * pole,
                 pole * pole};
    commanded_ = {scale, 2 * scale, scale, -2 * pole, pole * pole};
  }
  /// The force at a sample.
  double command(double time, double position) {
    wanted = reference_.at(time);
    const double measured = job_.encoder_resolution > 0
                                ? job_.encoder_resolution * std::nearbyint(position * per_count_)
                                : position;
    const double error = wanted.position - measured;
    rate_ = keep_ * rate_ + slope_ * (error - last_error_);
    last_error_ = error;
    disturbance = measured_.next(measured) - commanded_.next(last_command_);
    const double feedforward =
        job_.nominal_mass * wanted.acceleration + job_.nominal_damping * wanted.velocity;
    return last_command_ = job_.Kp * error + job_.Kd * rate_ + feedforward - disturbance;
  }
  Wanted wanted{};
  double disturbance = 0;

 private:
  const Job& job_;
  Reference reference_;
  double per_count_, keep_, slope_;
  Section measured_, commanded_;
  double rate_ = 0, last_error_ = 0, last_command_ = 0;
};

int samples(const Job& job) { return int(std::lround(job.stop / job.sample_time)); }

}  // namespace

Outcome Rows::outcome() const {
  Outcome outcome{position.back(), 0};
  for (double e : error) outcome.peak_error = std::max(outcome.peak_error, std::fabs(e));
  return outcome;
}

std::vector<Wanted> tabulated_reference(const Job& job) {
  Reference reference(job);
  std::vector<Wanted> table;
  for (int k = 0; k <= samples(job); ++k) table.push_back(reference.at(k * job.sample_time));
  return table;
}

Outcome run_rk4(const Job& job, int steps_per_sample) {
  Controller controller(job);
  const Plant plant(job);
  const double h = job.sample_time / steps_per_sample, half = 0.5 * h, sixth = h / 6;
  double x = 0, v = 0, peak_error = 0;
  for (int k = 0; k < samples(job); ++k) {
    const double u = controller.command(k * job.sample_time, x);
    peak_error = std::max(peak_error, std::fabs(controller.wanted.position - x));
    for (int i = 0; i < steps_per_sample; ++i) {
      const double a1 = plant.acceleration(x, v, u);
      const double v2 = v + half * a1, a2 = plant.acceleration(x + half * v, v2, u);
      const double v3 = v + half * a2, a3 = plant.acceleration(x + half * v2, v3, u);
      const double v4 = v + h * a3, a4 = plant.acceleration(x + h * v3, v4, u);
      x += sixth * (v + 2 * (v2 + v3) + v4);
      v += sixth * (a1 + 2 * (a2 + a3) + a4);
    }
  }
  controller.command(job.stop, x);
  return {x, std::max(peak_error, std::fabs(controller.wanted.position - x))};
}

namespace {

/// Dormand & Prince, J. Comp. Appl. Math. 6 (1980), on position and velocity under a held force.
class DormandPrince {
 public:
  DormandPrince(const Plant& plant, double relative_tolerance, double absolute_tolerance)
      : plant_(plant), relative_tolerance_(relative_tolerance), absolute_tolerance_(absolute_tolerance) {}

  void advance(double& x, double& v, double force, double duration) {
    double left = duration;
    double xr[7], vr[7];  // rates of the stages
    xr[0] = v, vr[0] = plant_.acceleration(x, v, force);
    while (left > 0) {
      const bool last = step_ >= left;
      const double h = last ? left : step_;
      double new_x = 0, new_v = 0;
#pragma GCC unroll 7
      for (int s = 1; s < 7; ++s) {
        double dx = 0, dv = 0;
#pragma GCC unroll 7
        for (int j = 0; j < s; ++j) dx += a[s][j] * xr[j], dv += a[s][j] * vr[j];
        new_x = x + h * dx, new_v = v + h * dv;
        xr[s] = new_v, vr[s] = plant_.acceleration(new_x, new_v, force);
      }
      double ex = 0, ev = 0;
#pragma GCC unroll 7
      for (int j = 0; j < 7; ++j) ex += e[j] * xr[j], ev += e[j] * vr[j];
      ex *= h / unit(x, new_x), ev *= h / unit(v, new_v);
      const double error = std::sqrt(0.5 * (ex * ex + ev * ev));
      const double factor = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 10.0);
      if (error > 1) {
        step_ = h * std::min(factor, 1.0);
        continue;
      }
      step_ = last ? std::max(step_, h * factor) : h * factor;
      x = new_x, v = new_v, left = last ? 0 : left - h;
      xr[0] = xr[6], vr[0] = vr[6];
    }
  }

 private:
  double unit(double from, double to) const {
    return absolute_tolerance_ + relative_tolerance_ * std::max(std::fabs(from), std::fabs(to));
  }
  static constexpr double a[7][6] = {
      {},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                  -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

  const Plant& plant_;
  const double relative_tolerance_, absolute_tolerance_;
  double step_ = 1e-5;  // [s]
};

}  // namespace

void run_dormand_prince(const Job& job, double relative_tolerance, double absolute_tolerance, Rows& rows) {
  Controller controller(job);
  const Plant plant(job);
  DormandPrince solver(plant, relative_tolerance, absolute_tolerance);
  double x = 0, v = 0;
  for (int k = 0;; ++k) {
    const double time = k * job.sample_time, u = controller.command(time, x);
    rows.add(time, controller.wanted.position, x, u, controller.disturbance);
    if (k == samples(job)) return;
    solver.advance(x, v, u, job.sample_time);
  }
}

namespace {

/// Controller and plant in continuous time.
class Loop {
 public:
  enum State {
    slow_error,
    slow_position,
    slow_velocity,
    slow_command,
    slower_command,
    position,
    velocity,
    states
  };
  explicit Loop(const Job& job) : reference(job), job_(job), plant_(job) {}

  struct Signals {
    double reference, command, disturbance;
  };
  Signals rates(double time, const double* x, double* rate) const {
    const Wanted wanted = reference.within(piece, time);
    const double w = job_.observer_cutoff, error = wanted.position - x[position];
    const double v = w * (x[position] - x[slow_position]), a = w * (v - x[slow_velocity]);
    const double disturbance =
        job_.nominal_mass * a + job_.nominal_damping * x[slow_velocity] - x[slower_command];
    const double error_rate = job_.derivative_pole * (error - x[slow_error]);
    const double u = job_.Kp * error + job_.Kd * error_rate + job_.nominal_mass * wanted.acceleration +
                     job_.nominal_damping * wanted.velocity - disturbance;
    if (rate) {
      rate[slow_error] = error_rate;
      rate[slow_position] = v, rate[slow_velocity] = a;
      rate[slow_command] = w * (u - x[slow_command]),
      rate[slower_command] = w * (x[slow_command] - x[slower_command]);
      rate[position] = x[velocity], rate[velocity] = plant_.acceleration(x[position], x[velocity], u);
    }
    return {wanted.position, u, disturbance};
  }
  static int derivatives(double time, N_Vector x, N_Vector rate, void* self) {
    static_cast<const Loop*>(self)->rates(time, N_VGetArrayPointer(x), N_VGetArrayPointer(rate));
    return 0;
  }
  Reference reference;
  size_t piece = 0;  // of the reference, held between segment borders

 private:
  const Job& job_;
  Plant plant_;
};

void require(bool good) {
  if (!good) throw std::runtime_error("CVODE refused the hand-written job");
}

}  // namespace

void run_cvode(const Job& job, double relative_tolerance, double absolute_tolerance, Rows& rows) {
  Loop loop(job);
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context) == 0);
  N_Vector x = N_VNew_Serial(Loop::states, context);
  N_VConst(0, x);
  const auto add_row = [&](double time) {
    const double* at = N_VGetArrayPointer(x);
    const Loop::Signals now = loop.rates(time, at, nullptr);
    rows.add(time, now.reference, at[Loop::position], now.command, now.disturbance);
  };
  void* cvode = CVodeCreate(CV_BDF, context);
  require(CVodeInit(cvode, Loop::derivatives, 0, x) == CV_SUCCESS);
  require(CVodeSetUserData(cvode, &loop) == CV_SUCCESS);
  require(CVodeSStolerances(cvode, relative_tolerance, absolute_tolerance) == CV_SUCCESS);
  require(CVodeSetMaxNumSteps(cvode, 100000) == CV_SUCCESS);
  SUNMatrix jacobian = SUNDenseMatrix(Loop::states, Loop::states, context);
  SUNLinearSolver linear_solver = SUNLinSol_Dense(x, jacobian, context);
  require(CVodeSetLinearSolver(cvode, linear_solver, jacobian) == CV_SUCCESS);

  add_row(0);
  double t = 0;
  int row = 1;
  for (; loop.piece < loop.reference.pieces(); ++loop.piece) {
    const bool last = loop.piece + 1 == loop.reference.pieces();
    const double border = last ? job.stop : loop.reference.end_of(loop.piece);
    if (loop.piece > 0) require(CVodeReInit(cvode, t, x) == CV_SUCCESS);
    require(CVodeSetStopTime(cvode, border) == CV_SUCCESS);
    for (;;) {
      const double wanted = row * job.sample_time;
      if (wanted > border + 1e-9) break;
      const int flag = CVode(cvode, std::min(wanted, border), x, &t, CV_NORMAL);
      require(flag == CV_SUCCESS || flag == CV_TSTOP_RETURN);
      add_row(wanted);
      ++row;
    }
    if (t < border) require(CVode(cvode, border, x, &t, CV_NORMAL) >= 0);
  }
  CVodeFree(&cvode);
  SUNLinSolFree(linear_solver), SUNMatDestroy(jacobian), N_VDestroy(x);
  SUNContext_Free(&context);
}

}  // namespace loopwright::by_hand

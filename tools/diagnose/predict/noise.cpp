#include "tools/diagnose/predict/noise.h"
#include "tools/diagnose/predict/sizes.h"
#include <cmath>
#include <limits>

namespace loopwright::diagnosis {
namespace {

/// P = A P Aᵀ - A P Cᵀ (C P Cᵀ + R)⁻¹ C P Aᵀ + Q by the structure-preserving doubling algorithm (Chu, Fan,
/// Lin 2005): converges quadratically, also with poles on the unit circle that are excited by noise.
Eigen::MatrixXd riccati(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, const Eigen::MatrixXd& Q,
                        const Eigen::MatrixXd& R) {
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd F = A.transpose(), G = C.transpose() * R.inverse() * C, H = Q;
  for (int i = 0; i < 60; ++i) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> W(identity + G * H);
    const Eigen::MatrixXd WF = W.solve(F), WG = W.solve(G);
    const Eigen::MatrixXd added = F.transpose() * H * WF;
    G += F * WG * F.transpose();
    F = F * WF;
    H += added;
    H = ((H + H.transpose()) / 2).eval(), G = ((G + G.transpose()) / 2).eval();
    if (added.cwiseAbs().maxCoeff() <= 1e-14 * H.cwiseAbs().maxCoeff()) break;
  }
  return H;
}

/// The axis with the slow force as its last state.
Eigen::MatrixXd with_slow_force(const Eigen::MatrixXd& A_of_axis, const Eigen::VectorXd& push,
                                double memory) {
  const Eigen::Index n = A_of_axis.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 1, n + 1);
  A.topLeftCorner(n, n) = A_of_axis;
  A.topRightCorner(n, 1).topRows(push.size()) = push;
  A(n, n) = memory;
  return A;
}

/// Covariance of the steady predictor, and what makes it, in units in which all numbers are of order one.
struct Steady {
  Eigen::VectorXd unit, output;
  Eigen::MatrixXd C, Q, P;

  Steady(const LinearAxis& axis, const Noise& noise, double nominal_inertia)
      : unit(axis.A.rows() + 1), output(axis.C.rows()) {
    const Eigen::Index n = axis.A.rows(), ports = axis.C.rows(), own = n - axis.load_states;
    for (Eigen::Index i = 0; i < n; ++i)
      unit[i] =
          std::max(std::max(std::abs(axis.push[i]), std::abs(axis.noise_push[i])) * noise.white, 1e-300);
    for (Eigen::Index i = own; i < n; ++i)  // nothing but the motion of the axis moves a load
      unit[i] = std::max(axis.A.row(i).head(own).cwiseAbs().dot(unit.head(own)), 1e-300);
    for (Eigen::Index p = 0; p < ports; ++p) output[p] = noise.measurement[size_t(p)];
    if (axis.wander.size() > 0) unit.head(n) = unit.head(n).cwiseMax(axis.wander);
    unit[n] = noise.white;
    C = Eigen::MatrixXd::Zero(ports, n + 1);
    C.leftCols(n) = axis.C;
    const double scale = axis.inertia / nominal_inertia;
    Eigen::VectorXd white = Eigen::VectorXd::Zero(n + 1), slow = white;
    white.head(n) = axis.noise_push * noise.white * scale;
    slow[n] = noise.step * scale;
    const Eigen::MatrixXd A = with_slow_force(axis.A, axis.push, noise.memory);
    const Eigen::MatrixXd scaled_A = unit.cwiseInverse().asDiagonal() * A * unit.asDiagonal();
    C = output.cwiseInverse().asDiagonal() * C * unit.asDiagonal();
    const Eigen::VectorXd w = white.cwiseQuotient(unit), s = slow.cwiseQuotient(unit);
    Q = w * w.transpose() + s * s.transpose();
    if (axis.wander.size() > 0) Q.diagonal().head(n) += axis.wander.cwiseQuotient(unit.head(n)).cwiseAbs2();
    P = riccati(scaled_A, C, Q, Eigen::MatrixXd::Identity(ports, ports));
  }
};

/// GainSteps for sizes known at compile time; 0: any.
template <int States, int Ports> class SizedGainSteps : public GainSteps {
  static constexpr int states = States ? States + 1 : Eigen::Dynamic, ports = Ports ? Ports : Eigen::Dynamic;
  using Square = Eigen::Matrix<double, states, states>;
  using Correct = Eigen::Matrix<double, states, ports>;
  using Seen = Eigen::Matrix<double, ports, ports>;

 public:
  SizedGainSteps(const LinearAxis& axis, const std::vector<SwitchedSample::Follows>& load, const Noise& noise,
                 double nominal_inertia) {
    const Steady steady(axis, noise, nominal_inertia);
    const Eigen::Index own = axis.A.rows(), n = own + Eigen::Index(load.size()), p = axis.C.rows();
    Eigen::MatrixXd begins =
        Eigen::MatrixXd::Zero(n + 1, own + 1);  // at first the load moves as the axis does
    begins.topLeftCorner(own, own).setIdentity(), begins(n, own) = 1;
    const Eigen::MatrixXd stays = begins;
    for (Eigen::Index i = own; i < n; ++i) {
      begins(i, axis.position) = load[size_t(i - own)].position;
      begins(i, axis.velocity) = load[size_t(i - own)].velocity;
    }
    const auto in_units = [&](const Eigen::MatrixXd& scaled, const Eigen::MatrixXd& to) -> Eigen::MatrixXd {
      return to * steady.unit.asDiagonal() * scaled * steady.unit.asDiagonal() * to.transpose();
    };
    P_ = in_units(steady.P, begins), Q_ = in_units(steady.Q, stays);
    C_.setZero(p, n + 1);
    C_.leftCols(own) = axis.C;
    R_ = steady.output.cwiseAbs2().asDiagonal();
    PC_.resize(n + 1, p), K_.resize(n + 1, p), S_.resize(p, p), root_.resize(p, p), whiten_.resize(p, p);
    next_.resize(n + 1, n + 1);
    onward_ = with_slow_force(Eigen::MatrixXd::Zero(n, n), axis.push, noise.memory);
  }

  const double* correct(Gains::Rows& rows) override {
    const Eigen::Index n = P_.rows(), p = S_.rows();
    PC_.noalias() = P_ * C_.transpose();
    S_ = R_;
    S_.noalias() += C_ * PC_;
    factor();
    P_.noalias() -= K_ * PC_.transpose();
    rows.K.insert(rows.K.end(), K_.data(), K_.data() + n * p);
    rows.whiten.insert(rows.whiten.end(), whiten_.data(), whiten_.data() + p * p);
    rows.log_determinant.push_back(2 * root_.diagonal().array().log().sum());
    return K_.data();
  }

  void advance(const Eigen::MatrixXd& A) override {
    onward_.topLeftCorner(A.rows(), A.cols()) = A;
    next_.noalias() = onward_ * P_;
    P_ = Q_;
    P_.noalias() += next_ * onward_.transpose();
    P_ = (0.5 * (P_ + P_.transpose())).eval();
  }

 private:
  /// Gains and whitening from the covariance of the errors.
  void factor() {
    if constexpr (Ports == 1) {
      const double root = std::sqrt(S_(0, 0));
      const double whiten = 1 / root;
      K_ = PC_ * whiten * whiten, root_(0, 0) = root, whiten_(0, 0) = whiten;
    } else {
      const Eigen::LLT<Seen> factor(S_);
      K_ = factor.solve(PC_.transpose()).transpose();
      root_ = factor.matrixL();
      whiten_ = factor.matrixL().solve(Seen::Identity(S_.rows(), S_.cols()));
    }
  }

  Square P_, Q_, next_, onward_;
  Eigen::Matrix<double, ports, states> C_;
  Seen R_, S_, root_, whiten_;
  Correct PC_, K_;
};

}  // namespace

double Noise::slow() const {
  return memory < 1 ? step / std::sqrt(1 - memory * memory) : std::numeric_limits<double>::infinity();
}

std::unique_ptr<GainSteps> GainSteps::of(const LinearAxis& axis,
                                         const std::vector<SwitchedSample::Follows>& load, const Noise& noise,
                                         double nominal_inertia) {
  std::unique_ptr<GainSteps> steps;
  with_sizes(axis.A.rows() + Eigen::Index(load.size()), axis.C.rows(), [&]<int States, int Ports>() {
    steps = std::make_unique<SizedGainSteps<States, Ports>>(axis, load, noise, nominal_inertia);
  });
  return steps;
}

Gains gains_of(const LinearAxis& axis, const Noise& noise, double nominal_inertia) {
  const Steady steady(axis, noise, nominal_inertia);
  const Eigen::VectorXd &unit = steady.unit, &output = steady.output;
  const Eigen::Index ports = output.size();
  const Eigen::MatrixXd S =
      steady.C * steady.P * steady.C.transpose() + Eigen::MatrixXd::Identity(ports, ports);
  Gains gains;
  gains.K =
      unit.asDiagonal() * steady.P * steady.C.transpose() * S.inverse() * output.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(output.asDiagonal() * S * output.asDiagonal());
  gains.whiten = factor.matrixL().solve(Eigen::MatrixXd::Identity(ports, ports));
  for (Eigen::Index p = 0; p < ports; ++p) gains.log_determinant -= 2 * std::log(gains.whiten(p, p));
  gains.memory = noise.memory;
  if (!axis.steps) return gains;
  auto rows = std::make_shared<Gains::Rows>();
  const auto step = GainSteps::of(axis.steps->without, axis.steps->load, noise, nominal_inertia);
  for (const uint32_t map : axis.steps->of_row) step->correct(*rows), step->advance(axis.steps->A[map]);
  gains.rows = std::move(rows);
  return gains;
}

}  // namespace loopwright::diagnosis

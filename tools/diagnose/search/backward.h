/// The predictor's error filter run backward: what the errors from a row on say about the state before it.
#pragma once
#include "tools/diagnose/predict/sizes.h"
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

/// The error filter with its slow force, as matrices: those of a typical row where they change.
struct ErrorSystem {
  Eigen::MatrixXd onward, correct, whiten, C;  // x[k+1] = onward (x[k] - correct e[k]) - enter φ, e = C x
  Eigen::VectorXd enter;

  ErrorSystem(const Fitted& fitted, bool is_input) {
    const Eigen::Index n = fitted.axis.A.rows();
    onward = Eigen::MatrixXd::Zero(n + 1, n + 1);
    onward.topLeftCorner(n, n) = fitted.axis.A;
    onward.topRightCorner(n, 1) = fitted.axis.push;
    onward(n, n) = fitted.gains.memory;
    correct = fitted.gains.K, whiten = fitted.gains.whiten;
    C = Eigen::MatrixXd::Zero(fitted.axis.C.rows(), n + 1);
    C.leftCols(n) = fitted.axis.C;
    enter = Eigen::VectorXd::Zero(n + 1);
    enter.head(n) = is_input ? fitted.axis.input_push : fitted.axis.push;
  }
};

/// The same with sizes known at compile time; 0: any.
template <int States, int Ports> struct SizedErrorSystem {
  static constexpr int states = States ? States + 1 : Eigen::Dynamic, ports = Ports ? Ports : Eigen::Dynamic;
  Eigen::Matrix<double, states, states> onward;
  Eigen::Matrix<double, states, ports> correct;
  Eigen::Matrix<double, ports, ports> whiten;
  Eigen::Matrix<double, ports, states> C;

  explicit SizedErrorSystem(const ErrorSystem& system)
      : onward(system.onward), correct(system.correct), whiten(system.whiten), C(system.C) {}
  /// As they are at a row.
  void take_row(const Fitted& fitted, size_t row) {
    if (!fitted.axis.steps) return;
    const Eigen::Index n = onward.rows() - 1;
    onward.topLeftCorner(n, n) = fitted.axis.A_at(row);
    correct = Eigen::Map<const Eigen::Matrix<double, states, ports>>(fitted.gains.K_at(row), n + 1, C.rows());
    whiten = Eigen::Map<const Eigen::Matrix<double, ports, ports>>(fitted.gains.whiten_at(row), C.rows(),
                                                                   C.rows());
  }
};

/// For all rows, the last one first, calls take(row, after, before, sensed, through): derivatives of the
/// explained errors with respect to the state predicted for the next row, and for this row; and with respect
/// to the measurement, by the error of this row, and by what the correction does to later rows. The errors of
/// rows for which counts(row) is false are zero.
template <class Counts, class Take>
void run_backward(const ErrorSystem& system, const Fitted& fitted, Counts&& counts, Take&& take) {
  with_sizes(fitted.axis, [&]<int States, int Ports>() {
    using Sized = SizedErrorSystem<States, Ports>;
    using State = Eigen::Matrix<double, Sized::states, 1>;
    using Port = Eigen::Matrix<double, Sized::ports, 1>;
    const Path& path = fitted.prediction.path;
    const Eigen::Index n = system.enter.size(), p = system.C.rows();
    Sized now(system);
    State after = State::Zero(n), before(n), back(n);
    Port sensed(p), through(p), felt(p);
    for (size_t k = path.samples(); k-- > 0;) {
      now.take_row(fitted, k);
      sensed.setZero();
      if (counts(k))
        sensed.noalias() =
            now.whiten.transpose() * Eigen::Map<const Port>(fitted.white.data() + k * size_t(p), p);
      back.noalias() = now.onward.transpose() * after;
      if (path.forgets(k)) back[n - 1] = 0;
      through.noalias() = now.correct.transpose() * back;
      felt = sensed - through, before = back;
      before.noalias() += now.C.transpose() * felt;
      take(k, after, before, sensed, through);
      after = before;
    }
  });
}

}  // namespace loopwright::diagnosis

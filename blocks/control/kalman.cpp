/// x[k+1] = A x[k] + B u[k] + w[k],  y[k] = C x[k] + v[k],  with white noise of the covariances Q of w and R
/// of v
///
/// At each sample the prediction x̄ is corrected by the measurement, x̂ = x̄ + M (y - C x̄), which is the output.
/// The next prediction is A x̂ + B u. M = P Cᵀ (C P Cᵀ + R)⁻¹, where P is the covariance of the error of x̄.
///
/// "steady": P solves the Riccati equation, P = A (P - M C P) Aᵀ + Q, and M is constant. "time_varying": P
/// begins with initial_covariance and follows the recursion in the form of Joseph, which keeps it symmetric
/// and positive. The outputs depend directly on the measurements, not on u: a feedback of the estimate may
/// drive u.
///
/// B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979), sections 3.1 and 4.4. `loopwright design kalman`
/// writes this block for the plant of a diagram.
#include <set>
#include "blocks/continuous/state_space_check.h"
#include "engine/json/reader.h"
#include "models/signal/kalman_filter.h"

namespace loopwright::blocks {

enum class FilterKind { steady, time_varying };
constexpr auto names_of(FilterKind) { return std::array<std::string_view, 2>{"steady", "time_varying"}; }

struct FilterSignal {
  std::string name, unit;
  static constexpr auto describe() {
    return fields(
        parameter(&FilterSignal::name, "name", "", "Name of the port"),
        parameter(&FilterSignal::unit, "unit", "", "Its unit; a plain number when empty").optional());
  }
};

template <class Real> struct Kalman {
  std::vector<FilterSignal> states, measurements;
  MatrixRows<Real> A, B, C, Q, R, initial_covariance;
  std::vector<Real> initial;
  FilterKind gain = FilterKind::steady;
  MatrixRows<Real> steady_P;
  struct In {
    Many<Real> inputs;
    NamedInputs<Real> measured;
  };
  struct Out {
    NamedOutputs<Real> estimates;
  };
  struct Memory {
    Vector<Real> x, M, P, corrected, S, W, V;  // x: the prediction; S, W, V: room to compute in
  };
  static constexpr auto describe() {
    using B_ = Kalman;
    return block(
        "Estimates the states of a sampled linear system from noisy measurements.",
        parameter(&B_::states, "states", "", "The states, each an output"),
        parameter(&B_::measurements, "measurements", "", "What is measured, each an input"),
        parameter(&B_::A, "A", "", "How the states act on the next, states by states, in SI"),
        parameter(&B_::B, "B", "", "How the inputs act on the next states, states by inputs, in SI")
            .optional(),
        parameter(&B_::C, "C", "", "What of the states is measured, measurements by states, in SI"),
        parameter(&B_::Q, "Q", "", "Covariance of the noise at the states in a sample, in SI"),
        parameter(&B_::R, "R", "", "Covariance of the noise of the measurements, in SI"),
        parameter(&B_::gain, "gain", "", "One gain for all samples, or the best for each").optional(),
        parameter(&B_::initial_covariance, "initial_covariance", "",
                  "Covariance of the states at the first sample, in SI; only time_varying")
            .optional(),
        parameter(&B_::initial, "initial", "",
                  "Expected states at the first sample, in SI; zeros when left out")
            .optional(),
        input(&In::inputs, "inputs", any_unit, "Known inputs u, in the order of the columns of B")
            .length(&B_::input_count),
        input(&In::measured, "measured", any_unit, "A signal for each name in `measurements`"),
        output(&Out::estimates, "estimates", "", "A signal for each name in `states`").from(&In::measured),
        buffer(&Memory::x, &B_::n), buffer(&Memory::M, &B_::n_by_p), buffer(&Memory::P, &B_::own_n_by_n),
        buffer(&Memory::corrected, &B_::n), buffer(&Memory::S, &B_::p_by_p),
        buffer(&Memory::W, &B_::own_n_by_n), buffer(&Memory::V, &B_::own_room));
  }
  int n() const { return int(A.size()); }
  int p() const { return int(C.size()); }
  int input_count() const { return columns_of(B); }
  int n_by_p() const { return n() * p(); }
  int p_by_p() const { return p() * p(); }
  int own_n_by_n() const { return varies() ? n() * n() : 0; }
  int own_room() const { return varies() ? n() * std::max(n(), p()) : 0; }
  bool varies() const { return gain == FilterKind::time_varying; }
  std::vector<InstancePort> input_ports() const { return ports_of(measurements, "Measurement"); }
  std::vector<InstancePort> output_ports() const { return ports_of(states, "Estimate"); }

  void check(const Checker& checker) const {
    const size_t rows = states.size(), measured = measurements.size();
    check_names(checker);
    if (rows == 0) checker.error("states", "a filter needs a state");
    if (measured == 0) checker.error("measurements", "a filter needs a measurement");
    if (rows == 0 || measured == 0) return;
    check_matrix(checker, "A", A, rows, rows, "as many as states");
    if (!B.empty()) check_matrix(checker, "B", B, rows, size_t(columns_of(B)), "states by inputs");
    check_matrix(checker, "C", C, measured, rows, "measurements by states");
    check_covariance(checker, "Q", Q, rows);
    check_covariance(checker, "R", R, measured);
    if (varies() || !initial_covariance.empty())
      check_covariance(checker, "initial_covariance", initial_covariance, rows);
    if (!varies() && !initial_covariance.empty())
      checker.error("initial_covariance", "a steady filter does not use it").hint =
          R"("gain": "time_varying")";
    if (!initial.empty() && initial.size() != rows)
      checker.error("initial", "the initial states do not fit the states").expected =
          std::to_string(rows) + " numbers";
  }

  Fault prepare(double) {
    steady_P.assign(A.size(), std::vector<Real>(A.size(), Real(0.0)));
    if (varies()) return {};
    MaskOf<Real> failed = false;
    for (int l = 0; l < lanes_of<Real>; ++l) {
      const RiccatiRows found = steady_covariance(of_lane(A, l), of_lane(C, l), of_lane(Q, l), of_lane(R, l));
      for (size_t i = 0; i < A.size(); ++i)
        for (size_t j = 0; j < A.size(); ++j) set_lane(steady_P[i][j], l, found.X[i][j]);
      set_lane(failed, l, !found.has_converged);
    }
    return fault_if(
        failed,
        "there is no steady filter: an unstable mode is not measured, or one that does not decay has "
        "no noise");
  }
  Fault start(Memory& memory) const {
    for (size_t i = 0; i < memory.x.size(); ++i) memory.x[i] = initial.empty() ? Real(0.0) : initial[i];
    std::vector<Real> P(A.size() * A.size());
    for (size_t i = 0; i < A.size(); ++i)
      for (size_t j = 0; j < A.size(); ++j)
        P[i * A.size() + j] = varies() ? initial_covariance[i][j] : steady_P[i][j];
    if (varies()) std::copy(P.begin(), P.end(), memory.P.begin());
    return find_gain({P, n()}, memory);
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    for (int i = 0; i < n(); ++i) out.estimates[i] = corrected(in, memory, i);
  }
  Fault update(const In& in, Memory& memory) const {
    for (int i = 0; i < n(); ++i) memory.corrected[size_t(i)] = corrected(in, memory, i);
    for (size_t i = 0; i < A.size(); ++i) {
      Real next = inner_product<Real>(A[i], memory.corrected);
      for (int k = 0; k < in.inputs.size(); ++k) next = next + B[i][size_t(k)] * in.inputs[k];
      memory.x[i] = next;
    }
    if (!varies()) return {};
    const RowMajor<Real> P{memory.P, n()};
    next_covariance<Real>(A, C, Q, R, {memory.M, p()}, P, {memory.W, n()}, {memory.V, n()});
    return find_gain(P, memory);
  }

 private:
  static std::vector<InstancePort> ports_of(const std::vector<FilterSignal>& signals, const char* sentence) {
    std::vector<InstancePort> ports;
    for (const FilterSignal& signal : signals) ports.push_back({signal.name, signal.unit, sentence});
    return ports;
  }
  static MatrixRows<double> of_lane(const MatrixRows<Real>& m, int l) {
    MatrixRows<double> numbers = zero_rows(m.size(), size_t(columns_of(m)));
    for (size_t i = 0; i < m.size(); ++i)
      for (size_t j = 0; j < m[i].size(); ++j) numbers[i][j] = lane(m[i][j], l);
    return numbers;
  }
  /// The estimate of state i: the prediction, corrected by the innovations.
  Real corrected(const In& in, const Memory& memory, int i) const {
    Real sum = memory.x[size_t(i)];
    for (int j = 0; j < p(); ++j)
      sum = sum +
            memory.M[size_t(i * p() + j)] * (in.measured[j] - inner_product<Real>(C[size_t(j)], memory.x));
    return sum;
  }
  Fault find_gain(const RowMajor<Real>& P, Memory& memory) const {
    const auto is_positive = kalman_gain<Real>(P, C, R, {memory.S, p()}, {memory.M, p()});
    return fault_if(!is_positive, "the covariance of the measurements is not positive definite");
  }
  void check_names(const Checker& checker) const {
    std::set<std::string> taken{"inputs"};
    for (const auto* list : {&states, &measurements}) {
      const char* key = list == &states ? "states" : "measurements";
      if (list == &measurements) taken = {"inputs"};
      for (const FilterSignal& signal : *list) {
        if (!is_name(signal.name))
          checker.error(key, "this cannot be the name of a port").found = "\"" + signal.name + "\"";
        else if (!taken.insert(signal.name).second)
          checker.error(key, "the name is already in use").found = "\"" + signal.name + "\"";
        if (!signal.unit.empty() && !parse_unit(signal.unit))
          checker.error(key, "there is no such unit").found = "\"" + signal.unit + "\"";
      }
    }
  }
  static void check_covariance(const Checker& checker, const char* name, const MatrixRows<double>& m,
                               size_t size) {
    check_matrix(checker, name, m, size, size, "a covariance");
    if (!has_shape(m, size, size)) return;
    for (size_t i = 0; i < size; ++i) {
      if (m[i][i] < 0) checker.error(name, "a variance is negative").found = "row " + std::to_string(i + 1);
      for (size_t j = 0; j < i; ++j)
        if (m[i][j] != m[j][i])
          checker.error(name, "a covariance is symmetric").found =
              "different numbers in row " + std::to_string(j + 1) + " and row " + std::to_string(i + 1);
    }
  }
};
LOOPWRIGHT_BLOCK(Kalman)

}  // namespace loopwright::blocks

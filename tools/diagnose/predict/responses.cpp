#include "tools/diagnose/predict/responses.h"
#include "tools/diagnose/predict/in_parallel.h"
#include "tools/diagnose/predict/sizes.h"
#include <algorithm>
#include <array>
#include <numeric>

namespace loopwright::diagnosis {
namespace {

/// Columns filtered in parallel, so that no column waits for its own previous sample. Vector types of the
/// compiler become wider instructions in a function compiled for them. The bits stay the same, because
/// nothing is contracted. Aligned as those instructions want it, wherever it is allocated.
constexpr int side_by_side = 8;
struct alignas(side_by_side * sizeof(double) / 2) Side {
  using Half = double __attribute__((vector_size(side_by_side * sizeof(double) / 2)));
  Half low{}, high{};
};
[[gnu::always_inline]] inline Side operator*(double a, const Side& b) { return {a * b.low, a * b.high}; }
[[gnu::always_inline]] inline Side operator+(const Side& a, const Side& b) {
  return {a.low + b.low, a.high + b.high};
}
[[gnu::always_inline]] inline Side operator-(const Side& a, const Side& b) {
  return {a.low - b.low, a.high - b.high};
}

/// The error filter with states (x, d): the response of the prediction errors to small forces and sensor
/// errors. Sizes known at compile time make it three times as fast; `States` and `Ports` are 0 for any size.
template <int States, int Ports, bool Changes> class ErrorFilter {
 public:
  ErrorFilter(const LinearAxis& axis, const Gains& gains, bool is_input)
      : axis_(axis),
        gains_(gains),
        n_(int(axis.A.rows())),
        ports_(int(axis.C.rows())),
        first_of_load_(axis.steps ? int(axis.steps->without.A.rows()) : n_),
        memory_(gains.memory) {
    make_room();
    take_row(0);
    for (int i = 0; i < n(); ++i) {
      push_[i] = axis.push[i];
      enters_[i] = is_input ? axis.input_push[i] : push_[i];
      bends_[i] = axis.slope_share[i] * enters_[i];
      x_[i] = Side{};
    }
    for (int p = 0; p < ports(); ++p)
      for (int j = 0; j < n(); ++j) C_[p][j] = axis.C(p, j);
    d_ = Side{};
  }

  /// The next row, where rows differ.
  [[gnu::always_inline]] void at(size_t row) {
    if constexpr (Changes) take_row(row);
  }

  /// Deviations from the prediction, in the measured ports.
  [[gnu::always_inline]] void seen(Side* e) const {
    for (int p = 0; p < ports(); ++p) {
      e[p] = Side{};
      for (int j = 0; j < n(); ++j) e[p] = e[p] + C_[p][j] * x_[j];
    }
  }
  /// The predictor corrects itself by the measurement; the true state advances with the consumed forces.
  [[gnu::always_inline]] void step(const Side* e, const Side& force, const Side& slope, const Side* load,
                                   bool forgets) {
    for (int p = 0; p < ports(); ++p) {
      for (int i = 0; i < n(); ++i) x_[i] = x_[i] - K_[i][p] * e[p];
      d_ = d_ - K_[n()][p] * e[p];
    }
    if (forgets) d_ = Side{};
    for (int i = 0; i < n(); ++i) {
      next_[i] = push_[i] * d_ - enters_[i] * force - bends_[i] * slope;
      for (int j = 0; j < n(); ++j) next_[i] = next_[i] + A_[i][j] * x_[j];
    }
    if constexpr (Changes)
      for (int i = first_of_load_; i < n(); ++i) next_[i] = next_[i] + load[i - first_of_load_];
    // By halves, as they were stored: a wider load of both would wait for the stores.
    for (int i = 0; i < n(); ++i) x_[i].low = next_[i].low, x_[i].high = next_[i].high;
    d_ = memory_ * d_;
  }
  [[gnu::always_inline]] Side white(const Side* e, int port) const {
    Side sum{};
    for (int q = 0; q <= port; ++q) sum = sum + whiten_[port][q] * e[q];
    return sum;
  }
  [[gnu::always_inline]] int n() const { return States > 0 ? States : n_; }
  [[gnu::always_inline]] int ports() const { return Ports > 0 ? Ports : ports_; }

 private:
  [[gnu::always_inline]] void take_row(size_t row) {
    const double *A = axis_.A_at(row).data(), *K = gains_.K_at(row), *whiten = gains_.whiten_at(row);
    for (int i = 0; i < n(); ++i)
      for (int j = 0; j < n(); ++j) A_[i][j] = A[i + j * n()];
    for (int p = 0; p < ports(); ++p) {
      for (int i = 0; i <= n(); ++i) K_[i][p] = K[i + p * (n() + 1)];
      for (int q = 0; q < ports(); ++q) whiten_[p][q] = whiten[p + q * ports()];
    }
  }

  /// Of one state more, which is the slow force; of any size where it is known only now.
  template <class T> using OfStates = std::conditional_t<(States > 0), T[States + 1], std::vector<T>>;

  void make_room() {
    if constexpr (States == 0) {
      const size_t size = size_t(n_) + 1;
      A_.assign(size, std::vector<double>(size)), K_.assign(size, {}), C_[0].resize(size), C_[1].resize(size);
      for (std::vector<double>* list : {&push_, &enters_, &bends_}) list->resize(size);
      x_.resize(size), next_.resize(size);
    }
  }

  const LinearAxis& axis_;
  const Gains& gains_;
  const int n_, ports_, first_of_load_;
  const double memory_;
  OfStates<OfStates<double>> A_;
  OfStates<double> push_, enters_, bends_;
  OfStates<double> C_[2];
  OfStates<std::array<double, 2>> K_;
  double whiten_[2][2];
  OfStates<Side> x_, next_;
  Side d_;
};

/// Some rows of the columns, row by row: scalar stores followed by a vector load would stall the processor.
constexpr size_t rows_at_a_time = 64;
using Block = std::array<Side, rows_at_a_time>;

[[gnu::always_inline]] inline void gather(const Column::Numbers& from, size_t row, size_t count, size_t place,
                                          Block& to) {
  const float* numbers = from->data() + row;
  double* lane = reinterpret_cast<double*>(to.data()) + place;
  for (size_t r = 0; r < count; ++r) lane[r * side_by_side] = double(numbers[r]);
}

/// Destination of the responses of the columns: the ports of each requested row, one after the other.
struct Rows {
  std::span<const size_t> wanted;  ///< ascending
  std::span<double* const> to;     ///< of each column
};

/// At most `side_by_side` columns.
template <class Filter>
[[gnu::always_inline]] inline void run(Filter filter, const Path& path, Acts acts,
                                       std::span<const Column* const> columns, const Rows& rows) {
  const size_t ports = size_t(filter.ports());
  Block drive{}, slope{}, load[most_load_states]{}, white[2];
  size_t next = 0;
  for (size_t first = 0; next < rows.wanted.size(); first += rows_at_a_time) {
    const size_t count = std::min(rows_at_a_time, path.samples() - first);
    for (size_t c = 0; c < columns.size(); ++c) {
      gather(columns[c]->mean, first, count, c, drive);
      if (columns[c]->slope) gather(columns[c]->slope, first, count, c, slope);
      for (size_t i = 0; i < columns[c]->load.size(); ++i)
        gather(columns[c]->load[i], first, count, c, load[i]);
    }
    for (size_t r = 0; r < count; ++r) {
      Side e[2];
      filter.at(first + r);
      filter.seen(e);
      if (acts == Acts::sensor) e[0] = e[0] + drive[r];
      for (size_t p = 0; p < ports; ++p) white[p][r] = filter.white(e, int(p));
      Side moved[most_load_states];
      for (size_t i = 0; i < size_t(most_load_states); ++i) moved[i] = load[i][r];
      filter.step(e, acts == Acts::sensor ? Side{} : drive[r], slope[r], moved, path.forgets(first + r));
    }
    const size_t begin = next;
    while (next < rows.wanted.size() && rows.wanted[next] < first + count) ++next;
    for (size_t c = 0; c < columns.size(); ++c)
      for (size_t p = 0; p < ports; ++p) {
        const double* lane = reinterpret_cast<const double*>(white[p].data()) + c;
        for (size_t i = begin; i < next; ++i)
          rows.to[c][i * ports + p] = lane[(rows.wanted[i] - first) * side_by_side];
      }
  }
}
template <class Filter>
[[gnu::target("avx2")]] void run_wide(const Filter& filter, const Path& path, Acts acts,
                                      std::span<const Column* const> columns, const Rows& rows) {
  run(filter, path, acts, columns, rows);
}
/// With twice as many registers of the same width, fewer numbers are loaded again.
template <class Filter>
[[gnu::target("avx512f,avx512vl")]] void run_on_many_registers(const Filter& filter, const Path& path,
                                                               Acts acts,
                                                               std::span<const Column* const> columns,
                                                               const Rows& rows) {
  run(filter, path, acts, columns, rows);
}
template <class Filter>
void run_on_this_machine(const Filter& filter, const Path& path, Acts acts,
                         std::span<const Column* const> columns, const Rows& rows) {
  if (__builtin_cpu_supports("avx512vl"))
    run_on_many_registers(filter, path, acts, columns, rows);
  else if (__builtin_cpu_supports("avx2"))
    run_wide(filter, path, acts, columns, rows);
  else
    run(filter, path, acts, columns, rows);
}

}  // namespace

std::vector<const Column*> pointers(const Columns& columns) {
  std::vector<const Column*> list;
  for (const Column& column : columns) list.push_back(&column);
  return list;
}

void responses(const LinearAxis& axis, const Gains& gains, const Path& path, Acts acts,
               std::span<const Column* const> columns, std::span<const size_t> rows,
               std::span<double* const> to) {
  const bool is_input = acts == Acts::input;
  in_parallel((columns.size() + side_by_side - 1) / side_by_side, [&](size_t part) {
    const size_t first = part * side_by_side, count = std::min<size_t>(side_by_side, columns.size() - first);
    const auto some = columns.subspan(first, count);
    const Rows wanted{rows, to.subspan(first, count)};
    with_sizes(axis, [&]<int States, int Ports>() {
      if (axis.steps)
        run_on_this_machine(ErrorFilter<States, Ports, true>(axis, gains, is_input), path, acts, some,
                            wanted);
      else
        run_on_this_machine(ErrorFilter<States, Ports, false>(axis, gains, is_input), path, acts, some,
                            wanted);
    });
  });
}

std::vector<std::vector<double>> responses(const LinearAxis& axis, const Gains& gains, const Path& path,
                                           Acts acts, std::span<const Column* const> columns) {
  std::vector<size_t> rows(path.samples());
  std::iota(rows.begin(), rows.end(), size_t(0));
  std::vector<std::vector<double>> out(columns.size(),
                                       std::vector<double>(rows.size() * size_t(axis.C.rows())));
  std::vector<double*> to;
  for (std::vector<double>& column : out) to.push_back(column.data());
  responses(axis, gains, path, acts, columns, rows, to);
  return out;
}

}  // namespace loopwright::diagnosis

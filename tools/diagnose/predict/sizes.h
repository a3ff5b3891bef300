/// Filters whose sizes are known at compile time: several times as fast as with any sizes.
#pragma once
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis {

/// f.operator()<N>() with N states, or Eigen::Dynamic if there are many.
template <int N = 1, class F> auto with_size(size_t states, F&& f) {
  constexpr int most = 8;
  if constexpr (N > most)
    return f.template operator()<Eigen::Dynamic>();
  else
    return states == N ? f.template operator()<N>() : with_size<N + 1>(states, f);
}

/// Calls f<states, ports>() with the sizes of usual axes: measured by velocity, by position, or by both; with
/// a load of its own, a lag, or two loads. For any other it calls f<0, 0>().
template <class F> void with_sizes(Eigen::Index states, Eigen::Index ports, F&& f) {
  const auto are = [&](Eigen::Index n, Eigen::Index p) { return states == n && ports == p; };
  if (are(1, 1)) return f.template operator()<1, 1>();
  if (are(2, 1)) return f.template operator()<2, 1>();
  if (are(2, 2)) return f.template operator()<2, 2>();
  if (are(3, 1)) return f.template operator()<3, 1>();
  if (are(4, 1)) return f.template operator()<4, 1>();
  if (are(4, 2)) return f.template operator()<4, 2>();
  if (are(5, 1)) return f.template operator()<5, 1>();
  if (are(6, 1)) return f.template operator()<6, 1>();
  f.template operator()<0, 0>();
}
template <class F> void with_sizes(const LinearAxis& axis, F&& f) {
  with_sizes(axis.A.rows(), axis.C.rows(), std::forward<F>(f));
}

}  // namespace loopwright::diagnosis

/// Calls selected by the set of rates that are due. With few rates there is one list for every set; otherwise
/// calls are filtered.
#pragma once
#include <utility>
#include <vector>
#include "engine/block/kernels.h"

namespace loopwright {

template <class Real> struct CallsByRate {
  std::vector<std::pair<uint64_t, Call<Real>>> all;  // mask of rates; ~0: always
  std::vector<std::vector<Call<Real>>> by_due;
  mutable std::vector<Call<Real>> filtered;

  void make(size_t rates) {
    filtered.reserve(all.size());
    if (rates > 6) return;
    by_due.resize(size_t(1) << rates);
    for (size_t due = 0; due < by_due.size(); ++due)
      for (const auto& [mask, call] : all)
        if (mask == ~uint64_t(0) || (mask & due)) by_due[due].push_back(call);
  }
  const std::vector<Call<Real>>& at(uint64_t due) const {
    if (!by_due.empty()) return by_due[due];
    filtered.clear();
    for (const auto& [mask, call] : all)
      if (mask == ~uint64_t(0) || (mask & due)) filtered.push_back(call);
    return filtered;
  }
};

}  // namespace loopwright

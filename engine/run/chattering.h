/// Counts events and detects chattering, for example a switch that immediately reverses its own change.
#pragma once
#include <array>
#include <span>
#include <string>
#include "engine/plan/plan.h"
#include "engine/solve/state_archive.h"

namespace loopwright {

class Chattering {
 public:
  static constexpr int most = 100;  ///< consecutive events in a ten-thousandth of the typical step

  explicit Chattering(const Plan& plan)
      : plan_(plan), events_(plan.crossings.size(), 0), window_(1e-4 * plan.typical_step) {}

  /// Records the crossings that fired at t; false if the last hundred events lie within the window.
  bool count(double t, std::span<const int8_t> fired) {
    for (size_t i = 0; i < fired.size(); ++i)
      if (fired[i]) ++events_[i], worst_ = i;
    const double oldest = times_[size_t(next_)];
    times_[size_t(next_)] = t;
    next_ = (next_ + 1) % most;
    span_ = t - oldest;
    return ++total_ <= most || span_ > window_;
  }
  void archive(StateArchive& a) { a.members(events_, times_, next_, total_, worst_, span_); }
  int64_t events(size_t crossing) const { return events_[crossing]; }
  size_t worst() const { return worst_; }
  double span() const { return span_; }
  std::string name(size_t crossing) const {
    const Plan::Crossing& c = plan_.crossings[crossing];
    return plan_.blocks[size_t(c.block)].path + "." + std::string(c.name);
  }

 private:
  const Plan& plan_;
  std::vector<int64_t> events_;
  std::array<double, most> times_{};
  int next_ = 0;
  int64_t total_ = 0;
  size_t worst_ = 0;
  double window_, span_ = 0;
};

}  // namespace loopwright

/// How often the signals of a plan change, numbered for the legend of a picture.
#pragma once
#include <string>
#include <vector>
#include "engine/plan/plan.h"

namespace loopwright {

class SignalRates {
 public:
  explicit SignalRates(const Plan& plan);
  /// Continuous first, then samples from the fastest to the slowest, then constants; only those in use.
  const std::vector<std::string>& names() const { return names_; }
  /// Index into names().
  int index_of(Number number) const;

 private:
  std::vector<std::string> names_;
  std::vector<int> of_number_;
};

}  // namespace loopwright

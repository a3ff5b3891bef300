/// Prevents a thousand problems of one kind from hiding the first.
#pragma once
#include <string>

#include "engine/json/problem.h"

namespace loopwright {

/// Passes on the first problems and counts the rest; the destructor reports the count.
class ProblemLimit {
 public:
  ProblemLimit(Problems& problems, int most) : problems_(problems), room_(most) {}
  ~ProblemLimit();
  ProblemLimit(const ProblemLimit&) = delete;
  ProblemLimit& operator=(const ProblemLimit&) = delete;

  void error(Place place, std::string message, std::string expected = {}, std::string found = {},
             std::string hint = {});
  void warning(Place place, std::string message, std::string hint = {});
  /// Counts an error that would only repeat one already reported.
  void count(Place place);
  bool has_errors() const { return errors_ > 0; }

 private:
  void add(Problem problem);

  Problems& problems_;
  int room_;
  size_t errors_ = 0, untold_ = 0;
  bool untold_error_ = false;
  Place last_untold_;
};

}  // namespace loopwright

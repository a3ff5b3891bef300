#include "engine/json/problem_limit.h"

#include <fmt/format.h>
#include <utility>

namespace loopwright {

ProblemLimit::~ProblemLimit() {
  if (untold_ == 0) return;
  const std::string message =
      fmt::format("… and {} more problem{} like these", untold_, untold_ == 1 ? "" : "s");
  if (untold_error_)
    problems_.error(last_untold_, {}, {}, message);
  else
    problems_.warning(last_untold_, {}, {}, message);
}

void ProblemLimit::error(Place place, std::string message, std::string expected, std::string found,
                         std::string hint) {
  Problem problem;
  problem.place = std::move(place);
  problem.message = std::move(message);
  problem.expected = std::move(expected);
  problem.found = std::move(found);
  problem.hint = std::move(hint);
  add(std::move(problem));
}

void ProblemLimit::warning(Place place, std::string message, std::string hint) {
  Problem problem;
  problem.severity = Problem::Severity::warning;
  problem.place = std::move(place);
  problem.message = std::move(message);
  problem.hint = std::move(hint);
  add(std::move(problem));
}

void ProblemLimit::count(Place place) {
  ++errors_;
  ++untold_;
  untold_error_ = true;
  last_untold_ = std::move(place);
}

void ProblemLimit::add(Problem problem) {
  const bool is_error = problem.severity == Problem::Severity::error;
  if (room_ > 0) {
    --room_;
    errors_ += is_error;
    problems_.add(std::move(problem));
  } else if (is_error) {
    count(std::move(problem.place));
  } else {
    ++untold_;
    last_untold_ = std::move(problem.place);
  }
}

}  // namespace loopwright

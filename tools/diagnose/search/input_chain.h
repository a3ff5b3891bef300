/// The recorded input after the effects that change it, one behind the other.
#pragma once
#include <optional>
#include "tools/diagnose/search/candidate.h"

namespace loopwright::diagnosis {

/// Adds `sign` times what a member consumes; a slope that is not needed stays empty.
void add_columns(const Member& member, const Columns& columns, std::vector<double>& mean,
                 std::vector<double>& slope, double sign = 1);

/// As mean and slope over each sample.
struct ChangedInput {
  std::vector<double> mean, slope;
};

/// Along one path; both must outlive it.
class InputChain {
 public:
  InputChain(const Path& path, const std::vector<double>& raw_input) : path_(path), raw_input_(raw_input) {}

  /// After those of the members that change the input, in the order of the signal path.
  ChangedInput through(const std::vector<Member>& members);

 private:
  const Path& path_;
  const std::vector<double>& raw_input_;
  std::optional<Path> upstream_;  // the path with the input that the next effect gets
};

}  // namespace loopwright::diagnosis

/// Shared parts of tests of lanes: diagrams with a fixed step, parameters that differ from lane to lane,
/// scalar runs for comparison.
#pragma once
#include <gtest/gtest.h>
#include <string>
#include <vector>
#include "engine/lanes/lane_run.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::testing {

inline constexpr std::array simd_sets{InstructionSet::avx2, InstructionSet::avx512};

/// The plan of a diagram file. A diagram with a variable step gets rk4 with 0.1 ms instead.
std::shared_ptr<const Plan> fixed_step_plan(const std::string& path);
/// The present value of a signal of one lane.
double number(const LaneRun& run, Number number, int lane);
/// False: there is no such tunable number.
bool set_parameter(LaneRun& run, std::string_view path, int lane, double value);

struct TunedParameter {
  std::string path;
  double value, low, high;
  bool low_is_open;
  /// A few per cent off, differently in each lane, inside the range.
  double in_lane(int lane) const;
};
/// Every tunable number of every block.
std::vector<TunedParameter> tunable_parameters(const Plan& plan);

/// Everything that was recorded, row by row: the time, then the logged numbers.
struct Rows {
  std::vector<double> values;
  bool failed = false;
  double failed_at = 0;  ///< s
};
/// Scalar, with the parameters and the noise of a lane.
Rows scalar_rows(const Plan& plan, const std::vector<TunedParameter>& parameters, int lane);
/// The same on lanes, one entry for each lane.
std::vector<Rows> lane_rows(const Plan& plan, const std::vector<TunedParameter>& parameters,
                            InstructionSet set, int arenas);

/// Empty, or the first difference, bit for bit. Two NaN are equal whatever their payload.
std::string difference(const Plan& plan, const Rows& scalar, const Rows& lane);

/// For a test with an instruction set as parameter.
inline std::string set_name(const ::testing::TestParamInfo<InstructionSet>& test) {
  return std::string(to_name(test.param));
}

}  // namespace loopwright::testing

/// Skips the test, visibly, if this machine or build has no such lanes.
#define SKIP_WITHOUT_LANES(set) \
  if (const std::string reason = ::loopwright::lanes_unavailable(set); !reason.empty()) GTEST_SKIP() << reason

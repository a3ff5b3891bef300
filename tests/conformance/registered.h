/// Tests that hold for every registered block: one parameter a type, named after it.
#pragma once
#include <gtest/gtest.h>
#include "tests/conformance/specimen.h"

namespace loopwright {

class EveryBlock : public testing::TestWithParam<std::string> {
 protected:
  /// With the ports of its first specimen, if the settings declare ports.
  const BlockInfo& info() const { return info_of_specimen(GetParam()); }
  const Kernels<double>& kernels() const { return find_block(GetParam())->kernels; }
  const std::vector<Specimen>& specimens() const { return specimens_of(GetParam()); }
};

inline std::vector<std::string> all_types() {
  std::vector<std::string> types;
  for (const auto& [type, block] : all_blocks()) types.push_back(type);
  return types;
}

inline std::string name_of_type(const testing::TestParamInfo<std::string>& type) { return type.param; }

/// Instantiates the tests of `Suite` for every type.
#define LOOPWRIGHT_FOR_EVERY_BLOCK(Suite) \
  INSTANTIATE_TEST_SUITE_P(Registered, Suite, testing::ValuesIn(all_types()), name_of_type)

}  // namespace loopwright

/// Judgements: tests of half a minute or more, too long for every run. `tools/test.sh --judgements` sets the
/// variable.
#pragma once
#include <gtest/gtest.h>
#include <cstdlib>

/// First line of such a test. Without the variable it is skipped, and says how to run it.
#define IS_A_JUDGEMENT() \
  if (!std::getenv("LOOPWRIGHT_JUDGEMENTS")) GTEST_SKIP() << "a judgement; run with LOOPWRIGHT_JUDGEMENTS=1"

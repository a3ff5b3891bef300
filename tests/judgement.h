/// Judgements: single diagnoses that take half a minute or more. A few of them take half of the time of all
/// tests of the diagnosis, and on a slow machine these did not end. What they show for one more plant or
/// record, shorter tests beside them show for another. `tools/test.sh --judgements` runs them too.
#pragma once
#include <gtest/gtest.h>
#include <cstdlib>

/// First line of such a test. Without the variable it is skipped visibly, as without measured data, and says
/// how to run it. The test is compiled in any case.
#define IS_A_JUDGEMENT() \
  if (!std::getenv("LOOPWRIGHT_JUDGEMENTS")) GTEST_SKIP() << "a judgement; run with LOOPWRIGHT_JUDGEMENTS=1"

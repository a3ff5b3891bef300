// A load on a spring that the diagram knows.
#include <gmock/gmock.h>
#include "tests/tools/loaded_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::known_load_test {
namespace {

/// It begins where the record does, and as fast: at the diagram's own start its spring would be strained by
/// the whole way, and a record that begins far away would show nothing but its swinging.
TEST(KnownLoad, BeginsWithTheRecord) {
  for (const double origin : {0.0, 0.7, 50.0}) {
    DiagramFolder folder;
    LoadedAxis{.origin = origin, .velocity = 0.4, .force_noise = 0.02, .encoder = 1e-7, .rows = 12000}
        .write_to(folder);
    const Diagnosis d = diagnose(folder.path("axis.json"), {folder.path("e.json")}, {});
    EXPECT_EQ(name_of(d.verdict), "nothing_missing") << origin << "\n" << to_text(d);
    EXPECT_LT(d.steps.front().force_rmse, 0.03) << origin;
    EXPECT_LT(d.steps.front().simulation_rmse, 1e-4) << origin;
  }
}

}  // namespace
}  // namespace loopwright::known_load_test

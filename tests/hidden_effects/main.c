/// Writes the scenario of a seed into a folder, which is created if necessary; see usage.

#include <stdlib.h>
#include <string.h>

#include "program.h"
#include "write.h"

static int usage(void) {
  fputs(
      "usage: hidden_effects SEED FOLDER                        kind, trajectory and effects as the seed "
      "decides\n"
      "       hidden_effects SEED FOLDER TRAJECTORY [EFFECT…]   these effects, with magnitudes that the seed "
      "decides\n",
      stderr);
  return 2;
}

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4 + MAX_HIDDEN) return usage();
  char* end;
  const unsigned long long seed = strtoull(argv[1], &end, 10);
  if (end == argv[1] || *end != 0) return usage();
  Scenario scenario;
  if (argc == 3) {
    scenario = scenario_draw(seed);
  } else {
    const int trajectory = index_of(argv[3], trajectory_names, TRAJECTORIES), count = argc - 4;
    Effect effects[MAX_HIDDEN];
    for (int i = 0; i < count; ++i) {
      const int effect = index_of(argv[4 + i], effect_names, EFFECTS);
      if (effect < 0) return 2;
      effects[i] = (Effect)effect;
    }
    if (trajectory < 0) return 2;
    if (!scenario_hiding(seed, (Trajectory)trajectory, effects, count, &scenario)) {
      fputs("no stable loop with a visible trace of each effect: try another seed\n", stderr);
      return 1;
    }
  }
  return scenario_write(&scenario, argv[2]) ? 0 : 1;
}

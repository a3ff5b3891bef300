/// Writes the record and the truth of a seed into a folder, which is created if necessary; scenario.py adds
/// the diagram and the experiment.

#include <stdlib.h>
#include <string.h>

#include "conditions.h"
#include "tests/hidden_effects/program.h"

static int usage(void) {
  fputs(
      "usage: conditions SEED FOLDER [--quiet]                          condition and effects as the seed "
      "decides\n"
      "       conditions SEED FOLDER [--quiet] CONDITION [EFFECT…]      these effects, with magnitudes that "
      "the seed decides\n"
      "--quiet: without noise and counts\n",
      stderr);
  return 2;
}

int main(int argc, char** argv) {
  if (argc < 3) return usage();
  char* end;
  const unsigned long long seed = strtoull(argv[1], &end, 10);
  const bool quiet = argc > 3 && strcmp(argv[3], "--quiet") == 0;
  const int words = quiet ? 4 : 3, count = argc - words - 1;
  if (end == argv[1] || *end != 0 || count > MAX_HIDDEN) return usage();
  Hidden hidden;
  if (count < 0) {
    hidden = hidden_draw(seed);
  } else {
    const int condition = index_of(argv[words], condition_names, CONDITIONS);
    Effect effects[MAX_HIDDEN];
    for (int i = 0; i < count; ++i) {
      const int effect = index_of(argv[words + 1 + i], effect_names, CATALOGUE);
      if (effect < 0) return 2;
      effects[i] = (Effect)effect;
    }
    if (condition < 0) return 2;
    if (!hidden_with(seed, (Condition)condition, effects, count, &hidden)) {
      fputs("no sound loop: try another seed\n", stderr);
      return 1;
    }
  }
  return hidden_write(&hidden, argv[2], quiet) ? 0 : 1;
}

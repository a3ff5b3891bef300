#include "random.h"

#include <math.h>

#include "hw/emulator/elementary.h"

static uint64_t next(Random* random) {
  uint64_t z = random->state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

Random random_stream(uint64_t seed, const char* name) {
  Random random = {seed};
  for (; *name; ++name) random.state = next(&random) ^ (uint64_t)(unsigned char)*name;
  next(&random);
  return random;
}

double random_unit(Random* random) { return ((double)(next(random) >> 11) + 0.5) * 0x1p-53; }

double random_uniform(Random* random, double low, double high) {
  return low + (high - low) * random_unit(random);
}

double random_log_uniform(Random* random, double low, double high) {
  return low * power_of(high / low, random_unit(random));
}

double random_normal(Random* random) {
  const double radius = sqrt(-2.0 * logarithm_of(random_unit(random)));
  return radius * cosine_of(6.283185307179586 * random_unit(random));
}

int random_below(Random* random, int count) { return (int)(random_unit(random) * count); }

double random_sign(Random* random) { return random_unit(random) < 0.5 ? -1.0 : 1.0; }

#ifndef HIDDEN_EFFECTS_RANDOM_H
#define HIDDEN_EFFECTS_RANDOM_H

#include <stdint.h>

/// A stream of random numbers: SplitMix64 (Steele, Lea, Flood 2014). Streams with different names are
/// independent, so that an additional draw for the effects does not change the noise.
typedef struct {
  uint64_t state;
} Random;

Random random_stream(uint64_t seed, const char* name);

/// Uniform on (0, 1).
double random_unit(Random* random);
double random_uniform(Random* random, double low, double high);
/// Uniform in the logarithm: as many draws between 5 and 10 as between 10 and 20.
double random_log_uniform(Random* random, double low, double high);
/// Standard normal (Box and Muller).
double random_normal(Random* random);
/// 0 … count − 1.
int random_below(Random* random, int count);
/// −1 or +1.
double random_sign(Random* random);

#endif

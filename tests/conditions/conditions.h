#ifndef CONDITIONS_CONDITIONS_H
#define CONDITIONS_CONDITIONS_H

#include "information.h"

/// Everything that a seed determines.
typedef struct {
  uint64_t seed;
  Setting setting;
  int effect_count;
  Effect effects[MAX_HIDDEN];
  double gains[MAX_HIDDEN];        ///< in −2 ln L, of the record
  Physics stages[MAX_HIDDEN + 1];  ///< nominal, with the first effect, with the first two …
} Hidden;

/// Twenty seeds one after the other have the twenty conditions; of two hundred, sixty are clean.
Condition condition_of(uint64_t seed);
bool is_clean(uint64_t seed);

Hidden hidden_draw(uint64_t seed);
/// These effects under this condition; false if no draw of their magnitudes gave a sound loop.
bool hidden_with(uint64_t seed, Condition condition, const Effect effects[], int count, Hidden* hidden);

/// A draw counts only if the true model gains at least this in −2 ln L.
extern const double least_gain;

/// Writes record.csv and truth.json into the folder, which is created if necessary.
bool hidden_write(const Hidden* hidden, const char* folder, bool quiet);

#endif

#include "conditions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double least_gain = 50;

Condition condition_of(uint64_t seed) { return (Condition)(seed % CONDITIONS); }

bool is_clean(uint64_t seed) {
  const int round = (int)(seed / CONDITIONS % 10);
  return round == 0 || round == 3 || round == 6;
}

/// In steps of a millisecond or more.
static Path path_of_setting(const Setting* s) {
  return path_of(&s->motion, &s->nominal, fmax(0.001, s->sample_time_s));
}

/// Effects with a force of their own along the path, by which a strong and a weak one can be told.
static bool has_share(Effect effect) {
  switch (effect) {
    case INERTIA:
    case BACKLASH:
    case FLEXIBLE_MODE:
    case INPUT_DELAY:
    case ACTUATOR_LAG:
    case PRESLIDING_HYSTERESIS:
    case ENCODER_PERIODIC_ERROR:
      return false;
    default:
      return true;
  }
}

static void draw_names(Hidden* h, int wanted, Random* random) {
  const Setting* s = &h->setting;
  h->effect_count = 0;
  if (s->late_s > 0) h->effects[h->effect_count++] = INPUT_DELAY;
  while (h->effect_count < wanted) {
    const Effect effect = (Effect)random_below(random, CATALOGUE);
    bool good = setting_allows(s, effect) && (s->condition != WEAK_BESIDE_STRONG || has_share(effect));
    for (int i = 0; i < h->effect_count; ++i) good = good && !effects_clash(effect, h->effects[i]);
    if (good) h->effects[h->effect_count++] = effect;
  }
}

/// The first effect has 0.6 … 1 of the force while moving and the second 0.05 … 0.08, in the pairs of strong
/// and weak.
static bool draw_one(Hidden* h, int i, const Path* path, Random* random) {
  const Physics* before = &h->stages[i];
  Physics* after = &h->stages[i + 1];
  const bool is_pair = h->setting.condition == WEAK_BESIDE_STRONG && h->effect_count == 2;
  for (int attempt = 0; attempt < 200; ++attempt) {
    *after = *before;
    if (!effect_draw(h->effects[i], path, random, after)) return false;
    if (!is_pair) return true;
    const double share = effect_share(path, before, after);
    if (i == 0 ? share > 0.6 : share < 0.08) return true;
  }
  return false;
}

static bool draw_magnitudes(Hidden* h, const Path* path, Random* random) {
  for (int i = 0; i < h->effect_count; ++i) {
    h->stages[i + 1] = h->stages[i];
    if (i == 0 && h->setting.late_s > 0)
      h->stages[1].delay_s = h->setting.late_s;
    else if (!draw_one(h, i, path, random))
      return false;
    else
      setting_adapt(&h->setting, h->effects[i], &h->stages[i + 1]);
  }
  return true;
}

/// Whether the loop is sound; finds the gains.
static bool try_record(Hidden* h) {
  Log log = log_make(&h->setting, &h->stages[h->effect_count], &h->setting.motion, h->seed, "record", false);
  const bool sound = log_is_sound(&h->setting, &log);
  if (sound) information(&h->setting, h->stages, h->effects, h->effect_count, &log, h->gains);
  log_free(&log);
  return sound;
}

static double least(const Hidden* h) {
  double gain = HUGE_VAL;
  for (int i = 0; i < h->effect_count; ++i) gain = fmin(gain, h->gains[i]);
  return gain;
}

/// Draws magnitudes until each effect is visible. After some draws, the one whose least visible effect was
/// seen best: an effect below `least_gain` does not count. False if no loop was sound.
static bool draw_visible(Hidden* h, const Path* path, Random* random, int attempts) {
  Hidden best = *h;
  bool found = false;
  for (int i = 0; i < attempts; ++i) {
    if (!draw_magnitudes(h, path, random) || !try_record(h)) continue;
    if (!found || least(h) > least(&best)) best = *h;
    found = true;
    if (least(&best) >= least_gain) break;
  }
  *h = best;
  return found;
}

/// One to three, most often one; a pair where a weak effect stands beside a strong one.
static int draw_count(Condition condition, Random* random) {
  const double u = random_unit(random);
  if (condition == WEAK_BESIDE_STRONG) return 2;
  return u < 0.5 ? 1 : u < 0.85 ? 2 : 3;
}

Hidden hidden_draw(uint64_t seed) {
  Random random = random_stream(seed, "conditions");
  Hidden h = {.seed = seed, .setting = setting_draw(condition_of(seed), &random)};
  h.stages[0] = h.setting.nominal;
  const bool clean = is_clean(seed);
  if (clean) h.setting.late_s = 0;
  Path path = path_of_setting(&h.setting);
  bool found = false;
  while (!found) {
    draw_names(&h, clean ? 0 : draw_count(h.setting.condition, &random), &random);
    found = draw_visible(&h, &path, &random, 8) && (h.effect_count == 0 || least(&h) >= 0);
  }
  free(path.time_s);
  return h;
}

bool hidden_with(uint64_t seed, Condition condition, const Effect effects[], int count, Hidden* h) {
  Random random = random_stream(seed, "conditions");
  *h = (Hidden){.seed = seed, .setting = setting_draw(condition, &random), .effect_count = count};
  h->stages[0] = h->setting.nominal;
  h->setting.late_s = 0;
  memcpy(h->effects, effects, (size_t)count * sizeof *effects);
  Path path = path_of_setting(&h->setting);
  const bool found = draw_visible(h, &path, &random, 20);
  free(path.time_s);
  return found;
}

#include "elementary.h"

#include <math.h> /* only functions exact or correctly rounded in every library: floor, fmod, frexp, ldexp, fabs */

/* Three parts of pi/2 and two of ln 2; products of all but the last part with a small integer are exact. */
static const double quarter_1 = 0x1.921fb544p0, quarter_2 = 0x1.0b4611a6p-34,
                    quarter_3 = 0x1.3198a2e037073p-69;
static const double ln2_high = 0x1.62e42fefap-1, ln2_low = 0x1.cf79abc9e3b3ap-40;
static const double two_pi = 6.28318530717958647692, longest_reduced = 1e6;

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

/* c[0] + c[1] z + … */
static inline double polynomial(const double* c, int count, double z) {
  double sum = c[count - 1];
#pragma GCC unroll 16
  for (int i = count - 2; i >= 0; --i) sum = c[i] + z * sum;
  return sum;
}

/* Taylor series: sine after the term x, cosine after 1 - x^2/2, for |x| <= pi/4. */
static const double of_sine[] = {
    -1 / 6.0,        1 / 120.0,        -1 / 5040.0,          1 / 362880.0,
    -1 / 39916800.0, 1 / 6227020800.0, -1 / 1307674368000.0, 1 / 355687428096000.0};
static const double of_cosine[] = {
    1 / 24.0,        -1 / 720.0,         1 / 40320.0,          -1 / 3628800.0,
    1 / 479001600.0, -1 / 87178291200.0, 1 / 20922789888000.0, -1 / 6402373705728000.0};
static inline double sine_series(double x) { return x + x * x * x * polynomial(of_sine, COUNT(of_sine), x * x); }
static inline double cosine_series(double x) {
  return 1 - (0.5 * x * x - x * x * x * x * polynomial(of_cosine, COUNT(of_cosine), x * x));
}

/* x = n pi/2 + r with |r| <= pi/4: r, and n modulo 4 as quarters. */
static inline double reduced(double x, int* quarters) {
  if (!(fabs(x) <= longest_reduced)) x = fmod(x, two_pi);
  const double nearest = x / (quarter_1 + quarter_2) + 0.5;
  long n = (long)nearest;
  n -= n > nearest; /* its floor */
  *quarters = (int)(n & 3);
  return ((x - n * quarter_1) - n * quarter_2) - n * quarter_3;
}

double sine_of(double x) {
  if (!isfinite(x)) return NAN;
  int quarters;
  const double r = reduced(x, &quarters), y = quarters & 1 ? cosine_series(r) : sine_series(r);
  return quarters & 2 ? -y : y;
}
double cosine_of(double x) {
  if (!isfinite(x)) return NAN;
  int quarters;
  const double r = reduced(x, &quarters), y = quarters & 1 ? sine_series(r) : cosine_series(r);
  return (quarters + 1) & 2 ? -y : y;
}
void sine_and_cosine_of(double x, double* sine, double* cosine) {
  *sine = *cosine = NAN;
  if (!isfinite(x)) return;
  int quarters;
  const double r = reduced(x, &quarters), s = sine_series(r), c = cosine_series(r);
  *sine = quarters & 1 ? c : s, *cosine = quarters & 1 ? s : c;
  if (quarters & 2) *sine = -*sine;
  if ((quarters + 1) & 2) *cosine = -*cosine;
}

/* e^x - 1 for |x| <= ln 2 / 2: Taylor series after the term x. */
static const double of_growth[] = {1 / 2.0,          1 / 6.0,        1 / 24.0,        1 / 120.0,
                                   1 / 720.0,        1 / 5040.0,     1 / 40320.0,     1 / 362880.0,
                                   1 / 3628800.0,    1 / 39916800.0, 1 / 479001600.0, 1 / 6227020800.0,
                                   1 / 87178291200.0};
static double growth_series(double x) { return x + x * x * polynomial(of_growth, COUNT(of_growth), x); }

double exponential_of(double x) {
  if (isnan(x)) return x;
  if (x > 710) return INFINITY;
  if (x < -746) return 0;
  const double n = floor(x / (ln2_high + ln2_low) + 0.5);
  return ldexp(1 + growth_series((x - n * ln2_high) - n * ln2_low), (int)n);
}

/* (e^2|x| - 1)/(e^2|x| + 1) with the sign of x. */
double hyperbolic_tangent_of(double x) {
  const double twice = 2 * fabs(x);
  const double growth = twice < 0.34 ? growth_series(twice)
                        : twice < 44 ? exponential_of(twice) - 1
                                     : INFINITY;
  const double y = growth < INFINITY ? growth / (growth + 2) : 1;
  return isnan(x) ? x : x < 0 ? -y : y;
}

/* n ln 2 + 2 artanh(s), s = (m - 1)/(m + 1), x = m 2^n with m between sqrt(1/2) and sqrt(2). */
static const double of_artanh[] = {1 / 3.0,  1 / 5.0,  1 / 7.0,  1 / 9.0,  1 / 11.0, 1 / 13.0,
                                   1 / 15.0, 1 / 17.0, 1 / 19.0, 1 / 21.0, 1 / 23.0};
double logarithm_of(double x) {
  if (x == 0) return -INFINITY;
  int n;
  double m = frexp(x, &n);
  if (m < 0x1.6a09e667f3bcdp-1) m *= 2, --n;
  const double s = (m - 1) / (m + 1);
  const double tail = s * s * s * polynomial(of_artanh, COUNT(of_artanh), s * s);
  return n * ln2_high + (2 * s + (2 * tail + n * ln2_low));
}

double power_of(double x, double y) { return exponential_of(y * logarithm_of(x)); }

/// Elementary functions of a simulation's scalar, bit-identical for double and for every vector width.
///
/// These polynomials replace libm, whose bits depend on the processor and differ from vector libraries', and
/// which computes one lane at a time. Each function reduces the argument to a small interval (W. J. Cody, W.
/// Waite, Software Manual for the Elementary Functions, 1980) and evaluates a near-minimax polynomial there.
/// Errors are in units in the last place (ulp) of the result, the largest observed over millions of
/// arguments; the tests enforce the bounds. NaN gives NaN everywhere; infinities give the same results as
/// libm.
#pragma once
#include "models/real/far_angle.h"
#include "models/real/real.h"

namespace loopwright {
namespace detail {

template <class Real> struct Powers { Real first, second, fourth, eighth; };
/// Coefficients c[first] … c[first + count - 1] by Estrin's scheme. The two halves are independent, so that a
/// scalar run does not wait for a chain of additions as in Horner's scheme.
template <const auto& c, int first, int count, class Real> LW_INLINE Real estrin(const Powers<Real>& x) {
  if constexpr (count == 1) {
    return c[first];
  } else {
    constexpr int half = count > 8 ? 8 : count > 4 ? 4 : count > 2 ? 2 : 1;
    const Real low = estrin<c, first, half>(x), high = estrin<c, first + half, count - half>(x);
    return low + high * (half == 8 ? x.eighth : half == 4 ? x.fourth : half == 2 ? x.second : x.first);
  }
}
/// c₀ + c₁ x + c₂ x² + … for up to 16 coefficients.
template <const auto& c, class Real> LW_INLINE Real polynomial(const Real& x) {
  const Real second = x * x, fourth = second * second;
  return estrin<c, 0, sizeof(c) / sizeof(c[0])>(Powers<Real>{x, second, fourth, fourth * fourth});
}

/// x rounded half to even, for |x| < 2⁵¹; faster than round_even, but loses the sign of zero.
template <class Real> LW_INLINE Real nearest_integer(const Real& x) {
  return (x + bits::integer_shift) - bits::integer_shift;
}

inline constexpr double infinity = __builtin_huge_val();

}  // namespace detail

// ---- sine, cosine ---------------------------------------------------------------------------------------

namespace detail {

/// (sin(√z)/√z - 1)/z on [0, (π/2)²], fitted with each coefficient rounded before the next is fitted.
inline constexpr double sine_series[] = {
    -0x1.5555555555555p-3,  0x1.11111111110c8p-7,  -0x1.a01a01a014d6fp-13, 0x1.71de3a52a0b17p-19,
    -0x1.ae6454d4747d8p-26, 0x1.6123cd07433e1p-33, -0x1.ae4384694746cp-41, 0x1.8832a5724f56cp-49};

inline constexpr double sine_limit = 1e6;  // rad; the reduction is valid for k below 2²⁰

/// sin(x - kπ) for integer or half-integer k, |x - kπ| ≤ π/2. π is split into three parts; the products of
/// the first two with k are exact.
template <class Real> LW_INLINE Real sine_of_remainder(const Real& x, const Real& k) {
  const Real r = ((x - k * 0x1.921fb544p1) - k * 0x1.0b4611a6p-33) - k * 0x1.3198a2e037073p-68;
  const Real z = r * r;
  const Real y = r + r * z * polynomial<sine_series>(z);
  return lesser(Real(1.0), greater(Real(-1.0), y));  // rounding must not exceed ±1
}
/// sin(x + quarters π/2) for x > 1.
LW_INLINE double sine_of_far(double x, int quarters) {
  if (!(x < infinity)) return __builtin_nan("");
  const FarAngle angle = far_angle(x);
  const int turn = (angle.quarters + quarters) & 3;
  const double y = turn & 1 ? sine_of_remainder(-absolute(angle.rest), -0.5)  // cosine, even
                            : sine_of_remainder(angle.rest, 0.0);
  return turn & 2 ? -y : y;
}
// Static because these functions are not inlined: see LW_INLINE.
template <int quarters, class Real> [[gnu::noinline, gnu::cold]] static Real with_far_lanes(Real x, Real y) {
  for (int l = 0; l < lanes_of<Real>; ++l) {
    const double angle = absolute(lane(x, l));
    if (!(angle <= sine_limit)) set_lane(y, l, sine_of_far(angle, quarters));
  }
  return y;
}

}  // namespace detail

/// sin x, x in rad. Error ≤ 3 ulp; computed lane by lane for |x| > 10⁶. Exactly odd; |sin x| ≤ 1.
template <Scalar Real> LW_INLINE Real sine(const Real& x) {
  const Real magnitude = absolute(x);
  const Real half_turns = detail::nearest_integer(magnitude * 0x1.45f306dc9c883p-2);
  const Real y = negate_if_odd(detail::sine_of_remainder(magnitude, half_turns), half_turns);
  if (any(magnitude > detail::sine_limit)) [[unlikely]]
    return flip_sign(
        register_by_register([](auto a, auto b) { return detail::with_far_lanes<0>(a, b); }, x, y), x);
  return flip_sign(y, x);
}

/// cos x = sin(x + π/2), x in rad. Error ≤ 3 ulp; computed lane by lane for |x| > 10⁶. Even; at most 1.
template <Scalar Real> LW_INLINE Real cosine(const Real& x) {
  const Real magnitude = absolute(x);
  const Real half_turns = detail::nearest_integer(magnitude * 0x1.45f306dc9c883p-2 + 0.5);
  const Real y = negate_if_odd(detail::sine_of_remainder(magnitude, half_turns - 0.5), half_turns);
  if (any(magnitude > detail::sine_limit)) [[unlikely]]
    return register_by_register([](auto a, auto b) { return detail::with_far_lanes<1>(a, b); }, x, y);
  return y;
}

template <Scalar Real> struct SineCosine { Real sine, cosine; };
/// sin x and cos x, bit-identical to the separate functions; the two polynomials are evaluated in parallel.
template <Scalar Real> LW_INLINE SineCosine<Real> sine_cosine(const Real& x) { return {sine(x), cosine(x)}; }

// ---- exponential, hyperbolic tangent ----------------------------------------------------------------------

namespace detail {

/// (eʳ - 1 - r)/r² on |r| ≤ ln 2 / 2.
inline constexpr double exponential_series[] = {
    0x1.0000000000000p-1,  0x1.5555555555557p-3,  0x1.5555555555556p-5,  0x1.11111111100dfp-7,
    0x1.6c16c16c162d6p-10, 0x1.a01a01abe65c3p-13, 0x1.a01a01a6d79b0p-16, 0x1.71de0236c3217p-19,
    0x1.27e4db6760171p-22, 0x1.af4ddeb6edd5ap-26, 0x1.1f72fd22159cdp-29};

inline constexpr double per_ln2 = 0x1.71547652b82fep0;
inline constexpr double ln2_high = 0x1.62e42fefap-1, ln2_low = 0x1.cf79abc9e3b3ap-40;  // high: 38 bits

/// e^(x + low) for |low| much smaller than 1, such as the rounding error of x.
template <class Real> LW_INLINE Real exponential_of_sum(const Real& x, const Real& low) {
  // Beyond these limits the result is 0 or infinite; comparisons let NaN pass.
  const Real limited = lesser(Real(710.0), greater(Real(-746.0), x));
  const Real n = nearest_integer(limited * per_ln2);
  const Real r = (limited - n * ln2_high) - (n * ln2_low - low);
  const Real y = 1.0 + (r + r * r * polynomial<exponential_series>(r));
  const Real half = nearest_integer(0.5 * n);  // 2ⁿ as two factors: n may exceed the exponent range
  return (y * power_of_two(half)) * power_of_two(n - half);
}

}  // namespace detail

/// eˣ. Error ≤ 2 ulp, denormal results included; infinite from 709.79, 0 below -745.14.
template <Scalar Real> LW_INLINE Real exponential(const Real& x) {
  return detail::exponential_of_sum(x, Real(0.0));
}

/// tanh x = (e^{2|x|} - 1) / (e^{2|x|} + 1) with the sign of x. Error ≤ 2.5 ulp.
template <Scalar Real> LW_INLINE Real hyperbolic_tangent(const Real& x) {
  const Real twice = 2.0 * absolute(x);
  const Real t = lesser(Real(44.0), twice);  // tanh 22 rounds to 1
  const Real n = detail::nearest_integer(t * detail::per_ln2);
  const Real high = t - n * detail::ln2_high, low = n * detail::ln2_low;
  const Real r = high - low, lost = (high - r) - low;  // `lost` keeps the error below 2.5 ulp near t = ½
  const Real small = r + (r * r * detail::polynomial<detail::exponential_series>(r) + lost);
  const Real scale = power_of_two(n);
  const Real e = scale * small + (scale - 1.0);  // e^t - 1 without cancellation
  return flip_sign(e / (e + 2.0), x);
}

// ---- logarithm, power -------------------------------------------------------------------------------------

namespace detail {

/// (ln((1 + √z)/(1 - √z))/√z - 2)/z on [0, (√2 - 1)²/(√2 + 1)²].
inline constexpr double logarithm_series[] = {
    0x1.5555555555555p-1, 0x1.9999999999a38p-2, 0x1.2492492476cc5p-2, 0x1.c71c720159da5p-3,
    0x1.745cf9043c834p-3, 0x1.3b1c356bd77a5p-3, 0x1.0fbe940847ce7p-3, 0x1.0c03af318d9a9p-3};

/// x = (1 + fraction)·2^exponent with 1 + fraction in [√½, √2), for positive finite x, also denormal.
template <class Real> struct Decomposition { Real fraction, exponent; };
template <class Real> LW_INLINE Decomposition<Real> decompose(const Real& x) {
  const auto denormal = x < 0x1p-1022;
  const Real normal = select(denormal, x * 0x1p54, x);
  const Real k = exponent(normal), half = nearest_integer(0.5 * k);  // 2⁻ᵏ alone may be out of range
  const Real mantissa = (normal * power_of_two(-half)) * power_of_two(half - k);
  return {mantissa - 1.0, k - select(denormal, Real(54.0), Real(0.0))};
}

}  // namespace detail

/// ln x. Error ≤ 2 ulp, also for denormal x; -infinity at ±0, NaN for x < 0.
template <Scalar Real> LW_INLINE Real natural_logarithm(const Real& x) {
  const auto [f, k] = detail::decompose(x);
  const Real s = f / (2.0 + f), z = s * s, half_square = 0.5 * f * f;
  const Real tail = z * detail::polynomial<detail::logarithm_series>(z);
  // ln(1 + f) = 2s + s·tail = f - (f²/2 - s (f²/2 + tail)), small terms first
  const Real y =
      k * detail::ln2_high - ((half_square - (s * (half_square + tail) + k * detail::ln2_low)) - f);
  const Real outside = select(x == 0.0, Real(-detail::infinity), select(x < 0.0, Real(__builtin_nan("")), x));
  return select((x > 0.0) & (x < detail::infinity), y, outside);
}

namespace detail {

/// A sum of two doubles, |low| at most half a unit in the last place of high: about 100 bits.
template <class Real> struct Pair { Real high, low; };
/// a + b exactly, for |a| ≥ |b| or a = 0.
template <class Real> LW_INLINE Pair<Real> exact_sum(const Real& a, const Real& b) {
  const Real sum = a + b;
  return {sum, b - (sum - a)};
}
/// a·b exactly, without a fused operation (T. J. Dekker, 1971).
template <class Real> LW_INLINE Pair<Real> exact_product(const Real& a, const Real& b) {
  const Real product = a * b;
  const Real a1 = upper_half(a), a2 = a - a1, b1 = upper_half(b), b2 = b - b1;
  return {product, (((a1 * b1 - product) + a1 * b2) + a2 * b1) + a2 * b2};
}
/// ln x to about 57 bits, for positive finite x.
template <class Real> LW_INLINE Pair<Real> precise_logarithm(const Real& x) {
  const auto [f, k] = decompose(x);
  const Pair<Real> divisor = exact_sum(Real(2.0), f);
  const Real s = f / divisor.high, z = s * s;
  const Pair<Real> back = exact_product(s, divisor.high);
  const Real s_low = (((f - back.high) - back.low) - s * divisor.low) / divisor.high;
  const Pair<Real> leading = exact_sum(k * ln2_high, 2.0 * s);
  const Real leading_low = 2.0 * s_low * (1.0 + z);  // the derivative of ln((1 + s)/(1 - s)) is nearly 2 + 2z
  const Real rest = (leading_low + s * (z * polynomial<logarithm_series>(z))) + k * ln2_low;
  return exact_sum(leading.high, leading.low + rest);
}

}  // namespace detail

/// xʸ = e^(y ln x) for x ≥ 0. Error ≤ 2 + |y ln x|/20 ulp. NaN for x < 0; unlike libm, NaN also for
/// power(NaN, 0) and power(1, NaN).
template <Scalar Real> LW_INLINE Real power(const Real& x, const Real& y) {
  const Real bounded = select(y > 1e300, Real(1e300), select(y < -1e300, Real(-1e300), y));
  const auto logarithm = detail::precise_logarithm(x);
  const auto product = detail::exact_product(bounded, logarithm.high);
  const Real low = select(absolute(product.high) < 1e3, product.low + bounded * logarithm.low, Real(0.0));
  const Real inside = detail::exponential_of_sum(product.high, low);
  // x is 0 or infinite: the result is 0, 1 or infinite
  const Real towards = select(x > 0.0, y, -y);
  const Real limit = select(towards > 0.0, Real(detail::infinity),
                            select(towards < 0.0, Real(0.0), select(y == 0.0, Real(1.0), y)));
  const Real outside = select((x == 0.0) | (x > 0.0), limit, Real(__builtin_nan("")));
  return select((x > 0.0) & (x < detail::infinity), inside, outside);
}

// ---- arc tangent ------------------------------------------------------------------------------------------

namespace detail {

/// (atan(√z)/√z - 1)/z on [0, tan²(π/8)].
inline constexpr double arc_tangent_series[] = {
    -0x1.5555555555555p-2, 0x1.9999999999953p-3, -0x1.249249248d7ecp-3, 0x1.c71c71c304a0ap-4,
    -0x1.745d165defb8dp-4, 0x1.3b1392d96c957p-4, -0x1.110e8801da3d8p-4, 0x1.e19a12f3a3a6bp-5,
    -0x1.ac7a8dd693ad1p-5, 0x1.74ddba0118e5fp-5, -0x1.1b337632305b5p-5, 0x1.0ad2d5e4f477dp-6};

inline constexpr double pi_high = 0x1.921fb54442d18p1, pi_low = 0x1.1a62633145c07p-53;

/// The angle of the point (width, height), both ≥ 0, as high + low. high is 0, π/4 or π/2 rounded to a
/// double; low is the arc tangent of a ratio within ±tan(π/8).
template <class Real> LW_INLINE Pair<Real> angle_in_quadrant(const Real& height, const Real& width) {
  // Scale to a range where sums do not overflow and products keep their bits; the ratio does not change.
  const Real greater = select(height > width, height, width);
  const Real scale =
      select(greater > 0x1p1000, Real(0x1p-60), select(greater < 0x1p-900, Real(0x1p60), Real(1.0)));
  const Real y = scale * height, x = scale * width;
  const double tangent = 0x1.a827999fcef32p-2;  // of π/8
  const auto steep = x < tangent * y, diagonal = (y > tangent * x) & !steep;
  const Real top = select(steep, -x, select(diagonal, y - x, y));
  const Real bottom = select(steep, y, select(diagonal, y + x, x));
  const Real u = top / bottom, z = u * u;
  const Real part_of_pi = select(steep, Real(0.5), select(diagonal, Real(0.25), Real(0.0)));
  return {part_of_pi * pi_high, u + (u * (z * polynomial<arc_tangent_series>(z)) + part_of_pi * pi_low)};
}

}  // namespace detail

/// atan x in rad. Error ≤ 3 ulp.
template <Scalar Real> LW_INLINE Real arc_tangent(const Real& x) {
  const auto angle = detail::angle_in_quadrant(absolute(x), Real(1.0));
  return flip_sign(angle.high + angle.low, x);
}

/// The angle of the point (x, y) in rad, from -π to π; zeros and infinities as libm's atan2. Error ≤ 3 ulp.
template <Scalar Real> LW_INLINE Real arc_tangent2(const Real& y, const Real& x) {
  const Real height = absolute(y), width = absolute(x);
  const auto corner = (height == width) & ((height == 0.0) | (height == detail::infinity));  // 0/0 and ∞/∞
  const Real opposite = select(corner, select(height == 0.0, Real(0.0), Real(1.0)), height);
  const auto angle = detail::angle_in_quadrant(opposite, select(corner, Real(1.0), width));
  const Real right = angle.high + angle.low;
  const Real left = (detail::pi_high - angle.high) + (detail::pi_low - angle.low);
  return flip_sign(select(flip_sign(Real(1.0), x) < 0.0, left, right), y);
}

}  // namespace loopwright

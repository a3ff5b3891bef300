/// The scalar of a simulation: `double` for one run, `Lanes<N, R>` for N·R runs side by side.
///
/// Block equations are written once as a template on `Real` and use only the operations of this file and of
/// functions.h. Every operation is the same IEEE operation in the same order for every Real. A lane therefore
/// gives the same bits as double (compiled with -ffp-contract=off; the payload of a NaN is not specified).
///
///     const Real force = select(speed > 0.0, 2.0 * speed, 0.0);      // not: if (speed > 0.0)
///     const auto stuck = (absolute(speed) < 1e-6) & !moving;         // masks: & | ! for bool too; ! last
#pragma once
#include <concepts>
#include <cstdint>
#ifdef __AVX__
#include <immintrin.h>  // where GCC does not find the single instruction itself
#endif

/// Everything is inlined, even without optimization. Otherwise the linker could use a function compiled for
/// one instruction set in code that must run on another.
#define LW_INLINE [[gnu::always_inline]] inline

namespace loopwright {

/// Bit operations on IEEE doubles: `Register` is a vector of doubles, `Bits` a vector of unsigned integers of
/// the same size. Each operation is described at the function of the same name below.
namespace bits {
inline constexpr std::uint64_t sign_bit = std::uint64_t(1) << 63;
/// Adding 1.5·2⁵² to |x| < 2⁵¹ rounds x half to even and leaves the integer in the low bits of the sum.
inline constexpr double integer_shift = 0x1.8p52;

/// The bits that a and b have in common, and those in which they differ. For registers that GCC 12 would
/// store to memory for a cast to integers, the machine's instructions for doubles are used.
template <class Bits, class Register> LW_INLINE Register common(Register a, Register b) {
#ifdef __AVX512DQ__
  if constexpr (sizeof(Register) == 64) return _mm512_and_pd(a, b);
#endif
#ifdef __AVX__
  if constexpr (sizeof(Register) == 32) return _mm256_and_pd(a, b);
#endif
  return __builtin_bit_cast(Register, __builtin_bit_cast(Bits, a) & __builtin_bit_cast(Bits, b));
}
template <class Bits, class Register> LW_INLINE Register differing(Register a, Register b) {
#ifdef __AVX512DQ__
  if constexpr (sizeof(Register) == 64) return _mm512_xor_pd(a, b);
#endif
#ifdef __AVX__
  if constexpr (sizeof(Register) == 32) return _mm256_xor_pd(a, b);
#endif
  return __builtin_bit_cast(Register, __builtin_bit_cast(Bits, a) ^ __builtin_bit_cast(Bits, b));
}
/// The same bits in every lane.
template <class Bits, class Register> LW_INLINE Register pattern(std::uint64_t bits) {
  return __builtin_bit_cast(Register, Bits{} + bits);
}

template <class Bits, class Register> LW_INLINE Register absolute(Register x) {
  return common<Bits>(x, pattern<Bits, Register>(~sign_bit));
}
template <class Bits, class Register> LW_INLINE Register flip_sign(Register x, Register y) {
  return differing<Bits>(x, common<Bits>(y, pattern<Bits, Register>(sign_bit)));
}
template <class Bits, class Register> LW_INLINE Register negate_if_odd(Register x, Register n) {
  const Bits odd = __builtin_bit_cast(Bits, n + integer_shift) << 63;
  return differing<Bits>(x, __builtin_bit_cast(Register, odd));
}
template <class Bits, class Register> LW_INLINE Register power_of_two(Register n) {
  return __builtin_bit_cast(Register, (__builtin_bit_cast(Bits, n + integer_shift) + 1023) << 52);
}
template <class Bits, class Register> LW_INLINE Register upper_half(Register x) {
  return __builtin_bit_cast(Register, __builtin_bit_cast(Bits, x) & ~((std::uint64_t(1) << 27) - 1));
}
/// Bits of √½: after subtracting them, the exponent field increments where the mantissa passes √2.
inline constexpr std::uint64_t root_half = 0x3FE6A09E667F3BCD;
template <class Bits, class Register> LW_INLINE Register exponent(Register x) {
  const Bits field = (__builtin_bit_cast(Bits, x) + ((std::uint64_t(1023) << 52) - root_half)) >> 52;
  const double biased_zero =
      0x1p52 + 1023.0;  // the integer becomes a double in the low bits of 2⁵² + integer
  return __builtin_bit_cast(Register, field | (std::uint64_t(1075) << 52)) - biased_zero;
}
}  // namespace bits

/// The vector types of one register, written explicitly: GCC 12 loses a vector_size that depends on a
/// template parameter when it deduces a type.
template <int lanes> struct VectorsOf;
#define LW_VECTORS(lanes)                                        \
  template <> struct VectorsOf<lanes> {                          \
    typedef double Doubles [[gnu::vector_size(8 * lanes)]];      \
    typedef std::uint64_t Bits [[gnu::vector_size(8 * lanes)]];  \
    typedef std::int64_t Truths [[gnu::vector_size(8 * lanes)]]; \
  };
LW_VECTORS(2)
LW_VECTORS(4)
LW_VECTORS(8)
#undef LW_VECTORS

/// True if any lane of a register of truth values is set. Without an instruction for it, the halves are
/// combined repeatedly.
template <int lanes> LW_INLINE bool any_of(typename VectorsOf<lanes>::Truths truths) {
#ifdef __AVX512DQ__
  if constexpr (lanes == 8) return _mm512_movepi64_mask(__m512i(truths)) != 0;
#endif
#ifdef __AVX__
  if constexpr (lanes == 4) return _mm256_movemask_pd(__m256d(truths)) != 0;
#endif
  if constexpr (lanes == 2) {
    return (truths[0] | truths[1]) != 0;
  } else {
    struct Halves {
      typename VectorsOf<lanes / 2>::Truths low, high;
    };
    const Halves halves = __builtin_bit_cast(Halves, truths);
    return any_of<lanes / 2>(halves.low | halves.high);
  }
}

/// a < b ? a : b and a > b ? a : b in each lane. GCC would not emit one instruction if one operand is
/// constant.
template <int lanes, class Register> LW_INLINE Register lesser_of(Register a, Register b) {
#ifdef __AVX512F__
  if constexpr (lanes == 8) return _mm512_mask_min_pd(a, 0xff, a, b);
#endif
#ifdef __AVX__
  if constexpr (lanes == 4) return _mm256_min_pd(a, b);
#endif
  return a < b ? a : b;
}
template <int lanes, class Register> LW_INLINE Register greater_of(Register a, Register b) {
#ifdef __AVX512F__
  if constexpr (lanes == 8) return _mm512_mask_max_pd(a, 0xff, a, b);
#endif
#ifdef __AVX__
  if constexpr (lanes == 4) return _mm256_max_pd(a, b);
#endif
  return a > b ? a : b;
}

// R is a small constant. Without the pragma GCC keeps the loop at -O2 and passes the registers through
// memory.
#define LW_EACH_REGISTER _Pragma("GCC unroll 8") for (int i = 0; i < R; ++i)

template <int N, int R> struct Lanes;

/// One truth value per lane. Deliberately not convertible to bool: a lane-wise block cannot branch, it must
/// select.
template <int N, int R> struct Mask {
  using Register = typename VectorsOf<N>::Truths;
  Register registers[R];  // all bits of a lane are set, or none

  Mask() = default;
  /// The same truth value in all lanes; only from a bool, so that no number turns into a mask.
  template <std::same_as<bool> Bool> LW_INLINE Mask(Bool all) {
    LW_EACH_REGISTER registers[i] = Register{} - std::int64_t(all);
  }

  LW_INLINE friend Mask operator&(const Mask& a, const Mask& b) {
    Mask c;
    LW_EACH_REGISTER c.registers[i] = a.registers[i] & b.registers[i];
    return c;
  }
  LW_INLINE friend Mask operator|(const Mask& a, const Mask& b) {
    Mask c;
    LW_EACH_REGISTER c.registers[i] = a.registers[i] | b.registers[i];
    return c;
  }
  LW_INLINE friend Mask operator!(const Mask& a) {
    Mask c;
    LW_EACH_REGISTER c.registers[i] = ~a.registers[i];
    return c;
  }
  LW_INLINE friend Mask& operator&=(Mask& a, const Mask& b) { return a = a & b; }
  LW_INLINE friend Mask& operator|=(Mask& a, const Mask& b) { return a = a | b; }

  LW_INLINE friend bool any(const Mask& a) {
    Register some = a.registers[0];
    LW_EACH_REGISTER some |= a.registers[i];
    return any_of<N>(some);
  }
  LW_INLINE friend bool lane(const Mask& a, int index) { return a.registers[index / N][index % N] != 0; }
  LW_INLINE friend void set_lane(Mask& a, int index, bool value) {
    a.registers[index / N][index % N] = -std::int64_t(value);
  }
  LW_INLINE friend Lanes<N, R> select(const Mask& mask, const Lanes<N, R>& yes, const Lanes<N, R>& no) {
    Lanes<N, R> c;
    LW_EACH_REGISTER c.registers[i] = mask.registers[i] ? yes.registers[i] : no.registers[i];
    return c;
  }
};

/// N·R doubles in R registers of N lanes (N = 2, 4 or 8). If the registers of the machine are narrower than
/// N, the compiler splits them. A double or an integer converts to the same value in every lane.
template <int N, int R = 1> struct Lanes {
  static_assert((N == 2 || N == 4 || N == 8) && R >= 1 && R <= 8);
  using Register = typename VectorsOf<N>::Doubles;
  using Bits = typename VectorsOf<N>::Bits;
  Register registers[R];

  Lanes() = default;
  // Copied register by register, also as a member of a struct: GCC would copy an array of registers through
  // memory.
  LW_INLINE Lanes(const Lanes& x) { LW_EACH_REGISTER registers[i] = x.registers[i]; }
  LW_INLINE Lanes& operator=(const Lanes& x) {
    LW_EACH_REGISTER registers[i] = x.registers[i];
    return *this;
  }
  LW_INLINE Lanes(double value) { LW_EACH_REGISTER registers[i] = value - Register{}; }  // - 0 keeps -0

#define LW_ARITHMETIC(op)                                               \
  LW_INLINE friend Lanes operator op(const Lanes& a, const Lanes& b) {  \
    Lanes c;                                                            \
    LW_EACH_REGISTER c.registers[i] = a.registers[i] op b.registers[i]; \
    return c;                                                           \
  }                                                                     \
  LW_INLINE friend Lanes& operator op##=(Lanes& a, const Lanes& b) { return a = a op b; }
  LW_ARITHMETIC(+)
  LW_ARITHMETIC(-)
  LW_ARITHMETIC(*)
  LW_ARITHMETIC(/)
#undef LW_ARITHMETIC

#define LW_COMPARISON(op)                                                   \
  LW_INLINE friend Mask<N, R> operator op(const Lanes& a, const Lanes& b) { \
    Mask<N, R> c;                                                           \
    LW_EACH_REGISTER c.registers[i] = a.registers[i] op b.registers[i];     \
    return c;                                                               \
  }
  LW_COMPARISON(<)
  LW_COMPARISON(>)
  LW_COMPARISON(<=)
  LW_COMPARISON(>=)
  LW_COMPARISON(==)
  LW_COMPARISON(!=)
#undef LW_COMPARISON

  LW_INLINE friend Lanes operator+(const Lanes& x) { return x; }
  LW_INLINE friend Lanes operator-(const Lanes& x) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = -x.registers[i];
    return y;
  }
  LW_INLINE friend Lanes absolute(const Lanes& x) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = bits::absolute<Bits>(x.registers[i]);
    return y;
  }
  LW_INLINE friend Lanes flip_sign(const Lanes& x, const Lanes& y) {
    Lanes z;
    LW_EACH_REGISTER z.registers[i] = bits::flip_sign<Bits>(x.registers[i], y.registers[i]);
    return z;
  }
  LW_INLINE friend Lanes negate_if_odd(const Lanes& x, const Lanes& n) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = bits::negate_if_odd<Bits>(x.registers[i], n.registers[i]);
    return y;
  }
  LW_INLINE friend Lanes power_of_two(const Lanes& n) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = bits::power_of_two<Bits>(n.registers[i]);
    return y;
  }
  LW_INLINE friend Lanes upper_half(const Lanes& x) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = bits::upper_half<Bits>(x.registers[i]);
    return y;
  }
  LW_INLINE friend Lanes exponent(const Lanes& x) {
    Lanes y;
    LW_EACH_REGISTER y.registers[i] = bits::exponent<Bits>(x.registers[i]);
    return y;
  }
  LW_INLINE friend Lanes square_root(const Lanes& x) {
    Lanes y;
    LW_EACH_REGISTER for (int l = 0; l < N; ++l) y.registers[i][l] = __builtin_sqrt(x.registers[i][l]);
    return y;
  }
  LW_INLINE friend Lanes lesser(const Lanes& a, const Lanes& b) {
    Lanes c;
    LW_EACH_REGISTER c.registers[i] = lesser_of<N>(a.registers[i], b.registers[i]);
    return c;
  }
  LW_INLINE friend Lanes greater(const Lanes& a, const Lanes& b) {
    Lanes c;
    LW_EACH_REGISTER c.registers[i] = greater_of<N>(a.registers[i], b.registers[i]);
    return c;
  }
  LW_INLINE friend Lanes maximum(const Lanes& a, const Lanes& b) { return select(a != a, a, greater(a, b)); }
  LW_INLINE friend Lanes minimum(const Lanes& a, const Lanes& b) { return select(a != a, a, lesser(a, b)); }
  template <class F> LW_INLINE friend Lanes register_by_register(F&& f, const Lanes& a, const Lanes& b) {
    Lanes c;
    LW_EACH_REGISTER {
      Lanes<N, 1> x, y;
      x.registers[0] = a.registers[i], y.registers[0] = b.registers[i];
      c.registers[i] = f(x, y).registers[0];
    }
    return c;
  }
  /// One condition for all lanes, for example on time.
  LW_INLINE friend Lanes select(bool condition, const Lanes& yes, const Lanes& no) {
    return condition ? yes : no;
  }
  LW_INLINE friend double lane(const Lanes& x, int index) { return x.registers[index / N][index % N]; }
  LW_INLINE friend void set_lane(Lanes& x, int index, double value) {
    x.registers[index / N][index % N] = value;
  }
};
#undef LW_EACH_REGISTER

/// A double in the lower half of a register of two, so that bit operations act on it in place. A cast to an
/// integer would move it to an integer register and back.
using Two = VectorsOf<2>;
LW_INLINE Two::Doubles in_register(double x) { return Two::Doubles{x}; }

/// The number of runs in one Real: 1 for double, 0 for a type that is no scalar of a simulation.
template <class Real> inline constexpr int lanes_of = 0;
template <> inline constexpr int lanes_of<double> = 1;
template <int N, int R> inline constexpr int lanes_of<Lanes<N, R>> = (N * R);

template <class Real>
concept Scalar = (lanes_of<Real> > 0);

/// The result type of comparing two Real: bool or Mask.
template <Scalar Real> using MaskOf = decltype(Real() < Real());

/// `yes` in the lanes where the condition holds, `no` in the others. Both are evaluated.
LW_INLINE double select(bool condition, double yes, double no) { return condition ? yes : no; }
/// True if the condition holds in any lane.
LW_INLINE bool any(bool condition) { return condition; }
/// The value of one run, 0 ≤ index < lanes_of<Real>; for masks too.
LW_INLINE double lane(const double& x, int) { return x; }
LW_INLINE bool lane(const bool& condition, int) { return condition; }
LW_INLINE void set_lane(double& x, int, double value) { x = value; }
LW_INLINE void set_lane(bool& condition, int, bool value) { condition = value; }

/// f(a, b); for lanes register by register, so that a function that is not inlined receives them in
/// registers.
template <class F> LW_INLINE double register_by_register(F&& f, double a, double b) { return f(a, b); }
/// |x|.
LW_INLINE double absolute(double x) { return bits::absolute<Two::Bits>(in_register(x))[0]; }
/// a < b ? a : b, hence b where either is NaN.
LW_INLINE double lesser(double a, double b) { return a < b ? a : b; }
/// a > b ? a : b, hence b where either is NaN.
LW_INLINE double greater(double a, double b) { return a > b ? a : b; }
/// The greater of two; NaN if either is NaN, so that a limit does not hide a NaN.
LW_INLINE double maximum(double a, double b) { return a != a ? a : greater(a, b); }
/// The lesser of two; NaN if either is NaN.
LW_INLINE double minimum(double a, double b) { return a != a ? a : lesser(a, b); }
/// √x, correctly rounded; NaN for x < 0.
LW_INLINE double square_root(double x) { return __builtin_sqrt(x); }

/// x, negated where the sign bit of y is set: flip_sign(absolute(x), y) is |x| with the sign of y.
LW_INLINE double flip_sign(double x, double y) {
  return bits::flip_sign<Two::Bits>(in_register(x), in_register(y))[0];
}
/// (-1)ⁿ x for integral |n| < 2⁵¹.
LW_INLINE double negate_if_odd(double x, double n) {
  return bits::negate_if_odd<Two::Bits>(in_register(x), in_register(n))[0];
}
/// 2ⁿ for integral n in [-1022, 1023].
LW_INLINE double power_of_two(double n) { return bits::power_of_two<Two::Bits>(in_register(n))[0]; }
/// The exponent k that puts x·2⁻ᵏ into [√½, √2); x normal and positive.
LW_INLINE double exponent(double x) { return bits::exponent<Two::Bits>(in_register(x))[0]; }
/// x truncated to its upper 26 significant bits, so that products of halves are exact.
LW_INLINE double upper_half(double x) { return bits::upper_half<Two::Bits>(in_register(x))[0]; }

/// -1, 0 or 1; zeros and NaN as they are.
template <Scalar Real> LW_INLINE Real sign_of(const Real& x) {
  return select(x > 0.0, Real(1.0), select(x < 0.0, Real(-1.0), x));
}
/// x rounded to an integer, half to even; infinities and NaN as they are.
template <Scalar Real> LW_INLINE Real round_even(const Real& x) {
  const Real magnitude = absolute(x);
  const Real rounded = (magnitude + 0x1p52) - 0x1p52;  // from 2⁵² on every double is an integer
  return select(magnitude < 0x1p52, flip_sign(rounded, x), x);
}
/// The greatest integer ≤ x; infinities and NaN as they are.
template <Scalar Real> LW_INLINE Real floor_of(const Real& x) {
  const Real rounded = round_even(x);
  return select(rounded > x, rounded - 1.0, rounded);
}
/// Where x is neither infinite nor NaN.
template <Scalar Real> LW_INLINE MaskOf<Real> is_finite(const Real& x) {
  return absolute(x) <= 0x1.fffffffffffffp1023;
}

}  // namespace loopwright

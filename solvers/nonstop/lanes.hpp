#pragma once

// Sixteen doubles side by side, and what the kernel needs of them: enough for two registers of the widest
// set, so that one works while the other waits. This file is compiled once for each instruction set
// (solvers/CMakeLists.txt), so everything in it is local to the source that includes it, and nothing of any
// library is used that a linker might merge between sources.
//
// Every lane goes through the same operations in the same order whatever the instruction set: sums are not
// reassociated and no product is fused with a sum (-ffp-contract=off), which the oldest set does not have. So
// all sets give the same bytes, and the value of a lane does not depend on the others.
namespace {

#if defined(__AVX512F__)
constexpr int kNative = 8;
#elif defined(__AVX__)
constexpr int kNative = 4;
#else
constexpr int kNative = 2;
#endif

#define FRAHM_INLINE inline __attribute__((always_inline))

using Doubles = double __attribute__((vector_size(8 * kNative), may_alias));
using Bits = long long __attribute__((vector_size(8 * kNative), may_alias));

// N lanes as halves of halves, down to the width of a register.
template <int N>
struct alignas(8 * N) Of {
  Of<N / 2> low, high;
};
template <>
struct alignas(8 * kNative) Of<kNative> {
  Doubles v;
};
template <int N>
struct MaskOf {
  MaskOf<N / 2> low, high;
};
template <>
struct MaskOf<kNative> {
  Bits v;
};

using Lanes = Of<16>;
using Mask = MaskOf<16>;

template <int N>
FRAHM_INLINE Of<N> all(double x) {
  if constexpr (N == kNative)
    return {Doubles{} + x};
  else
    return {all<N / 2>(x), all<N / 2>(x)};
}
FRAHM_INLINE Lanes lanes(double x) {
  return all<16>(x);
}

#define FRAHM_BINARY(op)                              \
  template <int N>                                    \
  FRAHM_INLINE Of<N> operator op(Of<N> a, Of<N> b) {  \
    if constexpr (N == kNative)                       \
      return {a.v op b.v};                            \
    else                                              \
      return {a.low op b.low, a.high op b.high};      \
  }                                                   \
  template <int N>                                    \
  FRAHM_INLINE Of<N> operator op(Of<N> a, double b) { \
    return a op all<N>(b);                            \
  }                                                   \
  template <int N>                                    \
  FRAHM_INLINE Of<N> operator op(double a, Of<N> b) { \
    return all<N>(a) op b;                            \
  }
FRAHM_BINARY(+)
FRAHM_BINARY(-)
FRAHM_BINARY(*)
FRAHM_BINARY(/)
#undef FRAHM_BINARY

template <int N>
FRAHM_INLINE Of<N> operator-(Of<N> a) {
  if constexpr (N == kNative)
    return {-a.v};
  else
    return {-a.low, -a.high};
}
template <int N>
FRAHM_INLINE Of<N>& operator+=(Of<N>& a, Of<N> b) {
  return a = a + b;
}

#define FRAHM_COMPARE(op)                                 \
  template <int N>                                        \
  FRAHM_INLINE MaskOf<N> operator op(Of<N> a, Of<N> b) {  \
    if constexpr (N == kNative)                           \
      return {(Bits)(a.v op b.v)};                        \
    else                                                  \
      return {a.low op b.low, a.high op b.high};          \
  }                                                       \
  template <int N>                                        \
  FRAHM_INLINE MaskOf<N> operator op(Of<N> a, double b) { \
    return a op all<N>(b);                                \
  }
FRAHM_COMPARE(<)
FRAHM_COMPARE(>)
FRAHM_COMPARE(==)
#undef FRAHM_COMPARE

template <int N>
FRAHM_INLINE MaskOf<N> operator&(MaskOf<N> a, MaskOf<N> b) {
  if constexpr (N == kNative)
    return {a.v & b.v};
  else
    return {a.low & b.low, a.high & b.high};
}
template <int N>
FRAHM_INLINE MaskOf<N> operator|(MaskOf<N> a, MaskOf<N> b) {
  if constexpr (N == kNative)
    return {a.v | b.v};
  else
    return {a.low | b.low, a.high | b.high};
}
template <int N>
FRAHM_INLINE MaskOf<N> operator~(MaskOf<N> a) {
  if constexpr (N == kNative)
    return {~a.v};
  else
    return {~a.low, ~a.high};
}

template <int N>
FRAHM_INLINE Of<N> select(MaskOf<N> where, Of<N> yes, Of<N> no) {
  if constexpr (N == kNative)
    return {where.v ? yes.v : no.v};
  else
    return {select(where.low, yes.low, no.low), select(where.high, yes.high, no.high)};
}
template <int N>
FRAHM_INLINE Of<N> select(MaskOf<N> where, Of<N> yes, double no) {
  return select(where, yes, all<N>(no));
}

template <int N>
FRAHM_INLINE MaskOf<kNative> joined(MaskOf<N> mask) {
  if constexpr (N == kNative)
    return mask;
  else
    return joined(mask.low) | joined(mask.high);
}
FRAHM_INLINE bool any(const Mask& mask) {
  const Bits bits = joined(mask).v;
#if defined(__AVX512F__) && defined(__clang__)  // which has no such builtin
  return (bits[0] | bits[1] | bits[2] | bits[3] | bits[4] | bits[5] | bits[6] | bits[7]) != 0;
#elif defined(__AVX512F__)
  return __builtin_ia32_ptestmq512(bits, bits, 0xff) != 0;
#elif defined(__AVX__)
  return __builtin_ia32_movmskpd256((Doubles)bits) != 0;
#else
  return (bits[0] | bits[1]) != 0;
#endif
}
FRAHM_INLINE Mask none() {
  const Lanes zero = lanes(0.0);
  return zero < zero;
}
// Lanes are numbers of this type one after the other.
FRAHM_INLINE double& at(Lanes& a, int lane) {
  using Entry = double __attribute__((may_alias));
  return reinterpret_cast<Entry*>(&a)[lane];
}

template <int N>
FRAHM_INLINE Of<N> abs(Of<N> a) {
  if constexpr (N == kNative)
    return {(Doubles)((Bits)a.v & 0x7fffffffffffffff)};
  else
    return {abs(a.low), abs(a.high)};
}
template <int N>
FRAHM_INLINE Of<N> max(Of<N> a, Of<N> b) {
  return select(a > b, a, b);
}
template <int N>
FRAHM_INLINE Of<N> min(Of<N> a, Of<N> b) {
  return select(a < b, a, b);
}
template <int N>
FRAHM_INLINE Of<N> sqrt(Of<N> a) {
  if constexpr (N == kNative) {
    Of<N> result;
    for (int i = 0; i < kNative; ++i) result.v[i] = __builtin_sqrt(a.v[i]);
    return result;
  } else {
    return {sqrt(a.low), sqrt(a.high)};
  }
}

// The nearest integer of |a| < 2^51, as a number; its lowest bits are those of the sum.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
template <int N>
FRAHM_INLINE Of<N> rounded(Of<N> a) {
  return (a + kRounder) - kRounder;
}
FRAHM_INLINE Lanes floor(Lanes a) {
  const Lanes nearest = rounded(a);
  return select(nearest > a, nearest - 1.0, nearest);
}

// 2^n, n an integer within -1022 .. 1023.
template <int N>
FRAHM_INLINE Of<N> power_of_two(Of<N> n) {
  if constexpr (N == kNative) {
    const Bits bits = (Bits)(n.v + kRounder);
    return {(Doubles)((bits + 1023) << 52)};
  } else {
    return {power_of_two(n.low), power_of_two(n.high)};
  }
}

// e^x; 0 below -708. exp(x) = 2^n exp(r), |r| <= ln(2)/2, its Taylor series to r^13: 4e-18.
FRAHM_INLINE Lanes exp(Lanes x) {
  const Lanes within = max(min(x, lanes(709.0)), lanes(-708.0));
  const Lanes n = rounded(within * 1.4426950408889634);
  const Lanes r = (within - n * 0.69314718036912382) - n * 1.9082149292705877e-10;
  Lanes sum = lanes(1.0 / 6227020800.0);
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 0.5;
  sum = sum * r + 1.0;
  sum = sum * r + 1.0;
  return select(x < -708.0, lanes(0.0), sum * power_of_two(n));
}

struct Complex {
  Lanes re, im;
};

FRAHM_INLINE Complex operator+(Complex a, Complex b) {
  return {a.re + b.re, a.im + b.im};
}
FRAHM_INLINE Complex operator-(Complex a, Complex b) {
  return {a.re - b.re, a.im - b.im};
}
FRAHM_INLINE Complex operator*(Complex a, Complex b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
FRAHM_INLINE Complex operator*(Lanes a, Complex b) {
  return {a * b.re, a * b.im};
}
FRAHM_INLINE Complex operator/(Complex a, Complex b) {
  const Lanes inverse = 1.0 / (b.re * b.re + b.im * b.im);
  return {(a.re * b.re + a.im * b.im) * inverse, (a.im * b.re - a.re * b.im) * inverse};
}
FRAHM_INLINE Complex& operator+=(Complex& a, Complex b) {
  return a = a + b;
}
FRAHM_INLINE Complex conjugate(Complex a) {
  return {a.re, -a.im};
}
FRAHM_INLINE Complex select(Mask where, Complex yes, Complex no) {
  return {select(where, yes.re, no.re), select(where, yes.im, no.im)};
}
FRAHM_INLINE Lanes modulus(Complex a) {
  return sqrt(a.re * a.re + a.im * a.im);
}
// Within a factor of sqrt(2) above the modulus, without its root.
FRAHM_INLINE Lanes size_of(Complex a) {
  return abs(a.re) + abs(a.im);
}
// Re(a b)
FRAHM_INLINE Lanes real_part(Complex a, Complex b) {
  return a.re * b.re - a.im * b.im;
}

// Where bit `bit` of the integer n is set.
template <int N>
FRAHM_INLINE MaskOf<N> has_bit(Of<N> n, int bit) {
  if constexpr (N == kNative)
    return {(((Bits)(n.v + kRounder) >> bit) & 1) == 1};
  else
    return {has_bit(n.low, bit), has_bit(n.high, bit)};
}

// e^{ix}, |x| < 1e6. x = n pi/2 + r, |r| <= pi/4, pi/2 in three parts of which the first two have 30 bits
// (Cody and Waite 1980); the Taylor series of cosine to r^16 and of sine to r^17: 2e-18 and 5e-19.
FRAHM_INLINE Complex turn(Lanes x) {
  const Lanes n = rounded(x * 0.63661977236758134);
  const Lanes r = ((x - n * 1.570796325802803) - n * 9.920935791635221e-10) - n * 5.170182981794105e-19;
  const Lanes s = r * r;
  Lanes sine = lanes(1.0 / 355687428096000.0);
  sine = sine * s - 1.0 / 1307674368000.0;
  sine = sine * s + 1.0 / 6227020800.0;
  sine = sine * s - 1.0 / 39916800.0;
  sine = sine * s + 1.0 / 362880.0;
  sine = sine * s - 1.0 / 5040.0;
  sine = sine * s + 1.0 / 120.0;
  sine = sine * s - 1.0 / 6.0;
  sine = r + r * (s * sine);
  Lanes cosine = lanes(1.0 / 20922789888000.0);
  cosine = cosine * s - 1.0 / 87178291200.0;
  cosine = cosine * s + 1.0 / 479001600.0;
  cosine = cosine * s - 1.0 / 3628800.0;
  cosine = cosine * s + 1.0 / 40320.0;
  cosine = cosine * s - 1.0 / 720.0;
  cosine = cosine * s + 1.0 / 24.0;
  cosine = 1.0 + s * (cosine * s - 0.5);
  const Mask odd = has_bit(n, 0), negative = has_bit(n, 1);
  const Lanes c = select(odd, -sine, cosine), q = select(odd, cosine, sine);
  return {select(negative, -c, c), select(negative, -q, q)};
}

// ln x of a normal x > 0. x = 2^n m, m from 1 to 2; ln m = 2 artanh((m - k)/(m + k)) + ln k, k = sqrt(2): the
// series to the 21st power, 4e-18.
template <int N>
FRAHM_INLINE Of<N> exponent_of(Of<N> x) {
  if constexpr (N == kNative) {
    const Bits kept = ((Bits)x.v >> 52) & 0x7ff;
    return {(Doubles)(kept | (Bits)(Doubles{} + 4503599627370496.0)) - 4503599627370496.0 - 1023.0};
  } else {
    return {exponent_of(x.low), exponent_of(x.high)};
  }
}
FRAHM_INLINE Lanes log(Lanes x) {
  const Lanes n = exponent_of(x);
  const Lanes m = x * power_of_two(-n);
  const Lanes t = (m - 1.4142135623730951) / (m + 1.4142135623730951), s = t * t;
  Lanes sum = lanes(1.0 / 21.0);
  for (int k = 19; k >= 1; k -= 2) sum = sum * s + 1.0 / k;
  return (n + 0.5) * 0.69314718055994531 + 2.0 * t * sum;
}

}  // namespace

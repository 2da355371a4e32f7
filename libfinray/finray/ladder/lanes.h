#ifndef FINRAY_LADDER_LANES_H_
#define FINRAY_LADDER_LANES_H_

#include <cmath>
#include <cstring>

// Vector lanes: numbers side by side, so that one instruction serves several
// elements or several columns. Lanes<T>::kWidth is the number of lanes. The
// arithmetic is written once for a value V, which is a double or float or a
// vector of them. Code for another instruction set is compiled in a namespace
// of that name, so that the linker keeps all versions.
#ifndef FINRAY_ISA
#define FINRAY_ISA generic
#endif
#ifndef FINRAY_VECTOR_BYTES
#define FINRAY_VECTOR_BYTES 32
#endif

namespace finray {
inline namespace FINRAY_ISA {

/// A vector of T: one AVX or AVX-512 register, or two of SSE or NEON.
template <class T>
struct Lanes {
  typedef T Vector __attribute__((vector_size(FINRAY_VECTOR_BYTES)));
  /// The same in memory, aligned to T only.
  typedef T Unaligned __attribute__((vector_size(FINRAY_VECTOR_BYTES),
                                     aligned(sizeof(T)), may_alias));
  static constexpr int kWidth = FINRAY_VECTOR_BYTES / sizeof(T);
};

/// The number type of a value, integers of the same size, and its width.
template <class V>
struct ValueTraits {
  using Scalar = V;
  using Integers = long long;
  static constexpr int kWidth = 1;
};
template <>
struct ValueTraits<Lanes<double>::Vector> {
  using Scalar = double;
  using Integers = Lanes<long long>::Vector;
  static constexpr int kWidth = Lanes<double>::kWidth;
};
template <>
struct ValueTraits<Lanes<float>::Vector> {
  using Scalar = float;
  static constexpr int kWidth = Lanes<float>::kWidth;
};

template <class V>
inline V Magnitude(const V& a) {
  return a < V{} ? -a : a;
}

/// The larger one; NaN if either is NaN.
template <class V>
inline V Larger(const V& a, const V& b) {
  return ((a < b) | (b != b)) ? b : a;
}

template <class To, class From>
inline To BitsOf(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof(to));
  return to;
}

/// Sine and cosine to about one unit in the last place for |angle| < 1e5, less
/// exact beyond. angle = n pi / 2 + r with |r| <= pi / 4; pi / 2 is split into
/// three parts, the first of 33 bits, so that n times the first is exact. The
/// polynomials are those of Sun's fdlibm.
template <class V>
inline void SinCos(const V& angle, V* sine, V* cosine) {
  using Scalar = typename ValueTraits<V>::Scalar;
  if constexpr (sizeof(Scalar) == sizeof(double)) {
    using Integers = typename ValueTraits<V>::Integers;
    // Adding this leaves the nearest integer in the last bits.
    constexpr double kRound = 6755399441055744.0;
    const V rounded = angle * 6.36619772367581382433e-01 + kRound;
    const Integers quarters = BitsOf<Integers>(rounded);
    const V n = rounded - kRound;
    const V r = ((angle - n * 1.57079632673412561417e+00) -
                 n * 6.07710050630396597660e-11) -
                n * 2.02226624871116645580e-21;
    const V z = r * r;
    const V s =
        r + r * z *
                (-1.66666666666666324348e-01 +
                 z * (8.33333333332248946124e-03 +
                      z * (-1.98412698298579493134e-04 +
                           z * (2.75573137070700676789e-06 +
                                z * (-2.50507602534068634195e-08 +
                                     z * 1.58969099521155010221e-10)))));
    const V half = z * 0.5, w = 1.0 - half;
    const V c =
        w + (((1.0 - w) - half) +
             z * z *
                 (4.16666666666666019037e-02 +
                  z * (-1.38888888888741095749e-03 +
                       z * (2.48015872894767294178e-05 +
                            z * (-2.75573143513906633035e-07 +
                                 z * (2.08757232129817482790e-09 +
                                      z * -1.13596475577881948265e-11))))));
    const V sine_of = (quarters & 1) != 0 ? c : s;
    const V cosine_of = (quarters & 1) != 0 ? s : c;
    *sine = BitsOf<V>(BitsOf<Integers>(sine_of) ^ ((quarters & 2) << 62));
    *cosine =
        BitsOf<V>(BitsOf<Integers>(cosine_of) ^ (((quarters + 1) & 2) << 62));
  } else if constexpr (ValueTraits<V>::kWidth == 1) {
    *sine = std::sin(angle);
    *cosine = std::cos(angle);
  } else {
    for (int i = 0; i < ValueTraits<V>::kWidth; ++i) {
      (*sine)[i] = std::sin(angle[i]);
      (*cosine)[i] = std::cos(angle[i]);
    }
  }
}

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LANES_H_

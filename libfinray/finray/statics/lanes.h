#ifndef FINRAY_STATICS_LANES_H_
#define FINRAY_STATICS_LANES_H_

#include <cmath>
#include <type_traits>

// Numbers side by side, so that one instruction serves several elements. The
// arithmetic of the elements is written once for a "value" V: a plain double or
// float, or a vector of them. What is compiled for another instruction set
// lives in a namespace of that name, so that the linker keeps both.
#ifndef FINRAY_ISA
#define FINRAY_ISA generic
#endif

// The C library's vector sines (libmvec, to 4 units in the last place).
#if defined(__AVX2__) && !defined(FINRAY_NO_VECTOR_SINES)
#define FINRAY_VECTOR_SINES
extern "C" {
__attribute__((vector_size(32))) double _ZGVdN4v_sin(
    __attribute__((vector_size(32))) double);
__attribute__((vector_size(32))) double _ZGVdN4v_cos(
    __attribute__((vector_size(32))) double);
}
#endif

namespace finray {
inline namespace FINRAY_ISA {

/// 32 bytes of T: one AVX register, two of SSE or NEON.
template <class T>
struct Lanes {
  typedef T Vector __attribute__((vector_size(32)));
  /// The same in memory of any alignment.
  typedef T Unaligned
      __attribute__((vector_size(32), aligned(sizeof(T)), may_alias));
  static constexpr int kWidth = 32 / sizeof(T);
};

/// The number type of a value and how many of them it holds.
template <class V>
struct ValueTraits {
  using Scalar = V;
  static constexpr int kWidth = 1;
};
template <>
struct ValueTraits<Lanes<double>::Vector> {
  using Scalar = double;
  static constexpr int kWidth = Lanes<double>::kWidth;
};
template <>
struct ValueTraits<Lanes<float>::Vector> {
  using Scalar = float;
  static constexpr int kWidth = Lanes<float>::kWidth;
};

template <class V>
inline void SinCos(const V& angle, V* sine, V* cosine) {
  if constexpr (ValueTraits<V>::kWidth == 1) {
    *sine = std::sin(angle);
    *cosine = std::cos(angle);
#ifdef FINRAY_VECTOR_SINES
  } else if constexpr (std::is_same_v<V, Lanes<double>::Vector>) {
    *sine = _ZGVdN4v_sin(angle);
    *cosine = _ZGVdN4v_cos(angle);
#endif
  } else {
    V s{}, c{};
    for (int i = 0; i < ValueTraits<V>::kWidth; ++i) {
      s[i] = std::sin(angle[i]);
      c[i] = std::cos(angle[i]);
    }
    *sine = s;
    *cosine = c;
  }
}

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_STATICS_LANES_H_

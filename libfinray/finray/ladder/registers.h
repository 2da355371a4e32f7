#ifndef FINRAY_LADDER_REGISTERS_H_
#define FINRAY_LADDER_REGISTERS_H_

#ifndef FINRAY_ISA
#define FINRAY_ISA generic
#endif

namespace finray {
inline namespace FINRAY_ISA {

/// The width of a register of doubles. Code that compares its lanes takes one
/// register: vectors of two are split badly.
#if defined(__AVX512F__)
constexpr int kRegisterWidth = 8;
#elif defined(__AVX2__)
constexpr int kRegisterWidth = 4;
#else
constexpr int kRegisterWidth = 2;
#endif

/// `width` doubles side by side, and the same in memory without alignment.
template <int width>
struct Doubles {
  typedef double Vector __attribute__((vector_size(width * sizeof(double))));
  typedef double Unaligned __attribute__((vector_size(width * sizeof(double)),
                                          aligned(sizeof(double)), may_alias));

  static Vector Load(const double* from) {
    return *reinterpret_cast<const Unaligned*>(from);
  }
  static void Store(const Vector& value, double* to) {
    *reinterpret_cast<Unaligned*>(to) = value;
  }

  /// The least and the greatest lane of a vector without NaN. Halves compare
  /// as vectors. A loop over lanes would move each lane to a register of its
  /// own.
  static double Least(const Vector& value) {
    const auto* const lanes = reinterpret_cast<const double*>(&value);
    if constexpr (width == 1) {
      return *lanes;
    } else {
      using Half = Doubles<width / 2>;
      const auto low = Half::Load(lanes), high = Half::Load(lanes + width / 2);
      return Half::Least(high < low ? high : low);
    }
  }
  static double Greatest(const Vector& value) { return -Least(-value); }
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_REGISTERS_H_

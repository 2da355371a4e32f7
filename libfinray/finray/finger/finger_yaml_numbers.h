#ifndef FINRAY_FINGER_FINGER_YAML_NUMBERS_H_
#define FINRAY_FINGER_FINGER_YAML_NUMBERS_H_

#include <charconv>
#include <string_view>

namespace finray {

// The reader and the writer of finger YAML share these keys and numbers. Each
// number is rounded once, in long double. Each value of a finger then has a
// text that reads back as the same value.

inline constexpr const char* kHingeStiffness = "hinge_stiffness_N_mm_per_rad";
inline constexpr const char* kClampStiffness = "clamp_stiffness_N_mm_per_rad";
inline constexpr const char* kSurfaceOffset = "surface_offset_mm";
inline constexpr const char* kRigidEnds = "rigid_ends_mm";
inline constexpr const char* kBendingStiffness = "bending_stiffness_N_mm2";

/// A number that YamlMap has accepted, with more digits than a double holds.
inline long double LongNumber(std::string_view text) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  long double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// The ratio of two stiffnesses, rounded once. The quotient of two doubles does
/// not take every value, so some ratios could not be written; long double can.
inline double StiffnessRatio(long double stiffness, long double reference) {
  return static_cast<double>(stiffness / reference);
}

/// The compliance of a clamp whose stiffness is written so.
inline double ComplianceOf(std::string_view stiffness) {
  return static_cast<double>(1 / LongNumber(stiffness));
}

inline constexpr long double kLongDegree =
    3.14159265358979323846264338327950288L / 180;

/// Radians of an angle in degrees, rounded once. A double in degrees may be
/// coarser than one in radians: without long double one angle in ten would not
/// read back.
inline double RadFromDegrees(std::string_view text) {
  return static_cast<double>(LongNumber(text) * kLongDegree);
}

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_YAML_NUMBERS_H_

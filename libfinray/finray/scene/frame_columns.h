#ifndef FINRAY_SCENE_FRAME_COLUMNS_H_
#define FINRAY_SCENE_FRAME_COLUMNS_H_

#include <string>

namespace finray {

/// Column names of the frame table that carry an index. The index in a name
/// counts from 1, the function's argument from 0.
inline std::string IndexedColumn(const char* before, int index,
                                 const char* after) {
  return before + std::to_string(index + 1) + after;
}
inline std::string GaugeVolts(int j) {
  return IndexedColumn("gauge_", j, "_V");
}
inline std::string GaugeAngle(int j) {
  return IndexedColumn("gauge_", j, "_rad");
}
inline std::string GaugeOffset(int j) {
  return IndexedColumn("gauge_", j, "_offset_V");
}
inline std::string GaugeOffsetStd(int j) {
  return IndexedColumn("gauge_", j, "_offset_std_V");
}
inline std::string ContactArc(int c) {
  return IndexedColumn("contact_", c, "_mm");
}
inline std::string ContactArcStd(int c) {
  return IndexedColumn("contact_", c, "_std_mm");
}
inline std::string ContactArcNoise(int c) {
  return IndexedColumn("contact_", c, "_noise_mm");
}
inline std::string ContactArcLow(int c) {
  return IndexedColumn("contact_", c, "_low_mm");
}
inline std::string ContactArcHigh(int c) {
  return IndexedColumn("contact_", c, "_high_mm");
}
inline std::string ContactX(int c) {
  return IndexedColumn("contact_", c, "_x_mm");
}
inline std::string ContactY(int c) {
  return IndexedColumn("contact_", c, "_y_mm");
}
inline std::string ContactAngle(int c) {
  return IndexedColumn("contact_", c, "_angle_rad");
}
inline std::string NormalForce(int c) {
  return IndexedColumn("normal_", c, "_N");
}
inline std::string NormalForceStd(int c) {
  return IndexedColumn("normal_", c, "_std_N");
}
inline std::string NormalForceNoise(int c) {
  return IndexedColumn("normal_", c, "_noise_N");
}
inline std::string NormalForceLow(int c) {
  return IndexedColumn("normal_", c, "_low_N");
}
inline std::string NormalForceHigh(int c) {
  return IndexedColumn("normal_", c, "_high_N");
}
inline std::string AlternativeContactArc(int c) {
  return IndexedColumn("alternative_contact_", c, "_mm");
}
inline std::string AlternativeNormalForce(int c) {
  return IndexedColumn("alternative_normal_", c, "_N");
}
inline std::string Friction(int c) { return IndexedColumn("friction_", c, ""); }
inline std::string RibForce(int i) { return IndexedColumn("rib_", i, "_N"); }
/// A coordinate of a rib's hinge on one beam. `beam` is "front" or "back",
/// `axis` is "x" or "y".
inline std::string RibPin(int i, const std::string& beam,
                          const std::string& axis) {
  return IndexedColumn("rib_", i, "_") + beam + "_" + axis + "_mm";
}

}  // namespace finray

#endif  // FINRAY_SCENE_FRAME_COLUMNS_H_

#ifndef FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_
#define FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_

#include <cstddef>
#include <limits>
#include <vector>

#include "finray/io/yaml_emitter.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

/// Force and place of a frame from its references; NaN where there is none.
struct FrameReference {
  bool contact = false;  ///< the finger touches
  double force_N = std::numeric_limits<double>::quiet_NaN();
  double force_std_N = 0;
  double contact_mm = std::numeric_limits<double>::quiet_NaN();
  double contact_std_mm = 0;
};

/// Errors e = estimate - reference of one quantity, and how honest its std are.
struct ErrorStatistics {
  std::size_t frames = 0;  ///< with an error
  double squares = 0, sum = 0, largest = 0;
  double reference_squares = 0;
  /// Frames with a std, and those of them with |e| <= k s, where s^2 is the
  /// variance of the estimate plus that of the reference: k = 1 (68.3 %) and
  /// 1.96 (95 %). What should have been found and was not has no std, and is
  /// outside of both.
  std::size_t judged = 0, within_68 = 0, within_95 = 0;

  void Add(double error, double reference, double std);
  /// A quantity that is there, unless NaN, and of which the estimate says that
  /// it is not.
  void Miss(double reference);
  double rms() const;
  double bias() const;
  /// rms of the errors in percent of the rms of the reference.
  double percent() const;
  double coverage_68_percent() const;
  double coverage_95_percent() const;
};

/// Errors of the frames of one kind or region.
struct ErrorRow {
  std::size_t frames = 0;  ///< all
  /// ok or no_contact: numbers are given and may be used.
  std::size_t usable = 0;
  std::size_t missed = 0;  ///< touches, but the gauges say no_contact
  std::size_t untrue = 0;  ///< free, but the gauges say contact
  ErrorStatistics force_N, contact_mm;

  double usable_percent() const;
  void Add(const FrameReference& reference, const FrameEstimate& estimate,
           double friction);
};

/// Errors over all frames with contact, over free ones, and by region of the
/// finger: kRegions equal lengths of the front beam, base to tip.
struct ErrorTable {
  static constexpr int kRegions = 5;

  double front_length_mm = 0;
  ErrorRow contact, free;
  ErrorRow regions[kRegions];

  double region_end_mm(int region) const {
    return front_length_mm * (region + 1) / kRegions;
  }
  /// The region of an arc length; -1 for NaN.
  int RegionOf(double arc_mm) const;
  /// `place_mm` decides the region: where the reference, or else the estimate,
  /// has the contact.
  void Add(const FrameReference& reference, const FrameEstimate& estimate,
           double place_mm, double friction);
};

/// The table as a YAML mapping {contact, free, regions}.
void EmitErrorTable(const ErrorTable& table, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_

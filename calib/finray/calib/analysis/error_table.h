#ifndef FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_
#define FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_

#include <cstddef>
#include <limits>
#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// The force and the place of a frame by its references; NaN if there is none.
struct FrameReference {
  bool contact = false;  ///< The finger touches.
  double force_N = std::numeric_limits<double>::quiet_NaN();
  double force_std_N = 0;
  double contact_mm = std::numeric_limits<double>::quiet_NaN();
  double contact_std_mm = 0;
  bool undecided = false;  ///< Whether it touches is not certain.
};

/// The errors e = estimate - reference of one quantity, and how honest their
/// std are.
struct ErrorStatistics {
  std::size_t frames = 0;  ///< Number of frames with an error.
  double squares = 0, sum = 0, largest = 0;
  double reference_squares = 0, reference_sum = 0;
  /// The number of frames with a std s, and of those among them with |e| <= k
  /// s. s^2 is the variance of the estimate plus that of the reference. k is 1
  /// (68.3 %) and 1.96 (95 %). A quantity that the estimate misses has no std
  /// and counts as outside of both.
  std::size_t judged = 0, within_68 = 0, within_95 = 0;
  /// The number of frames with a std, and the sum of (e / s)^2 over them.
  std::size_t scored = 0;
  double z_squares = 0;

  void Add(double error, double reference, double std);
  /// Counts a quantity that is there, unless it is NaN, and that the estimate
  /// misses.
  void Miss(double reference);
  double rms() const;
  double bias() const;
  double reference_mean() const;
  /// The rms of the errors in percent of the rms of the reference.
  double percent() const;
  /// The rms of e / s: 1 if the std are honest, NaN without any.
  double rms_z() const;
  double coverage_68_percent() const;
  double coverage_95_percent() const;
};

/// The errors of the frames of one kind or region.
struct ErrorRow {
  std::size_t frames = 0;  ///< Number of all frames.
  /// The number of frames that are ok or no_contact, whose numbers may be used.
  std::size_t usable = 0;
  std::size_t missed = 0;  ///< They touch; the gauges say no_contact.
  std::size_t untrue = 0;  ///< They are free; the gauges say contact.
  ErrorStatistics force_N, contact_mm;

  double usable_percent() const;
  void Add(const FrameReference& reference, const FrameEstimate& estimate,
           double friction);
};

/// The errors over all frames with contact, over free frames, and by region of
/// the finger. The kRegions regions are equal lengths of the front beam, from
/// base to tip.
struct ErrorTable {
  static constexpr int kRegions = 5;

  double front_length_mm = 0;
  ErrorRow contact, free;
  ErrorRow regions[kRegions];

  double region_end_mm(int region) const {
    return front_length_mm * (region + 1) / kRegions;
  }
  /// Returns the region of an arc length, -1 for NaN.
  int RegionOf(double arc_mm) const;
  /// Adds a frame. `place_mm` decides its region: the place of the contact in
  /// the reference, or else in the estimate.
  void Add(const FrameReference& reference, const FrameEstimate& estimate,
           double place_mm, double friction);
};

/// Emits a key and the table as a YAML mapping {contact, free, regions}.
void EmitErrorTable(const char* key, const ErrorTable& table,
                    YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_ERROR_TABLE_H_

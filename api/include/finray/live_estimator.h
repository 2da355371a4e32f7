#ifndef FINRAY_LIVE_ESTIMATOR_H_
#define FINRAY_LIVE_ESTIMATOR_H_

#include <limits>
#include <memory>
#include <vector>

#include "finray/estimator.h"
#include "finray/export.h"
#include "finray/finger.h"
#include "finray/scene.h"

namespace finray::v1 {

/// The measurements of one frame; NaN where nothing was measured.
struct Readings {
  static constexpr double kNotMeasured =
      std::numeric_limits<double>::quiet_NaN();

  std::vector<double> gauges_V;  ///< One per gauge of the finger.
  double time_s = kNotMeasured;  ///< Needed if a gauge creeps.
  double object_x_mm = kNotMeasured, object_y_mm = kNotMeasured;
  double object_angle_deg = 0;
};

/// One contact; NaN where there is none.
struct Contact {
  double arc_mm;  ///< l_c, from the base of the front beam.
  double arc_std_mm;
  double normal_N;  ///< f_c
  double normal_std_N;
  double x_mm, y_mm, angle_rad;  ///< Of the front beam there, in frame S.
  double arc_low_mm, arc_high_mm, normal_low_N, normal_high_N;
};

/// The estimate of one frame.
struct Frame {
  static constexpr int kMostContacts = 2;

  FrameStatus status = FrameStatus::kBadInput;
  int contacts = 0;
  Contact contact[kMostContacts];  ///< From base to tip.
  double chi2, chi2_p_value;
  double tip_x_mm, tip_y_mm, tip_angle_rad;
  int iterations;
  bool search_ended;           ///< By the scene's search_iteration_limit.
  std::vector<double> ribs_N;  ///< Tension of each rib.
};

/// Estimates frames as they arrive, as finray_estimate --follow does. Use one
/// from one thread at a time.
class FINRAY_API LiveEstimator {
 public:
  /// Throws InputError as Estimator does.
  explicit LiveEstimator(const Finger& finger, const Scene& scene = Scene(),
                         const EstimateOptions& options = {});
  ~LiveEstimator();
  LiveEstimator(LiveEstimator&&) noexcept;
  LiveEstimator& operator=(LiveEstimator&&) noexcept;

  /// Estimates the next frame. The result is valid until the next call. Throws
  /// InputError if there are not as many gauges as the finger has, or if a
  /// gauge creeps and there is no time_s.
  const Frame& Next(const Readings& readings);
  /// The next frame begins a new log.
  void Restart();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_LIVE_ESTIMATOR_H_

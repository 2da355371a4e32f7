#ifndef FINRAY_SENSING_FRAME_ESTIMATOR_H_
#define FINRAY_SENSING_FRAME_ESTIMATOR_H_

#include <vector>

#include "finray/finger/finger.h"
#include "finray/sensing/contact_fit.h"
#include "finray/sensing/frame_estimate.h"
#include "finray/sensing/frame_readings.h"
#include "finray/sensing/gauge_table.h"
#include "finray/sensing/scene.h"

namespace finray {

/// Estimates one frame at a time from gauge volts: l_c and f_c by ContactFit,
/// started from a GaugeTable, so that every frame is a cold one and the result
/// does not depend on its neighbours.
///
/// Statuses (docs/estimation.md):
///  - no_contact: the free finger explains the frame; with contacts "auto" that
///    is when one contact lowers chi2 by less than kSignificance, with one
///    contact given when f_c is below kLeastForce_N.
///  - unobservable: solved, but std of l_c above kLargestArcStd of l_0 or std
///  of
///    f_c above kLargestForceStd of f_c, or l_c at an end of the beam.
///  - bad_input: fewer gauges measured than unknowns.
class FrameEstimator {
 public:
  static constexpr double kSignificance = 13.8;  // chi2, 2 dof, p = 0.001
  static constexpr double kLeastForce_N = 0.03;
  static constexpr double kLargestArcStd = 0.05;
  static constexpr double kLargestForceStd = 0.25;
  static constexpr double kMostForce = 4;

  /// Throws InputError for a scene of more than one contact or a finger without
  /// an unloaded equilibrium.
  FrameEstimator(const Finger& finger, const Scene& scene,
                 const Discretization& discretization);

  FrameEstimate Estimate(const FrameReadings& readings);

  const Finger& finger() const { return finger_; }

 private:
  FrameEstimate FreeEstimate(double chi2, int dof) const;
  FrameEstimate FitFrom(const GaugeTable::Start& start,
                        const Eigen::VectorXd& angles_rad,
                        const Eigen::VectorXd& weight_per_rad);

  Finger finger_;
  Scene scene_;
  EquilibriumSolver solver_;
  GaugeTable table_;
  ContactFit fit_;
  std::vector<GaugeTable::Start> starts_;
  std::vector<PointContact> contacts_;
  FrameEstimate free_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_ESTIMATOR_H_

#ifndef FINRAY_SENSING_FRAME_ESTIMATOR_H_
#define FINRAY_SENSING_FRAME_ESTIMATOR_H_

#include <vector>

#include "finray/finger/finger.h"
#include "finray/sensing/contact_fit.h"
#include "finray/sensing/gauge_table.h"
#include "finray/sensing/scene.h"

namespace finray {

/// The `status` column of a frame table.
enum class FrameStatus {
  kOk,
  kNoContact,
  kUnobservable,
  kNotConverged,
  kBadInput
};
const char* StatusName(FrameStatus status);

/// What the gauges of one frame say.
struct FrameEstimate {
  FrameStatus status = FrameStatus::kBadInput;
  double contact_mm, contact_std_mm;  ///< l_c; NaN without a contact.
  double normal_N, normal_std_N;      ///< f_c; 0 without a contact.
  Eigen::Vector3d contact_pose;       ///< x, y (mm), theta (rad) or NaN.
  Eigen::Vector3d tip_pose;
  std::vector<double> rib_tension_N;
  double chi2;  ///< Sum of squared whitened gauge residuals.
  int iterations = 0;
};

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

  /// `readings_V`: one per gauge, NaN where not measured.
  FrameEstimate Estimate(const std::vector<double>& readings_V);

  const Finger& finger() const { return finger_; }

 private:
  FrameEstimate FreeEstimate(double chi2) const;
  FrameEstimate ContactEstimate(const GaugeTable::Start& start,
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

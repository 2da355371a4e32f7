#ifndef FINRAY_SENSING_FRAME_ESTIMATOR_H_
#define FINRAY_SENSING_FRAME_ESTIMATOR_H_

#include "finray/finger/finger.h"
#include "finray/sensing/contact_search.h"
#include "finray/sensing/frame_estimate.h"
#include "finray/sensing/frame_readings.h"
#include "finray/sensing/scene.h"

namespace finray {

/// Estimates one frame at a time: as many contacts as the scene says, or as few
/// as explain the readings, l_c and f_c of each by ContactSearch. Every frame
/// is a cold one and the result does not depend on its neighbours.
///
/// `contacts: auto` takes one contact more while that lowers chi2 by
/// kSignificance or more, two only with four gauges or more.
///
/// A frame whose chi2 has a p-value below kUnexplained is not what the model
/// says with this noise: its std are those of a noise that would explain it,
/// scaled by sqrt(chi2 / dof).
///
/// Statuses (docs/estimation.md):
///  - no_contact: no contact, by that criterion or, with the number given, as
///    all forces are below kLeastForce_N.
///  - unobservable: solved, but std of l_c above kLargestArcStd of l_0 or std
///    of f_c above kLargestForceStd of f_c, or l_c at an end of the beam, or
///    another solution explains the frame as well.
///  - bad_input: fewer measurements than unknowns.
class FrameEstimator {
 public:
  static constexpr double kSignificance = 13.8;  // chi2, 2 dof, p = 0.001
  static constexpr double kUnexplained = 0.001;  // p-value
  static constexpr double kLeastForce_N = 0.03;
  static constexpr double kLargestArcStd = 0.05;
  static constexpr double kLargestForceStd = 0.25;

  /// Throws InputError for a scene of more than two contacts or with contacts
  /// on the back beam, a finger without gauges or with fewer than the contacts
  /// need, and a finger without an unloaded equilibrium.
  FrameEstimator(const Finger& finger, const Scene& scene,
                 const Discretization& discretization);

  FrameEstimate Estimate(const FrameReadings& readings);

  const Finger& finger() const { return finger_; }

 private:
  void Measure(const FrameReadings& readings);
  FrameEstimate Automatic();
  FrameEstimate WithContacts(int contacts);
  FrameEstimate Free() const;
  FrameEstimate Unsolved(FrameStatus status) const;
  FrameEstimate Found(const ContactSearch& search) const;

  Finger finger_;
  Scene scene_;
  ContactSearch search_;
  FrameEstimate free_;
  // Of the frame under way: gauge angles and, if the scene measures it, the
  // circle's centre; 1 / std, 0 where not measured.
  Eigen::VectorXd measured_, weights_;
  int gauges_measured_ = 0, all_measured_ = 0;
  double free_chi2_ = 0;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_ESTIMATOR_H_

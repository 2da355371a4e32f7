#ifndef FINRAY_SENSING_FRAME_ESTIMATOR_H_
#define FINRAY_SENSING_FRAME_ESTIMATOR_H_

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"
#include "finray/sensing/calibration_uncertainty.h"
#include "finray/sensing/contact_search.h"
#include "finray/sensing/contact_smoother.h"
#include "finray/sensing/fast/frame_follower.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

/// Estimates frames: as many contacts as the scene says, or as few as explain
/// the readings, l_c and f_c of each by ContactSearch, without a guess.
///
/// `contacts: auto` takes a contact if that lowers chi2 by kSignificance or
/// more, and with four gauges or more a second one if that lowers it by another
/// kSecondSignificance or more.
///
/// A frame that is not what the model says with this noise has the std of a
/// noise that would explain it (FrameEstimate::noise_scale).
///
/// Statuses (docs/reference/estimation.md):
///  - no_contact: no contact, by that criterion or, with the number given, as
///    all forces are below kLeastForce_N, of soft fingers kLeastForce.
///  - unobservable: solved, but std of l_c above kLargestArcStd of l_0 or std
///    of f_c above kLargestForceStd of f_c, or l_c at an end of the beam, or
///    another solution explains the frame as well.
///  - bad_input: fewer measurements than unknowns.
class FrameEstimator {
 public:
  static constexpr double kSignificance = 13.8;  // chi2, 2 dof, p = 0.001
  /// A second contact explains almost anything: it takes p = 1e-6.
  static constexpr double kSecondSignificance = 27.6;
  static constexpr double kLeastForce_N = 0.03;
  static constexpr double kLeastForce = 0.05;  ///< In units of EI / l_0^2.
  static constexpr double kLargestArcStd = 0.05;
  static constexpr double kLargestForceStd = 0.25;

  /// Throws InputError for a scene of more than two contacts or with contacts
  /// on the back beam, a finger without gauges or with fewer than the contacts
  /// need, and a finger without an unloaded equilibrium.
  FrameEstimator(const Finger& finger, const Scene& scene,
                 const Discretization& discretization,
                 FrameMethod method = FrameMethod::kFast);
  FrameEstimator(const FrameEstimator&) = delete;
  FrameEstimator& operator=(const FrameEstimator&) = delete;

  /// The frame alone.
  FrameEstimate Estimate(const Measurements& readings);

  /// Frames that follow each other, smoothed if the scene says so. The result
  /// depends on these readings and on nothing else.
  void EstimateBlock(const Measurements* readings, std::size_t count,
                     FrameEstimate* estimates);

  /// The frame that follows the one of the last call, smoothed by those before
  /// it if the scene says so.
  FrameEstimate Follow(const Measurements& readings);
  /// The next frame that is followed is the first one of its log.
  void StopFollowing() {
    following_ = false;
    followed_.reset();
  }

  const Finger& finger() const { return finger_; }

 private:
  bool CanFollow(const FrameEstimate& estimate);
  std::size_t FollowOn(const Measurements* readings, std::size_t count,
                       FrameEstimate* estimates);
  std::size_t FitRun(const Measurements* readings, std::size_t count);
  bool TakeFollowed(const Measurements& readings, std::size_t frame,
                    FrameEstimate* estimate);
  FrameEstimate Automatic(const Measurements& readings);
  FrameEstimate WithContacts(const Measurements& readings, int contacts);
  FrameEstimate Free() const;
  FrameEstimate Unsolved(FrameStatus status) const;
  FrameEstimate Found(const Measurements& readings);
  // Adds what the calibration leaves uncertain to the std, and sets the status.
  void Judge(const Measurements& readings, const Eigen::VectorXd& weights,
             FrameEstimate* estimate);
  void Smooth(const Measurements* readings, std::size_t count,
              const std::optional<ContactSmoother::Belief>& before,
              FrameEstimate* estimates);

  Finger finger_;
  Scene scene_;
  FrameMethod method_;
  double least_force_N_;
  ContactSearch search_;
  std::optional<FrameFollower> follower_;  // where it serves the scene
  bool following_ = false;                 // by Follow
  CalibrationUncertainty systematic_;
  std::vector<PointContact> contacts_;
  std::optional<ContactSmoother> smoother_;
  std::optional<ContactSmoother::Belief> followed_;  // by Follow
  FrameEstimate free_;
  // Of the frame under way.
  PackedReadings measurement_;
  std::vector<PackedReadings> measurements_;  // of a run of frames
  double free_chi2_ = 0;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_ESTIMATOR_H_

#ifndef FINRAY_ESTIMATION_FRAME_ESTIMATE_H_
#define FINRAY_ESTIMATION_FRAME_ESTIMATE_H_

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "finray/estimation/valley.h"
#include "finray/fit/contact_covariance.h"

namespace finray {

/// The `status` column of a frame table. FrameEstimator decides it.
enum class FrameStatus {
  kOk,
  kNoContact,
  kUnobservable,
  kNotConverged,
  kBadInput
};
const char* StatusName(FrameStatus status);

/// One contact of an estimate; NaN where there is none.
struct ContactEstimate {
  double arc_mm = std::numeric_limits<double>::quiet_NaN();  ///< l_c
  double arc_std_mm = std::numeric_limits<double>::quiet_NaN();
  double normal_N = std::numeric_limits<double>::quiet_NaN();  ///< f_c
  double normal_std_N = std::numeric_limits<double>::quiet_NaN();
  /// x, y (mm) and theta (rad) of the front beam at the contact.
  Eigen::Vector3d pose =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// The interval of two std; where the valley of chi2 is curved, what its
  /// profile says (Valley).
  double arc_low_mm = std::numeric_limits<double>::quiet_NaN();
  double arc_high_mm = std::numeric_limits<double>::quiet_NaN();
  double normal_low_N = std::numeric_limits<double>::quiet_NaN();
  double normal_high_N = std::numeric_limits<double>::quiet_NaN();
  /// The part of the std that the declared noise makes. It differs from frame
  /// to frame, so the mean of n frames of one contact has the std
  /// sqrt(noise^2 / n + std^2 - noise^2). The rest is common to them: errors of
  /// the calibration, of offsets that wander, and what the model misses. The
  /// scene's smoothing correlates the noise of frames that follow each other,
  /// so there the mean of frames is less exact than this says.
  double arc_noise_mm = std::numeric_limits<double>::quiet_NaN();
  double normal_noise_N = std::numeric_limits<double>::quiet_NaN();
};
using ContactEstimates = std::array<ContactEstimate, kFittedContacts>;

/// The estimate of one frame.
struct FrameEstimate {
  FrameStatus status = FrameStatus::kBadInput;
  int contacts = 0;
  /// The contacts from base to tip. Without a contact, the force of the first
  /// one is 0 if the status is no_contact, else NaN.
  ContactEstimates contact;
  // The two parts of the covariance of (l_c, f_c) of each contact. LogEstimator
  // leaves them empty.

  /// Due to the std given in the finger and the scene, without noise_scale().
  /// It is that of the frame alone, also if the frame is smoothed.
  ContactMatrix noise_covariance;
  /// Due to the errors of the calibration. Empty if the finger has no
  /// covariance.
  ContactMatrix calibration_covariance;
  /// Of the one contact of the frame alone, where it is curved.
  std::optional<Valley> valley;
  Eigen::Vector3d tip_pose =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<double> rib_tension_N;
  /// Sum of squared whitened residuals, and the number of measurements minus
  /// the number of unknowns.
  double chi2 = std::numeric_limits<double>::quiet_NaN();
  int dof = 0;
  /// Where noise alone does not explain the frame and the finger has a
  /// calibration: the chi2 that errors of the calibration and the discrepancy
  /// leave (CalibrationErrors::Chi2). NaN elsewhere.
  double model_chi2 = std::numeric_limits<double>::quiet_NaN();
  int iterations = 0;
  /// The tangential share with which the contacts were found, where the motion
  /// of the object tells it (Measurements::friction); NaN where it is the
  /// scene's.
  double friction = std::numeric_limits<double>::quiet_NaN();
  /// The scene's search_iteration_limit has ended the search. The frame is then
  /// neither ok nor no_contact: what was left to try may explain it better.
  bool search_ended = false;
  /// `contacts: auto` has found one contact, which leaves so much chi2 that a
  /// second one would be looked for, but for too few readings to tell whether
  /// it is there (FrameEstimator::kSecondSignificance). From
  /// kUntoldSignificance on the frame is unobservable.
  bool may_be_two = false;
  /// A distinct solution with as many contacts that explains the frame within
  /// its noise, and its chi2. NaN if there is none.
  ContactEstimates alternative;
  double alternative_chi2 = std::numeric_limits<double>::quiet_NaN();
  /// Std of EstimatedForce of one contact; NaN where it was not computed. It is
  /// less than that of the normal force alone times sqrt(1 + mu^2) where an
  /// error of the friction coefficient goes into both.
  double force_std_N = std::numeric_limits<double>::quiet_NaN();
  /// With smoothing: the change of the contact since the frame before, in units
  /// of what the scene's smoothing says, squared, and what is expected of it,
  /// which is less than 2 because the solution takes for 0 what the readings do
  /// not tell (LogMarginal). 0 elsewhere.
  double change_chi2 = 0, change_dof = 0;
  /// By gauge, where they are estimated too (LogEstimator, LiveOffsets); else
  /// empty.
  std::vector<double> gauge_offset_V, gauge_offset_std_V;

  /// The probability that noise alone makes chi2 as large or larger, or where
  /// there is a model_chi2, that noise and model errors do. NaN without degrees
  /// of freedom.
  double p_value() const;

  /// Factor on the noise that the finger declares: sqrt(chi2 / dof), or that of
  /// model_chi2, if the p-value is below kUnexplained, else 1. Below it the
  /// declared noise does not explain the frame, and an unknown error of about
  /// this size is assumed.
  double noise_scale() const;
  /// The chi2 of both.
  double explained_chi2() const {
    return std::isnan(model_chi2) ? chi2 : model_chi2;
  }
  static constexpr double kUnexplained = 0.001;
  /// Says whether neither the finger nor its noise explains the frame: the
  /// p-value is below kUnexplained, or there are as many unknowns as readings
  /// and chi2, which is zero inside all bounds then, is above the same quantile
  /// for one degree of freedom.
  bool IsUnexplained() const;

  /// Takes the std of all contacts, before the errors of the calibration are
  /// added, for noise_scale() times their noise.
  void SetNoise();
  /// Sets the intervals of all contacts from their std and the valley.
  void SetIntervals(double length_mm);
};

/// Magnitude of the total force of all contacts in N, for comparison with a
/// reference sensor. NaN if the frame is not solved. The coefficient counts
/// where the frame has no friction of its own.
double EstimatedForce(const FrameEstimate& estimate,
                      double friction_coefficient);

/// Std of EstimatedForce: force_std_N, or else the sum of those of its parts,
/// which it is at most.
double EstimatedForceStd(const FrameEstimate& estimate,
                         double friction_coefficient);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_FRAME_ESTIMATE_H_

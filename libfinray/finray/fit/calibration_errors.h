#ifndef FINRAY_FIT_CALIBRATION_ERRORS_H_
#define FINRAY_FIT_CALIBRATION_ERRORS_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "finray/finger/known_friction.h"
#include "finray/fit/row_frames.h"

namespace finray {

/// Computes the covariance that errors of a finger's parameters p add to the
/// contacts x = (l_c, f_c of each) of a frame. An estimate minimises the blocks
/// r(x, p) of its row (frame_blocks.h), so that up to terms proportional to r
///
///   dx/dp = -(E'E)^-1 E'C,   C_sys = (dx/dp) C_pp (dx/dp)',
///
/// with E and C the derivatives of r by x and p (LinearizedFrame) and C_pp the
/// covariance of the finger's `calibration`. The share of creep counts as for a
/// gauge that has come to rest; its time constant and the hysteresis count as
/// known. What the model misses otherwise, the finger's `discrepancy` S of the
/// gauge angles, adds (E'E)^-1 E'A S A'E (E'E)^-1, with A the derivatives by
/// the angles.
///
/// An estimate's covariance is C_sys plus that of the noise, (E'E)^-1. Noise
/// differs from frame to frame, while parameter errors are the same in all
/// frames. Averaging frames therefore does not reduce C_sys.
///
/// Where the friction of the contacts has a std, it is one more parameter
/// (ForFriction).
class CalibrationErrors {
 public:
  /// kNone: every linearisation solves an equilibrium.
  enum class Surface { kMade, kNone };
  /// For a finger without a covariance and a friction without a std the object
  /// is empty: it solves and stores nothing.
  CalibrationErrors(const Finger& finger, const Scene& scene,
                    const Discretization& discretization,
                    Surface surface = Surface::kMade);
  ~CalibrationErrors();
  /// Both share the surface.
  CalibrationErrors(const CalibrationErrors& other);
  CalibrationErrors& operator=(const CalibrationErrors&) = delete;

  /// Replaces the covariance and the discrepancy by those of another
  /// calibration of the same parameters. Do not call it when empty.
  void SetErrors(const ParameterCovariance& calibration);

  bool empty() const { return model_ == nullptr; }
  /// Makes what a contact would make when it first needs it.
  void Prepare() const;

  // Do not call these when empty, nor from two threads at once. The contacts,
  // up to two of them on the front beam, have one friction.

  /// C_sys at the contacts of a row. The diagonal is infinite if the
  /// measurements do not determine the contacts (for example without force).
  /// For one contact, it solves no equilibrium where the surface serves, and it
  /// allocates nothing once it is warm.
  ContactMatrix Of(const std::vector<PointContact>& contacts,
                   const Measurements& row);

  /// The variance of the whole force F = f_c sqrt(1 + mu^2) from the last call
  /// of Of() with one contact. An error of mu is in both factors.
  double whole_force_variance_N2() const { return whole_force_variance_N2_; }

  /// The least chi2 of as many contacts near a solution, or of none, with
  /// parameters that may be off as the calibration says. Linear in both,
  ///
  ///   min over x of (r + E x)' (1 + C C_pp C' + A S A')^-1 (r + E x).
  ///
  /// Infinite without an equilibrium.
  double Chi2(const std::vector<PointContact>& contacts,
              const Measurements& row);

  /// The row at its contacts; null without an equilibrium.
  const LinearizedFrame* Linearize(const std::vector<PointContact>& contacts,
                                   const Measurements& row);
  /// C of the last Linearize, by the parameters of the calibration.
  Eigen::MatrixXd ByParameter() const;

 private:
  struct Model;
  void FindWholeForce(const PointContact& contact);
  Eigen::MatrixXd ByAngle() const;                                 // A
  void SetDiscrepancy(const std::vector<PointContact>& contacts);  // S

  std::unique_ptr<Model> model_;
  double whole_force_variance_N2_ = 0;
};

}  // namespace finray

#endif  // FINRAY_FIT_CALIBRATION_ERRORS_H_

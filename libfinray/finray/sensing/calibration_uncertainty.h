#ifndef FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_
#define FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/finger/known_friction.h"
#include "finray/fit/contact_covariance.h"
#include "finray/sensing/sensitivity_table.h"

namespace finray {

/// The covariance C_sys that errors of a finger's parameters p cause in
/// estimated contacts x = (l_c, f_c of each contact). An estimate is
///
///   x = argmin sum_j w_j^2 r_j^2,   r_j = s_j(x, p) - (V_j - o_j) / g_j.
///
/// Up to terms proportional to the residuals this gives
///
///   dx/dp = -(J'WJ)^-1 J'W dr/dp,   C_sys = (dx/dp) C_pp (dx/dp)',
///
/// with J = ds/dx, W = diag(w_j^2) and C_pp the finger's `calibration`. dr_j/dp
/// is ds_j/dp for stiffness, rib lengths and places of gauges, (V_j - o_j) /
/// g_j^2 for gain j and 1 / g_j for offset j. A gauge with a curve has its
/// slope where these have g_j, and g_j a_j^2 / slope for the curvature. The
/// share of creep counts as for a gauge that has come to rest; its time
/// constant and the hysteresis count as known. A measured circle's centre adds
/// two rows to r, which also depend on stiffness and rib lengths.
///
/// What the model misses otherwise, the finger's `discrepancy` S of the gauge
/// angles, adds (J'WJ)^-1 J'W S W J (J'WJ)^-1 to C_sys.
///
/// An estimate's covariance is C_sys plus that of the noise, (J'WJ)^-1. Noise
/// differs from frame to frame, while parameter errors are the same in all
/// frames. Averaging frames therefore does not reduce C_sys.
///
/// Where the friction of the contacts has a std, it is one more parameter
/// (ForFriction).
///
/// An estimator creates one CalibrationUncertainty from its finger, the scene's
/// friction and the radius of a measured circle, and calls Of() with each
/// solution. For one contact the derivatives come from a table, without a solve
/// or an allocation. For two contacts, for forces beyond the table and without
/// a table, the equilibrium is solved again.
class CalibrationUncertainty {
 public:
  /// kNone: Of() solves every equilibrium.
  enum class Table { kMade, kNone };
  /// Creates the table with `solver`, which is then as after Reset(). A table
  /// takes as long as some hundred solves. For a finger without a covariance
  /// and a friction without a std the object is empty: it solves and stores
  /// nothing.
  CalibrationUncertainty(const Finger& finger, const KnownFriction& friction,
                         EquilibriumSolver* solver,
                         std::optional<double> circle_radius_mm = std::nullopt,
                         Table table = Table::kMade);

  /// Replaces the covariance and the discrepancy by those of another
  /// calibration of the same parameters. Do not call it when empty.
  void SetErrors(const ParameterCovariance& calibration);

  bool empty() const { return !model_.has_value(); }

  /// C_sys at a solution of one or two contacts on the front beam, or one
  /// contact with a circle. `weights` are those of ContactFit::Fit, one per
  /// gauge and two more for a circle; the reading of a gauge with weight 0 is
  /// ignored. The diagonal is infinite if the measurements do not determine the
  /// contacts (for example without force). Do not call it when empty, nor from
  /// two threads at once.
  ContactMatrix Of(const std::vector<PointContact>& contacts,
                   const std::vector<double>& readings_V,
                   const Eigen::VectorXd& weights);

  /// The variance of the whole force F = f_c sqrt(1 + mu^2) from the last call
  /// of Of() with one contact. An error of mu is in both factors.
  double whole_force_variance_N2() const { return whole_force_variance_N2_; }

  /// The least chi2 of as many contacts near a solution, or of none, with
  /// parameters that may be off as the calibration says. Linear in both,
  ///
  ///   min over x of (r + J x)' (W^-1 + D C_pp D' + S)^-1 (r + J x),
  ///   D = dr/dp,
  ///
  /// where r are the residuals of the gauge angles in rad. Infinite without an
  /// equilibrium. It solves one and allocates; use it for rare frames only, and
  /// not with a measured circle.
  double Chi2(const std::vector<PointContact>& contacts,
              const std::vector<double>& readings_V,
              const Eigen::VectorXd& weights);

  /// The gauge angles at a solution, in rad.
  struct GaugeErrors {
    Eigen::VectorXd error;       ///< r, predicted less read; 0 without reading.
    Eigen::MatrixXd by_contact;  ///< J, by l_c and f_c of each contact.
    Eigen::MatrixXd by_factor;   ///< D F with F F' = C_pp.
  };
  /// Empty without an equilibrium. As Chi2, for rare frames only.
  std::optional<GaugeErrors> ErrorsAt(const std::vector<PointContact>& contacts,
                                      const std::vector<double>& readings_V,
                                      const Eigen::VectorXd& weights);

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                             2 * kFittedContacts, Eigen::Dynamic>;
  struct Model {
    Model(const Finger& finger, const KnownFriction& friction,
          std::optional<double> circle_radius_mm, EquilibriumSolver* solver,
          Table with_table);

    Finger finger;
    KnownFriction friction;
    bool of_calibration = false;  // the friction is that of the calibration
    std::optional<double> circle_radius_mm;
    EquilibriumSolver solver;  // for contacts beyond the table
    bool gauge_places;         // among the parameters
    std::optional<SensitivityTable> table;
    Eigen::MatrixXd factor;  // of C_pp
    // Work space: the matrix of ReadSensitivities; J with weights; (J'WJ)^-1
    // J'W; dx/dp; dx/dp times the factor.
    Eigen::MatrixXd derivatives, slope;
    Rows by_measured, by_parameter, by_factor;
    // S at the contacts; dx/d(angles) times S.
    Eigen::MatrixXd discrepancy;
    Rows by_discrepancy;
  };

  bool FindDerivatives(const std::vector<PointContact>& contacts);
  void FindDiscrepancy(const std::vector<PointContact>& contacts);
  void FindWholeForce(const PointContact& contact);
  bool has_discrepancy() const {
    return model_->finger.calibration->discrepancy.has_value();
  }
  void FillByParameter(int unknowns, const std::vector<double>& readings_V,
                       const Eigen::VectorXd& weights);
  // Says what the gauge angles change by with each calibrated parameter k:
  // by_statics(k, i), a column of the derivatives, i counted from behind those
  // by contacts; or by_gauge(k, gauge, dr/dp), one gauge alone.
  template <class ByStatics, class ByGauge>
  void ForEachParameter(const std::vector<double>& readings_V,
                        const Eigen::VectorXd& weights,
                        const ByStatics& by_statics,
                        const ByGauge& by_gauge) const;

  std::optional<Model> model_;
  double whole_force_variance_N2_ = 0;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_

#ifndef FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_
#define FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/sensing/contact_covariance.h"
#include "finray/sensing/sensitivity_table.h"

namespace finray {

/// What the errors of a finger's parameters p do to estimated contacts
/// x = (l_c, f_c of each contact). From
///
///   x = argmin sum_j w_j^2 r_j^2,   r_j = s_j(x, p) - (V_j - o_j) / g_j
///
/// follows, but for terms in proportion to the residuals,
///
///   dx/dp = -(J'WJ)^-1 J'W dr/dp,   C_sys = (dx/dp) C_pp (dx/dp)',
///
/// with J = ds/dx, W = diag(w_j^2) and dr_j/dp = ds_j/dp for stiffness and rib
/// lengths, (V_j - o_j) / g_j^2 for gain j, 1 / g_j for offset j; C_pp is the
/// finger's `calibration`. A measured circle's centre adds two rows to r, which
/// depend on stiffness and rib lengths likewise. The covariance of an estimate
/// is that of the noise, (J'WJ)^-1, plus C_sys. Noise differs from frame to
/// frame; these errors are the same in all, so that averaging frames does not
/// reduce C_sys.
///
/// An estimator makes one from its finger, its scene's friction and, if it
/// measures a circle, its radius, and calls Of() with each solution. For one
/// contact the derivatives come from a table: that takes no equilibrium and no
/// memory. Two contacts, and forces beyond the table, are solved once more.
class CalibrationUncertainty {
 public:
  /// Empty for a finger without a covariance: nothing is solved or kept then.
  /// The table is made with the `solver`, which is left as after Reset().
  CalibrationUncertainty(const Finger& finger, double friction,
                         EquilibriumSolver* solver,
                         std::optional<double> circle_radius_mm = std::nullopt);

  bool empty() const { return !model_.has_value(); }

  /// C_sys at a solution of one or two contacts on the front beam, one with a
  /// circle. `weights` are those of ContactFit::Fit: 0 where a gauge was not
  /// used, whose reading is not looked at, and two more for a circle. Infinite
  /// on the diagonal where the measurements do not determine the contacts (as
  /// without force). Not to be called when empty, nor from two threads at once.
  ContactMatrix Of(const std::vector<PointContact>& contacts,
                   const std::vector<double>& readings_V,
                   const Eigen::VectorXd& weights);

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                             2 * kFittedContacts, Eigen::Dynamic>;
  struct Model {
    Model(const Finger& finger, double friction,
          std::optional<double> circle_radius_mm, EquilibriumSolver* solver);

    Finger finger;
    std::optional<double> circle_radius_mm;
    EquilibriumSolver solver;  // for what the table does not hold
    SensitivityTable table;
    Eigen::MatrixXd factor;  // of C_pp
    // Work: ReadSensitivities; J with weights; (J'WJ)^-1 J'W; dx/dp; the same
    // times the factor.
    Eigen::MatrixXd derivatives, slope;
    Rows by_measured, by_parameter, by_factor;
  };

  bool FindDerivatives(const std::vector<PointContact>& contacts);
  void FillByParameter(int unknowns, const std::vector<double>& readings_V,
                       const Eigen::VectorXd& weights);

  std::optional<Model> model_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_CALIBRATION_UNCERTAINTY_H_

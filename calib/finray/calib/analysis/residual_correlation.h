#ifndef FINRAY_CALIB_ANALYSIS_RESIDUAL_CORRELATION_H_
#define FINRAY_CALIB_ANALYSIS_RESIDUAL_CORRELATION_H_

#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// Tells how many independent numbers a series is worth, from
///
///   Gamma_k = sum_t r_t r_{t+k},   rho_k = Gamma_k / Gamma_0,
///   tau = (1 + 2 sum_{k=1}^{M} rho_k) / (1 - (2 M + 1) / n),
///
/// with the smallest M >= 5 tau, but at most n / 4. The denominator makes up
/// for what a fit takes off the slowest part. n / tau residuals without
/// correlation would tell as much.
struct IntegratedTime {
  int n = 0;
  double lag_1 = 0;  ///< rho_1
  double tau = 1;    ///< In rows, at least 1.
  double p_value =
      1;  ///< that white noise has such rho_k (Ljung and Box), k <= 10

  double effective() const { return n / tau; }
};
/// Computes it for one series over several logs. Only rows of the same log are
/// neighbours.
IntegratedTime IntegrateTime(const std::vector<std::vector<double>>& logs);

/// Tells whether the residuals of a log rise and fall slowly, and how that
/// changes the std. The influence of frame t on the parameters is
///
///   psi_t = C J_t' r_t,
///
/// where J_t holds the rows of the frame with the contact eliminated, and theta
/// - truth = -sum_t psi_t. If the residuals are white and have the stated std,
/// this sum has the variance C S C. If they are correlated, its variance is V_i
/// times that,
///
///   V_i = tau_i sum_t psi_t,i^2 / (C S C)_ii, at least 1,
///
/// with tau_i of the series psi_t,i. So an offset that drifts widens the std of
/// parameters that depend on that offset, but not of those that loads in random
/// order determine. The part of the variance that comes from priors stays:
/// var_i = C_ii + (V_i - 1) (C S C)_ii.
struct ResidualCorrelation {
  /// The std are enlarged if the probability that all series are white is below
  /// this, with allowance for the number of tests.
  static constexpr double kSignificant = 1e-3;

  struct Series {
    int log;
    ResidualFamily family;
    int gauge;  ///< The gauge of kGauge.
    /// The index of the residual in its family and frame. Pins count as x, y of
    /// rib 1 front, rib 1 back, rib 2 front, ...
    int component;
    IntegratedTime time;
  };
  std::vector<Series> series;  ///< Series of 20 rows or more.
  double p_value = 1;
  /// sqrt(var_i / C_ii) of each free parameter. All are 1 if residuals are
  /// white and have the stated std.
  std::vector<double> enlargement;

  /// Residuals of a family are larger than their std say if chi2 exceeds its
  /// degrees of freedom by kLoud std of chi2 and by the share kLoudShare. The
  /// std are then enlarged by the same formula, with tau = 1 if residuals are
  /// white.
  static constexpr double kLoud = 4, kLoudShare = 0.1;
  bool loud = false;

  bool correlated() const { return p_value < kSignificant; }
  bool enlarges() const { return correlated() || loud; }
  /// The series with the longest time; null if there is none.
  const Series* Slowest() const;
};

ResidualCorrelation AnalyzeResidualCorrelation(const CalibrationLogs& logs,
                                               const Linearization& at_solution,
                                               const Identifiability& found);

/// Multiplies the std, if they are to be enlarged. Correlations stay.
void EnlargeStd(const ResidualCorrelation& by, Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_RESIDUAL_CORRELATION_H_

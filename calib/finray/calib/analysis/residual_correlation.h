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
/// with the smallest M >= 5 tau, n / 4 at most. The denominator makes up for
/// what a fit takes off the slowest part. n / tau residuals without
/// correlation would tell as much.
struct IntegratedTime {
  int n = 0;
  double lag_1 = 0;  ///< rho_1
  double tau = 1;    ///< in rows, at least 1
  double p_value =
      1;  ///< that white noise has such rho_k (Ljung and Box), k <= 10

  double effective() const { return n / tau; }
};
/// For one series over several logs; only rows of a log are neighbours.
IntegratedTime IntegrateTime(const std::vector<std::vector<double>>& logs);

/// Tells if the residuals of a log rise and fall slowly, and what that does to
/// the std. The influence of frame t on parameter i is
///
///   psi_t = C J_t' r_t,   J_t = its rows with the contact eliminated,
///
/// and theta - truth = -sum_t psi_t. White residuals of the stated std give the
/// sum a variance of C S C. Of correlated ones it is V_i times that,
///
///   V_i = tau_i sum_t psi_t,i^2 / (C S C)_ii, at least 1,
///
/// with tau_i of psi_t,i. So an offset that drifts widens what rides on that
/// offset, not what is told by loads at random. The part of the variance that
/// priors bring stays: var_i = C_ii + (V_i - 1) (C S C)_ii.
struct ResidualCorrelation {
  /// All series are white with a probability below this, several tests
  /// allowed for: then std are enlarged.
  static constexpr double kSignificant = 1e-3;

  struct Series {
    int log;
    ResidualFamily family;
    int gauge;  ///< for kGauge
    /// Counts the residuals of one family in a frame. Pins count as x, y of rib
    /// 1 front, rib 1 back, rib 2 front, ...
    int component;
    IntegratedTime time;
  };
  std::vector<Series> series;  ///< those of 20 rows or more
  double p_value = 1;
  /// Per free parameter: sqrt(var_i / C_ii), and its own tau_i. All 1 for white
  /// residuals of the stated std.
  std::vector<double> enlargement, tau;

  /// Residuals of some kind are larger than their std say: chi2 is beyond its
  /// dof by kLoud std of its own and by kLoudShare. Std are then enlarged by
  /// the same formula, with tau = 1 if residuals are white.
  static constexpr double kLoud = 4, kLoudShare = 0.1;
  bool loud = false;

  bool correlated() const { return p_value < kSignificant; }
  bool enlarges() const { return correlated() || loud; }
  /// The one of the longest time; nullptr if there is none.
  const Series* Slowest() const;
};

ResidualCorrelation AnalyzeResidualCorrelation(const CalibrationLogs& logs,
                                               const Linearization& at_solution,
                                               const Identifiability& found);

/// Multiplies the std; correlations stay.
void EnlargeStd(const ResidualCorrelation& by, Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_RESIDUAL_CORRELATION_H_

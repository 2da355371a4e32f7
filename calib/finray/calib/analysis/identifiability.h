#ifndef FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_
#define FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

enum class ParameterStatus {
  kEstimated,       ///< the data say more than the prior
  kPriorDominated,  ///< the prior says more than the data
  kUnidentifiable,  ///< the data say nothing about it, alone or in a
                    ///< combination, or less than a prior that is only a guess
  kFixed,
};
const char* ParameterStatusName(ParameterStatus status);

/// A combination of parameters that the data determine badly.
struct WeakDirection {
  /// Std that the data alone leave along it, in units of the priors (of the
  /// scales where there is none).
  double std_over_prior;
  bool null;  ///< the data say nothing along it: below Identifiability::kNull
  struct Component {
    int parameter;  ///< index into CalibrationParameters::all()
    double share;   ///< of the unit vector
  };
  std::vector<Component> components;  ///< largest first
  Eigen::VectorXd direction;          ///< over the free ones, a unit vector
  std::string words;
  std::string how_far;  ///< what the data leave, in words
  std::string remedy;   ///< by AdviseNextFrames
};

/// Tells what the data determine, from the reduced information matrix
///
///   S = sum over frames of C'C - C'E (E'E)^-1 E'C,
///
/// in which the contacts have been eliminated, scaled by the prior std.
/// Along eigenvectors with eigenvalues below 1 the data say less than the
/// priors; along those below kNull they say nothing. If the gains' ratios are
/// known, but all gains together only as well as stiffness is, that is a weak
/// direction too, whatever the priors. The covariance is (S + P)^-1 with P the
/// priors' information, a pseudo-inverse where even that is singular.
struct Identifiability {
  static constexpr double kNull = 1e-4;

  std::vector<double> std;  ///< of the variable of each free parameter
  /// The same, but finite: what the data say nothing of, and no prior, has
  /// 1 / kNull of its scale.
  std::vector<double> bounded_std;
  std::vector<ParameterStatus> status;  ///< one per free parameter
  Eigen::MatrixXd correlation;          ///< free x free
  /// S and P, of variables in these units: prior std, or scale where there is
  /// none.
  Eigen::MatrixXd information, prior;
  Eigen::VectorXd unit;
  std::vector<WeakDirection> weak;

  struct Noise {
    int residuals = 0;
    double dof = 0;  ///< residuals less what was fitted to them
    double chi2 = 0;
  };
  std::array<Noise, kResidualFamilies> noise;
};

/// (S + P)^-1 of a scaled information matrix, what is not determined being left
/// 1 / kNull of its unit.
Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information);

Identifiability AnalyzeIdentifiability(CalibrationProblem* problem,
                                       const Linearization& at_solution);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_

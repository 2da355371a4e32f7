#ifndef FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_
#define FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

enum class ParameterStatus {
  kEstimated,  ///< The data say more than the prior.
  /// Priors say more than the data: its own, or those of parameters that go
  /// with it, as a force sensor's scale goes with the stiffness.
  kPriorDominated,
  /// Nothing is known of the parameter but what is only a guess: the data say
  /// nothing, alone or in a combination, or less than such a prior, and no
  /// other prior determines it.
  kUnidentifiable,
  kFixed,
};
const char* ParameterStatusName(ParameterStatus status);

/// A combination of parameters that the data determine badly.
struct WeakDirection {
  /// The std that the data alone leave along the direction, in units of the
  /// priors, or of the scales where there is none. It is infinite if the data
  /// say nothing along it (Identifiability::kNull).
  double std_over_prior;
  struct Component {
    int parameter;  ///< Index into CalibrationParameters::all().
    double share;   ///< Its entry of the unit vector.
  };
  std::vector<Component> components;  ///< The largest share comes first.
  Eigen::VectorXd direction;          ///< A unit vector over the free ones.
  std::string words;
  std::string how_far;  ///< What the data leave, in words.
  std::string remedy;   ///< AdviseNextFrames sets it.
};

/// Says whether priors that are knowledge determine the direction: with the
/// status of the free parameters, none of its components is kUnidentifiable.
bool IsHeld(const WeakDirection& direction,
            const std::vector<ParameterStatus>& status);

/// The words of the weak direction in which all gains are the unknown.
constexpr char kGainsAgainstStiffness[] =
    "all gauge gains scale together against front and back stiffness";

/// Tells what the data determine. It comes from the reduced information matrix
///
///   S = sum over frames of C'C - C'E (E'E)^-1 E'C,
///
/// in which the contacts are eliminated, scaled by the std of the priors. Along
/// an eigenvector with an eigenvalue below 1 the data say less than the priors;
/// along one below kNull they say nothing. A parameter that the data do not
/// determine is judged again with S + K, where K is the information of the
/// priors that are knowledge (CalibrationParameter::vague_std). There is one
/// more weak direction, whatever the priors: if the ratios of the gains are
/// known, but all gains together only as well as stiffness is. The covariance
/// is (S + P)^-1 with the information P of the priors, or a pseudo-inverse if
/// even S + P is singular.
struct Identifiability {
  static constexpr double kNull = 1e-4;

  std::vector<double> std;  ///< Of the variable of each free parameter.
  /// The same, but finite: a parameter about which neither data nor prior say
  /// anything has 1 / sqrt(kLeastInformation) of its scale.
  std::vector<double> bounded_std;
  /// One for each free parameter, by these data. FindUnsupported withdraws that
  /// of parameters which only look estimated.
  std::vector<ParameterStatus> status;
  Eigen::MatrixXd correlation;  ///< Free x free parameters.
  /// (S + P)^-1 in the units of S and P, by BoundedCovariance.
  Eigen::MatrixXd covariance;
  /// S and P of the variables in these units: the std of the prior, or the
  /// scale if there is none.
  Eigen::MatrixXd information, prior;
  Eigen::VectorXd unit;
  std::vector<WeakDirection> weak;
  /// The unit vector along which the data say least.
  Eigen::VectorXd weakest;

  struct Noise {
    int residuals = 0;
    double dof = 0;  ///< Residuals less what was fitted to them.
    double chi2 = 0;

    /// Says that the stated std is too large: chi2 / dof is below kTooQuiet,
    /// and honest noise makes it so in less than one of 10^4 calibrations, by
    /// the cube root of Wilson and Hilferty.
    bool IsTooQuiet() const;
    static constexpr double kEnoughDof = 5, kTooQuiet = 0.5, kSurely = 3.72;
  };
  std::array<Noise, kResidualFamilies> noise;
  bool touches = false;  ///< Says whether there are frames with contact.
};

/// Chi2 and degrees of freedom of all residuals. A family may have fewer of
/// these than were fitted to it; the others have more then.
struct TotalChi2 {
  double chi2 = 0, dof = 0;

  static TotalChi2 Of(const Identifiability& found);
  /// In std of chi2.
  double Excess() const { return (chi2 - dof) / std::sqrt(2 * dof); }
  /// Says that noise does not make so much.
  bool IsLoud() const { return dof >= 1 && Excess() >= kLoudStd; }
  static constexpr double kLoudStd = 4;
};

Identifiability AnalyzeIdentifiability(CalibrationProblem* problem,
                                       const Linearization& at_solution);

/// Gives the calibrated finger the part of the covariance that belongs to its
/// own parameters. If the origin of the object is free too, that is their
/// marginal covariance. Parameters that were fixed keep the std and
/// correlations that an earlier calibration has left; their correlations with
/// the others are not known and count as 0.
void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_IDENTIFIABILITY_H_

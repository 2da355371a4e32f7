#ifndef FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
#define FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Predicts what to record next. S and P are those of the logs
/// (Identifiability). J holds the derivatives of the residuals of one more
/// frame, which the calibrated finger predicts, with its contact eliminated. n
/// such frames leave the covariance
///
///   C' = (S + P + n J'J)^-1.
///
/// The candidates are free frames and contact frames at several heights and
/// loads, all at one height or spread over all heights. Contact frames have the
/// measurements of the logs, alone or with those that the logs lack (force,
/// centre of the object, contact location). A candidate is judged by the std
/// along a weak direction v: sqrt(v' C' v) against sqrt(v' C v).
struct FrameAdvice {
  static constexpr int kFrames = 20;

  bool free = false;
  /// The advice is not to record frames but to find the gains elsewhere, where
  /// gains and other parameters move together.
  bool known_gains = false;
  double contact_mm = 0;  ///< NaN if the frames spread over all heights.
  double normal_N = 0;
  /// The measurements that the logs do not have.
  std::vector<ResidualFamily> added;
  double std_before = 0, std_after = 0;  ///< Along v, in units of the priors.
  /// The std of the parameter with the largest share in v, in its unit. It is
  /// infinite if the data say nothing and there is no prior.
  int parameter = 0;  ///< Index into CalibrationParameters::all().
  double parameter_std_before = 0, parameter_std_after = 0;
  std::string words;

  double ratio() const { return std_after / std_before; }
};

/// Holds the predicted frames, for advice on one direction after the other.
class NextFrames {
 public:
  NextFrames(CalibrationProblem* problem, const CalibrationSolution& solution,
             const Identifiability& found);

  /// Returns the best few pieces of advice, the best one first. Each set of
  /// measurements has its best place and load, if these shrink the std along
  /// `direction` to 90 % or less. `direction` is a unit vector over the free
  /// parameters, in units of Identifiability. An added measurement is named
  /// only if it helps more than the same frames without it.
  std::vector<FrameAdvice> Best(const Eigen::VectorXd& direction) const;

  /// The direction that the data determine worst.
  Eigen::VectorXd WorstDirection() const;

 private:
  // One predicted frame, with a row for each residual.
  struct Candidate {
    bool free;
    double contact_mm, normal_N;
    std::vector<ResidualFamily> families;  // one for each row
    Eigen::MatrixXd by_parameter;          // in units of Identifiability
    Eigen::Matrix<double, Eigen::Dynamic, 2> by_contact;
  };
  using Families = std::vector<ResidualFamily>;
  // A set of measurements of contact frames.
  struct Measured {
    Families all, added;
  };

  void Predict(const Contacts& contacts);
  void ChooseMeasurements(const Linearization& at_solution);
  Eigen::MatrixXd Information(const Candidate& candidate,
                              const Families& measured) const;
  FrameAdvice BestWith(const Measured& measured,
                       const Eigen::VectorXd& direction) const;
  std::optional<FrameAdvice> KnownGains(const Eigen::VectorXd& direction) const;
  void Judge(const Eigen::MatrixXd& information,
             const Eigen::VectorXd& direction, FrameAdvice* advice) const;
  void Spread(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after,
              const Eigen::VectorXd& direction,
              const std::vector<int>& parameters, FrameAdvice* advice) const;

  CalibrationProblem* problem_;
  const Identifiability& found_;
  std::vector<double> arcs_mm_, forces_N_;
  std::vector<Candidate> candidates_;
  std::vector<Measured> measured_;
};

/// Says the advice in words, e.g. "20 frames at 98 mm with 6 N would shrink the
/// std of front stiffness from 12 % to 4 %".
std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice);

/// Returns the advice on the worst direction. Sets the remedy of each weak
/// direction to the first line of the advice on it.
std::vector<FrameAdvice> AdviseNextFrames(CalibrationProblem* problem,
                                          const CalibrationSolution& solution,
                                          Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

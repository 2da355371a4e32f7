#ifndef FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
#define FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Predicts what to record next. With S and P of the logs
/// (Identifiability) and J the derivatives of the residuals of one more frame,
/// predicted by the calibrated finger, its contact eliminated, n such frames
/// leave
///
///   C' = (S + P + n J'J)^-1.
///
/// Candidates are frames at several heights and loads, at one height or spread
/// over all, each with the measurements that the logs have and with those that
/// they lack (force, object's centre, contact location), and free frames. They
/// are judged by the std along a weak direction v, sqrt(v' C' v) against
/// sqrt(v' C v).
struct FrameAdvice {
  static constexpr int kFrames = 20;

  bool free = false;
  /// No frames: the same logs with the gains known from elsewhere, where gains
  /// and others move together.
  bool known_gains = false;
  double contact_mm = 0;  ///< NaN: spread over heights
  double normal_N = 0;
  /// The measurements besides the gauges.
  std::vector<ResidualFamily> measured;
  /// The ones that the logs do not have.
  std::vector<ResidualFamily> added;
  double std_before = 0, std_after = 0;  ///< along v, in units of the priors
  /// The std of the parameter with the largest share in v, in its unit.
  /// Infinite where the data say nothing and there is no prior.
  int parameter = 0;  ///< index into CalibrationParameters::all()
  double parameter_std_before = 0, parameter_std_after = 0;
  std::string words;

  double ratio() const { return std_after / std_before; }
};

/// The frames that were predicted, for advice on one direction after the other.
class NextFrames {
 public:
  NextFrames(CalibrationProblem* problem, const CalibrationSolution& solution,
             const Identifiability& found);

  /// The best few, best first: for each set of measurements the best place and
  /// load, as far as they shrink the std along `direction` (a unit vector over
  /// the free parameters, in units of Identifiability) to 90 % or less. An
  /// added measurement is named only if it helps more than the same frames
  /// without it.
  std::vector<FrameAdvice> Best(const Eigen::VectorXd& direction) const;

  /// The direction that the data determine worst.
  Eigen::VectorXd WorstDirection() const;

 private:
  // Rows of one predicted frame, by family.
  struct Candidate {
    bool free;
    double contact_mm, normal_N;
    std::vector<ResidualFamily> families;  // a row each
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

/// Advice on the worst direction; and the remedy of each weak direction, which
/// is the first line of the advice on it.
std::vector<FrameAdvice> AdviseNextFrames(CalibrationProblem* problem,
                                          const CalibrationSolution& solution,
                                          Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

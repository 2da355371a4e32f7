#ifndef FINRAY_CALIB_CALIBRATION_PROBLEM_H_
#define FINRAY_CALIB_CALIBRATION_PROBLEM_H_

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/calibration_log.h"
#include "finray/calib/contact_guess.h"
#include "finray/calib/parameters.h"
#include "finray/calib/plan.h"

namespace finray {

/// What a residual measures, for statistics.
enum class ResidualFamily {
  kGauge,
  kForce,
  kObject,
  kContact,
  kPin,
  kTip,
  kBench
};
constexpr int kResidualFamilies = 7;
const char* ResidualFamilyName(ResidualFamily family);

/// The least-squares problem of a calibration, in the reduced form: over all
/// frames that are not held out, gauge readings, reference force, object
/// centre, contact location, rib pins and tip, whichever a row has, and gauge
/// readings on the bench, in units of their std, plus the priors. Unknowns: the
/// free parameters, and l_c and f_c of each contact frame.
class CalibrationProblem {
 public:
  CalibrationProblem(const Finger& finger, const Plan& plan,
                     const CalibrationLogs& logs,
                     const Discretization& discretization, int threads);

  struct SolveReport {
    bool converged = false;
    int iterations = 0;
    double initial_cost = 0;
    double final_cost = 0;
    std::string message;
  };
  SolveReport Solve();

  /// Where offsets or origins are per log, gives those logs that are held out
  /// as a whole the ones of the last log that was fitted, and then the offsets
  /// that their free frames show of the finger as it is now: a lab zeroes its
  /// gauges too. To be called after Solve.
  void ZeroHeldOutLogs();

  /// One measurement residual and where it belongs.
  struct ResidualInfo {
    ResidualFamily family;
    int frame;  ///< index into logs().frames
    int gauge;  ///< for kGauge and kBench
  };
  /// Measurement residuals at the present values and their derivatives by the
  /// free parameters and by the frame unknowns: the rows of
  /// [C | E] with E block diagonal. Rows of a frame follow each other.
  struct Linearization {
    std::vector<ResidualInfo> rows;
    Eigen::VectorXd residuals;
    Eigen::MatrixXd by_parameter;  // rows x free parameters
    Eigen::Matrix<double, Eigen::Dynamic, 2> by_contact;  // rows x (l_c, f_c)
  };
  /// `robust`: weighted by the robust loss as the solver weights them.
  Linearization Linearize(bool robust);

  /// l_c and f_c of a frame; NaN for free and held-out frames.
  std::array<double, 2> contact(int frame) const;

  CalibrationParameters& parameters() { return parameters_; }
  const CalibrationLogs& logs() const { return logs_; }
  const Plan& plan() const { return plan_; }
  const Finger& finger() const { return finger_; }
  double gauge_std_V(int gauge) const {
    return plan_.gauge_std_V.value_or(finger_.gauges[gauge].noise_V);
  }

 private:
  void AddFrame(int index);
  void AddBenchFrame(int index);
  bool HasEnough(const CalibrationFrame& frame) const;
  void AddReadings(int index, const FrameEvaluation& evaluation,
                   const std::vector<double*>& model);
  void AddForce(int index, const FrameEvaluation& evaluation, double* contact,
                const std::vector<double*>& model);
  void AddPlace(int index, const FrameEvaluation& evaluation, double* contact,
                const std::vector<double*>& model);
  void AddPoints(int index, const FrameEvaluation& evaluation,
                 const std::vector<double*>& model);
  void AddMeasurement(ceres::CostFunction* cost, ResidualFamily family,
                      int frame, int gauge, const std::vector<double*>& blocks);
  void AddPriors();
  void GuessOffsets();
  void GuessContact(int index, double* contact, FrameEvaluation* evaluation);
  std::optional<ContactGuess::Place> GuessFromGauges(
      const CalibrationFrame& frame);
  void FixWhatIsNotFree();

  Finger finger_;
  Plan plan_;
  CalibrationLogs logs_;
  CalibrationParameters parameters_;
  Discretization discretization_;
  std::unique_ptr<ContactGuess> guess_;  // made when needed
  FrameSet frames_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> problem_;
  // In one piece and never moved: Ceres knows blocks by their addresses, and
  // eliminates them in that order.
  std::vector<std::array<double, 2>> contacts_;
  std::vector<int> contact_of_frame_;  // index into contacts_, or -1
  std::vector<ceres::ResidualBlockId> blocks_;
  std::vector<ResidualInfo> block_info_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_CALIBRATION_PROBLEM_H_

#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "finray/calib/problem/calibration_blocks.h"
#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/calib/problem/plan.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// The least-squares problem of a calibration: the logs, the present values of
/// the parameters, and which frames are fitted. Its cost is the cost of the
/// residual blocks that CalibrationBlocks makes for the fitted frames, plus
/// that of the priors. The unknowns are the free parameters, which are here,
/// and the contacts of the frames, which a ContactStore holds. The code in
/// solve/ finds both.
class CalibrationProblem {
 public:
  /// Throws InputError if no parameter is free or no frame can be fitted.
  CalibrationProblem(const Finger& finger, const Plan& plan,
                     CalibrationLogs logs, const Discretization& discretization,
                     int threads);
  CalibrationProblem(const CalibrationProblem&) = delete;

  /// Returns the problem of these frames alone, at the present values. It
  /// shares the logs and has parameters of its own, so several parts can be
  /// solved at the same time.
  std::unique_ptr<CalibrationProblem> Part(const std::vector<int>& frames,
                                           int threads) const;

  /// Returns the same frames under another plan, at the present values of all
  /// parameters that both plans have. It shares the logs, so what the other
  /// plan needs of them must be there. Frames that are rejected stay rejected.
  std::unique_ptr<CalibrationProblem> WithPlan(const Plan& plan) const;

  /// The frames that the model and the plan allow to fit. The fitted frames are
  /// those of them that are not rejected.
  const std::vector<int>& candidates() const { return candidates_; }
  std::vector<int> FittedFrames() const;
  /// Chooses about `most` fitted frames, evenly from every log. It chooses
  /// contact frames, free frames and rows of the bench separately, at least 50
  /// of each kind if there are so many.
  std::vector<int> SpreadFrames(std::size_t most) const;

  /// Rejects these frames and the impossible ones. All other candidates are
  /// fitted.
  void SetRejected(std::map<int, std::string> reasons);
  const std::map<int, std::string>& rejected() const { return rejected_; }
  /// Frames with a force above kImpossibleForce, in units of EI / l_0^2. No
  /// finger bends so far, and no start is so wrong. A solve with them would
  /// take minutes.
  const std::map<int, std::string>& impossible() const { return impossible_; }
  static constexpr double kImpossibleForce = 2000;

  /// Says whether a frame touches. No Part may be in use.
  void Decide(int frame, bool contact) {
    logs_->frames[frame].contact = contact;
  }

  /// Says that no contact frame has a reference. Contact frames are then not
  /// fitted.
  bool gauges_only() const { return gauges_only_; }

  /// CalibrationParameters::KeepHistory at the present values.
  bool KeepHistory(std::shared_ptr<const Eigen::MatrixXd> signals_V) {
    return parameters_.KeepHistory(std::move(signals_V), finger_, *logs_);
  }
  /// CalibrationParameters::KeepFriction at the present values.
  bool KeepFriction() {
    return parameters_.KeepFriction(finger_, plan_, *logs_, discretization_);
  }

  /// The values of the free parameters.
  Eigen::VectorXd Values() const;
  void SetValues(const Eigen::VectorXd& values);
  /// Sets stiffness, gains and rib lengths to those of `start`, and offsets to
  /// the readings of the free frames unless the plan fixes them. Priors stay.
  void StartFrom(const Finger& start);

  /// Receives a line whenever a solve has made a step, from any thread.
  using Progress = std::function<void(const std::string&)>;
  void TellProgress(Progress progress) { progress_ = std::move(progress); }
  void Tell(const std::string& step) const {
    if (progress_) progress_(step);
  }

  CalibrationParameters& parameters() { return parameters_; }
  const CalibrationParameters& parameters() const { return parameters_; }
  const CalibrationBlocks& blocks() const { return blocks_; }
  const CalibrationLogs& logs() const { return *logs_; }
  const CalibrationFrame& frame(int i) const { return logs_->frames[i]; }
  const Plan& plan() const { return plan_; }
  /// The families that the given plan frees and plan() fixes, because the times
  /// of the logs do not rise (row_times.h).
  const std::vector<ParameterFamily>& without_times() const {
    return without_times_;
  }
  const Finger& finger() const { return finger_; }
  /// The noise_V of each gauge in the given finger, which the plan's
  /// gauge_std_V replaces in finger().
  const std::vector<double>& given_noise_V() const { return given_noise_V_; }
  const Discretization& discretization() const { return discretization_; }
  int threads() const { return threads_; }

  /// A solve by all frames ends when the gradient by every parameter is below
  /// this, in standard deviations (SolveSummed). The minimum is then about as
  /// far away.
  double tolerance_std() const { return tolerance_std_; }
  void set_tolerance_std(double std) { tolerance_std_ = std; }

 private:
  // Makes a problem without candidates.
  CalibrationProblem(const Finger& finger, const Plan& plan,
                     std::shared_ptr<CalibrationLogs> logs,
                     const Discretization& discretization, int threads);
  void FindCandidates();

  Finger finger_;
  std::vector<double> given_noise_V_;
  Plan plan_;
  std::vector<ParameterFamily> without_times_;
  std::shared_ptr<CalibrationLogs> logs_;
  CalibrationParameters parameters_;
  Discretization discretization_;
  int threads_;
  double tolerance_std_ = 1e-2;
  CalibrationBlocks blocks_;
  bool gauges_only_ = false;
  std::vector<int> candidates_;
  std::map<int, std::string> rejected_, impossible_;
  Progress progress_;
};

/// Gives parameters of their own to logs that are held out as a whole, if
/// offsets or origins are per log. They get the values of the last log that was
/// fitted. Their free frames then correct the offsets, with the finger as it is
/// now: a lab zeroes its gauges too. Call it after a solve.
void ZeroHeldOutLogs(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_

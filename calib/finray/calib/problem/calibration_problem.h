#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_blocks.h"
#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/calib/problem/plan.h"
#include "finray/calib/solve/contact_guess.h"
#include "finray/calib/solve/frame_linearizer.h"
#include "finray/calib/solve/frame_sums.h"
#include "finray/calib/solve/joint_solve.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// The least-squares problem of a calibration, in the reduced form: over all
/// frames that are not held out or rejected, what CalibrationBlocks makes of
/// them, in units of their std, plus the priors. Unknowns: the free parameters,
/// and l_c and f_c of each contact frame.
class CalibrationProblem {
 public:
  CalibrationProblem(const Finger& finger, const Plan& plan,
                     CalibrationLogs logs, const Discretization& discretization,
                     int threads);
  CalibrationProblem(const CalibrationProblem&) = delete;

  /// From the present values, by JointSolve of all frames, or if there are more
  /// than kMostJoint, of some kJoint, evenly spread; from where that leads to,
  /// by SolveOn. The result does not depend on the number of threads.
  SolveReport Solve();
  /// From near the solution: of all frames by FrameSumResidual.
  SolveReport SolveOn();
  /// By JointSolve of all frames, however many.
  SolveReport SolveJointly(const JointSolve::Limits& limits);
  static constexpr std::size_t kMostJoint = 1000, kJoint = 500;
  bool few() const { return candidates_.size() <= kMostJoint; }

  /// Of very many frames some kMany, evenly spread, else none: from the
  /// solution of a few, that of these leaves one or two steps for all of them.
  std::vector<int> ManyFrames() const;
  SolveReport SolveMany();
  static constexpr std::size_t kMany = 20000;

  /// Some kSome frames, evenly spread; the joint solve of these alone, and
  /// what they and the priors say of the free parameters.
  std::vector<int> SomeFrames() const;
  SolveReport SolveSome(const JointSolve::Limits& limits);
  Eigen::MatrixXd InformationOfSome();
  static constexpr std::size_t kSome = 250;
  /// The problem of these frames alone, from the present values and contacts,
  /// for one thread: several can be solved at the same time.
  std::unique_ptr<CalibrationProblem> Part(
      const std::vector<int>& frames) const;
  /// All that could be fitted, rejected or not, if not impossible.
  const std::vector<int>& candidates() const { return candidates_; }

  /// Values and contacts, to come back to.
  struct Point {
    Eigen::VectorXd values;
    std::vector<std::array<double, 2>> contacts;
  };
  Point Save() const;
  void Restore(const Point& point);

  /// Of contacts by the finger as it is now.
  ContactGuess MakeGuess();

  /// Where to start from: stiffness, gains and rib lengths of `start`, contacts
  /// as they are with that finger. Offsets, unless fixed, are what free frames
  /// show. Priors stay.
  void StartFrom(const Finger& start);

  /// Where offsets or origins are per log, gives those logs that are held out
  /// as a whole the ones of the last log that was fitted, and then the offsets
  /// that their free frames show of the finger as it is now: a lab zeroes its
  /// gauges too. To be called after Solve.
  void ZeroHeldOutLogs();

  using Visitor = std::function<void(int frame, const LinearizedFrame&)>;
  /// Calls `visit` for each fitted frame in order, linearised at the present
  /// values. Throws std::runtime_error if one cannot be.
  void VisitFrames(const Visitor& visit);
  /// All of them. Computed once, and again after the parameters were changed
  /// through this class.
  const Linearization& AtSolution();

  /// Makes a first guess of these frames' contacts, where there is none yet.
  void GuessContacts(const std::vector<int>& frames, ContactGuess::From from);
  /// Calls `judge` for each of these frames in order, fitted or not, its
  /// contact put where it explains the frame best. No rows: it cannot be
  /// evaluated. What it says is good is summed up: if these are the frames that
  /// a solve by FrameSumResidual is of, that need not begin by doing so.
  using Judge = std::function<bool(int frame, const LinearizedFrame&)>;
  void FitContacts(const std::vector<int>& frames, const Judge& judge);
  /// The same where it explains most of the frame, by Cauchy's loss. What is
  /// kept of contacts is a new guess, from all but the force.
  void FitContactsRobustly(const std::vector<int>& frames,
                           const Visitor& visit);

  /// Frames to be left out, and why, beside those that are impossible; others
  /// that were come back.
  void SetRejected(std::map<int, std::string> reasons);
  const std::map<int, std::string>& rejected() const { return rejected_; }
  /// Frames with a force above kImpossibleForce, in EI / l_0^2: no finger bends
  /// so far and no start is so wrong. To solve for them would take minutes.
  const std::map<int, std::string>& impossible() const { return impossible_; }
  static constexpr double kImpossibleForce = 2000;

  /// Contact frames have no reference at all; they are then not fitted.
  bool gauges_only() const { return gauges_only_; }

  /// l_c and f_c of a frame; NaN for those without, and those not fitted.
  std::array<double, 2> contact(int frame) const;

  CalibrationParameters& parameters() { return parameters_; }
  const CalibrationLogs& logs() const { return *logs_; }
  const Plan& plan() const { return plan_; }
  const Finger& finger() const { return finger_; }
  const Discretization& discretization() const { return discretization_; }
  int threads() const { return threads_; }
  double gauge_std_V(int gauge) const { return blocks_.gauge_std_V(gauge); }

 private:
  // Without candidates.
  CalibrationProblem(const Finger& finger, const Plan& plan,
                     std::shared_ptr<const CalibrationLogs> logs,
                     const Discretization& discretization, int threads);
  void FitAllCandidates();
  // Of the free parameters.
  Eigen::VectorXd Values() const;
  void SetValues(const Eigen::VectorXd& values);
  std::vector<int> SpreadFrames(std::size_t most) const;
  SolveReport SolveJointly(const std::vector<int>& frames,
                           const JointSolve::Limits& limits);
  SolveReport SolveSummed(const std::vector<int>& frames,
                          double gradient_tolerance);
  void BeginSum(std::size_t most_frames, FrameSums* sums);
  void AddToSum(int frame, const LinearizedFrame& at, FrameSums* sums);
  bool Sum(const std::vector<int>& frames, const Eigen::VectorXd& at,
           FrameSums* sums);
  void MoveContacts(const Eigen::VectorXd& change);
  void MoveContact(int frame, const Eigen::Vector2d& move);
  // Calls `visit(frame, linearised)` in order after `prepare` has worked on the
  // frames in parallel; false if that fails for one.
  using Prepare = std::function<bool(int frame, FrameLinearizer* linearizer,
                                     LinearizedFrame* out)>;
  bool InParallel(const std::vector<int>& frames, const Plan& plan,
                  const Prepare& prepare, const Visitor& visit);
  LadderState* StateOf(int frame, LadderState* scratch);
  void GuessOffsets();

  Finger finger_;
  Plan plan_;
  std::shared_ptr<const CalibrationLogs> logs_;
  CalibrationParameters parameters_;
  Discretization discretization_;
  int threads_;
  CalibrationBlocks blocks_;
  EquilibriumSolver solver_;  // copied for each thread
  bool gauges_only_ = false;
  // Indices of frames that could be fitted, and those that are.
  std::vector<int> candidates_, fitted_;
  // By frame; the joint solve has them by their addresses.
  std::vector<std::array<double, 2>> contacts_;
  std::vector<LadderState> states_;            // empty if there are too many
  std::unique_ptr<const ContactGuess> guess_;  // then, for what is near
  // Of the last sum: its frames; by these, how contacts go with the parameters
  // (2 x free); where it was; and what it is in full, if over all frames.
  std::vector<int> summed_frames_;
  Eigen::MatrixXf contact_slopes_;
  Eigen::VectorXd summed_at_;
  std::unique_ptr<Linearization> summed_;
  // Of FitContacts over summed_frames_, at the present values.
  std::optional<FrameSums> start_;
  std::map<int, std::string> rejected_, impossible_;
  std::unique_ptr<Linearization> at_solution_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_PROBLEM_H_

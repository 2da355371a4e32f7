#ifndef FINRAY_ESTIMATION_LOG_PROBLEM_H_
#define FINRAY_ESTIMATION_LOG_PROBLEM_H_

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "finray/estimation/block_tridiagonal.h"
#include "finray/estimation/contact_search.h"
#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/log_prior.h"
#include "finray/estimation/walk_increments.h"
#include "finray/residuals/frame_blocks.h"
#include "finray/scene/scene.h"

namespace finray {

/// What a frame of a log brings into LogProblem, and its solution.
struct LogFrame {
  enum class Role {
    kFree,      ///< Its readings are those of the free finger.
    kTouching,  ///< It has a contact.
    kUnused,    ///< Nobody knows: its readings are left out.
  };

  Measurements row;
  Role role = Role::kUnused;
  /// A contact and offsets that have moved explain the frame alike.
  bool doubtful = false;
  double noise_scale = 1;           ///< Factor on the std of its measurements.
  double arc_mm = 0, normal_N = 0;  ///< Start, then solution, if it touches.
  /// Mean of the weak prior of the force.
  double expected_N = 0;
  Eigen::VectorXd offset_V;  ///< Start, then solution.
  LadderState state;         ///< An equilibrium near the contact.
  /// Of the solution: at the contact, at the tip, and of the ribs.
  Eigen::Vector3d pose, tip_pose;
  std::vector<double> rib_tension_N;
  /// Another contact that explains the frame within its noise, as
  /// ContactSearch::rival, and its chi2 above that of the first.
  struct Rival {
    ContactSolution contact;
    double more_chi2;
  };
  std::optional<Rival> rival;

  /// Takes the contact away: nobody knows whether there is one.
  void LeaveOpen() {
    role = Role::kUnused;
    doubtful = true;
  }
  /// Copies contact, poses and rib tensions of the solution, and the std of a
  /// covariance that ends with (l_c, f_c).
  void CopyTo(const Eigen::MatrixXd& covariance, FrameEstimate* estimate) const;
};

/// The offsets of a finger's gauges in V.
Eigen::VectorXd GaugeOffsets(const Finger& finger);

/// What a solution is worth, frame by frame.
struct LogMarginal {
  /// Of [offsets; l_c, f_c if it touches] given the whole problem.
  Eigen::MatrixXd covariance;
  /// Of the offsets given all but the frame's own readings.
  Eigen::MatrixXd offsets_without;
  /// Where these put the offsets: b + C A'r, with the frame's whitened
  /// residuals r and A = dr/db.
  Eigen::VectorXd mean_without;
  /// The frame's readings against those offsets: r'r + (A'r)'C(A'r). Degrees of
  /// freedom: as many as gauges, less two for a contact.
  double chi2 = 0;
  /// Of the change d since the contact of the frame before, with smoothing q by
  /// unknown: the sum of (d / q)^2 and its expectation, the sum of
  /// 1 - var(d) / q^2 with the variance that the whole problem leaves.
  double change_chi2 = 0, change_dof = 0;

  /// The std of (l_c, f_c) for known offsets. An error of an offset is common
  /// to the frames of a touch.
  Eigen::Vector2d StdGivenOffsets() const;
};

/// Contacts and gauge offsets of a stretch of a log in one sparse problem; for
/// FrameEstimator, which smooths contacts, and for LogEstimator:
///
///   MeasurementBlocks          each free or touching frame (Huber loss)
///   GaugeOffsetChangeResidual  each gauge, from frame to frame
///   ContactChangeResidual      from a contact to that of the next frame: as
///                              the scene's smoothing says, or else l_c by
///                              kContactWalk_mm where the offsets wander, or
///                              more in a long touch
///   ParameterPriorResidual     each contact, weak; where offsets wander, those
///                              of a touch count as one in the covariance
///   GaussianPriorResidual      on the first frame
///
/// Unknowns of a frame: an offset in V for each gauge, in blocks of size 1, if
/// the scene has a gauge_offset_walk, and (l_c, f_c) if it touches.
class LogProblem {
 public:
  /// Std of l_c in mm after a second of a touch. Where offsets wander, a light
  /// frame may look like a heavy touch near the tip; its neighbours tell. This
  /// is far more than what the readings leave open elsewhere.
  static constexpr double kContactWalk_mm = 5;

  /// `frames` must stay in place, one at least, times ascending. The result
  /// does not depend on `threads` as long as all frames have an equilibrium at
  /// every trial (FrameSet).
  LogProblem(const Finger& finger, const Scene& scene,
             const Discretization& discretization, int threads,
             std::vector<LogFrame>* frames, const LogPrior& prior);
  LogProblem(const LogProblem&) = delete;
  LogProblem& operator=(const LogProblem&) = delete;

  /// Solves, and writes the solution to the frames. Returns the number of
  /// iterations.
  int Solve();

  bool converged() const { return converged_; }

  /// At the solution.
  std::vector<LogMarginal> Marginals() const;

  /// Adds the increments of the offsets over the first `count` frames, at the
  /// solution with these marginals, if the scene has a gauge_offset_walk.
  void AddTo(WalkIncrements* walk, const std::vector<LogMarginal>& marginals,
             std::size_t count) const;

  /// What the frames before `frame` tell about it, at the solution; `frame` is
  /// above 0. As the prior of a problem that begins there it stands for them.
  LogPrior PriorOf(std::size_t frame) const;

 private:
  double* offsets(std::size_t t) { return &values_[t * stride_]; }
  double* contact(std::size_t t) { return offsets(t) + gauges_; }
  bool Touches(std::size_t t) const {
    return (*frames_)[t].role == LogFrame::Role::kTouching;
  }
  bool Linked(std::size_t t) const;
  void AddReadings(std::size_t t);
  void AddContactPrior(std::size_t t);
  void CountTouches();
  void AddLinks();
  std::vector<double> LeastSteps_mm();
  void AddLink(std::size_t t, double least_step_mm);
  void ShareContactPriors();
  void AddPrior(const LogPrior& prior);
  void FixWhatIsNotFree();
  void Linearize();
  BlockTridiagonal Information() const;
  void FindChanges(const BlockTridiagonal& all,
                   std::vector<LogMarginal>* marginals) const;
  int FreeOffsets() const {
    return scene_.gauge_offset_walk ? static_cast<int>(gauges_) : 0;
  }
  int Unknowns(std::size_t t) const {
    return FreeOffsets() + (Touches(t) ? 2 : 0);
  }

  Finger finger_;
  Scene scene_;
  std::vector<LogFrame>* frames_;
  std::size_t gauges_, stride_;
  std::vector<double> values_;  // offsets and contact of each frame, in order
  MeasurementModel model_;
  FingerParameters parameters_;
  FrameSet evaluations_;
  FrameEvaluation* free_;
  std::vector<FrameEvaluation*> evaluation_of_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<ceres::ResidualBlockId> prior_;
  std::vector<std::vector<ceres::ResidualBlockId>> readings_, links_,
      contact_priors_;
  // Where offsets wander, the touching frames between the free frames on both
  // sides of a frame; 1 elsewhere.
  std::vector<double> touch_frames_;
  bool converged_ = false;
  // At the solution. Rows: the prior, then of each frame its links to the one
  // before, its readings and the prior of its contact.
  ceres::CRSMatrix jacobian_;
  std::vector<double> residuals_;
  std::vector<int> links_end_, readings_end_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_LOG_PROBLEM_H_

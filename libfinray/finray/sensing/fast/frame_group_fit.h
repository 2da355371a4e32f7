#ifndef FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_
#define FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

#include <Eigen/Core>
#include <memory>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/finger/point_contact.h"
#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/sensing/gauge_surface.h"

namespace finray {

/// The result of fitting one contact to one frame.
struct FrameFit {
  bool converged = false;
  bool in_lanes = false;
  int iterations = 0;  ///< Number of linearisations.
  double arc_mm = 0, normal_N = 0;
  double chi2 = 0;
  Eigen::Matrix2d information;  ///< Fisher's, of (l_c, f_c) per mm and N.
  Eigen::Vector3d contact_pose, tip_pose;  ///< (x, y, theta), mm and rad.
  Eigen::VectorXd rib_tension_N;
};

/// Fits one contact to each frame of a log, several frames at a time in
/// vector lanes (FrameLanes), with the equations of ContactFit. A lane whose
/// frame has converged takes the next one of the log. Like ContactFit::Follow,
/// each frame starts from what the last linearisation predicts for its
/// readings. The last change of one frame and the prediction of the next use
/// the same linearisation and are combined into one step. A frame that
/// converges at once therefore costs its share of one linearisation and one
/// step.
///
/// Each lane has its own residuals, weights, changes, bounds and convergence.
/// Some frames do not suit the lanes. ContactFit fits them alone, from where
/// their lane stood:
/// - a frame that changes a lot, does not lower its chi2, or does not converge
///   in a few iterations;
/// - a frame whose contact lies in a third element, or beyond a gauge end that
///   the contacts of the other lanes have not reached.
///
/// Results depend on the state given to Start, the frames since then, how the
/// frames were divided into calls, and the number of lanes, to within the
/// tolerance. After the first calls nothing is allocated.
class FrameGroupFit {
 public:
  /// Makes one with `lanes` lanes. Throws InputError as LadderModel does, and
  /// std::invalid_argument if this machine cannot have so many: 4, and 8 where
  /// FrameLanes() is 8.
  static std::unique_ptr<FrameGroupFit> Make(
      const Finger& finger, const Discretization& discretization,
      double friction = 0, int lanes = FrameLanes());
  virtual ~FrameGroupFit() = default;

  /// Fits in lanes take the curvatures of the gauges from it and converge
  /// faster (GaugeReading::Change). It must outlive this and have the same
  /// finger and friction. Null: none.
  virtual void set_surface(const GaugeSurface* surface) = 0;

  /// The same as in ContactFit.
  virtual void set_tolerance(double relative) = 0;
  virtual void set_most_force(double force_N) = 0;

  /// Sets the start of the next frames: an equilibrium with a contact near
  /// theirs.
  virtual void Start(const LadderState& state, const PointContact& contact) = 0;

  /// Fits consecutive frames that follow the last one fitted, or Start. Each
  /// column of angles and weights is a frame; weights are per rad, 0 where not
  /// measured. All lanes finish before the call returns, so calls with many
  /// frames are faster. Single frames after Start are fitted alone. If a frame
  /// does not converge, the next one of its lane starts from where that frame
  /// started.
  virtual void Fit(const Eigen::Ref<const Eigen::MatrixXd>& angles_rad,
                   const Eigen::Ref<const Eigen::MatrixXd>& weights_per_rad,
                   FrameFit* fits) = 0;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

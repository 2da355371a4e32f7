#ifndef FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_
#define FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "finray/ladder/ladder_lanes.h"
#include "finray/sensing/fast/contact_fit.h"

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

/// Fits one contact to each frame of a log, four frames at a time in vector
/// lanes, with the equations of ContactFit. Lane k takes frames k, k + 4, k + 8
/// .. as fast as they converge, but no lane runs far ahead. Like
/// ContactFit::Follow, each frame starts from what the last linearisation
/// predicts for its readings. The last change of one frame and the prediction
/// of the next use the same linearisation and are combined into one step. A
/// frame that converges at once therefore costs a quarter of one linearisation
/// and one step.
///
/// Each lane has its own residuals, weights, changes, bounds and convergence.
/// Some frames do not suit the lanes. ContactFit fits them alone, from where
/// their lane stood:
/// - a frame that changes a lot, does not lower its chi2, or does not converge
///   in a few iterations;
/// - a frame whose contact lies in a third element, or beyond a gauge end that
///   the contacts of the other lanes have not reached.
///
/// Results depend on the state given to Start, the frames since then, and how
/// the frames were divided into calls. After the first calls nothing is
/// allocated.
class FrameGroupFit {
 public:
  /// Throws InputError as LadderModel does.
  FrameGroupFit(const Finger& finger, const Discretization& discretization,
                double friction = 0);

  /// Fits in lanes take the curvatures of the gauges from it and converge
  /// faster (GaugeReading::Change). It must outlive this and have the same
  /// finger and friction. Null: none.
  void set_surface(const GaugeSurface* surface);

  /// The same as in ContactFit.
  void set_tolerance(double relative);
  void set_most_force(double force_N);

  /// Sets the start of the next frames: an equilibrium with a contact near
  /// theirs.
  void Start(const LadderState& state, const PointContact& contact);

  /// Fits consecutive frames that follow the last one fitted, or Start. Each
  /// column of angles and weights is a frame; weights are per rad, 0 where not
  /// measured. All lanes finish before the call returns, so calls with many
  /// frames are faster. If a frame does not converge, the next one of its lane
  /// starts from where that frame started.
  void Fit(const Eigen::Ref<const Eigen::MatrixXd>& angles_rad,
           const Eigen::Ref<const Eigen::MatrixXd>& weights_per_rad,
           FrameFit* fits);

 private:
  using Columns = Eigen::Ref<const Eigen::MatrixXd>;
  using Column = ContactFit::Readings;

  struct Lane {
    int frame;  // its column; the lane is idle beyond the last one
    int iteration;
    bool waiting;  // until the other lanes catch up
    bool converged;
    double arc_mm, normal_N;
    double last_cost, last_change;
    ContactMatrix normal;  // ContactEquations::normal, the last one
    bool has_curvatures;   // where the frame starts
    GaugeCurvatures curvatures;
    double kept_arc_mm, kept_normal_N;
  };
  // The arguments of one call of Fit.
  struct Frames {
    const Columns& angles_rad;
    const Columns& weights_per_rad;
    FrameFit* fits;
    int count() const { return static_cast<int>(angles_rad.cols()); }
    bool Busy(const Lane& lane) const { return lane.frame < count(); }
  };

  void TakeFrame(int lane, int frame);
  void Begin(const Frames& frames, int lane);
  void Linearize();
  void Advance(const Frames& frames, int lane);
  bool Improve(const Frames& frames, int lane, bool predict);
  double ShapeChange(int lane, bool newton, const ContactVector& change) const;
  void Record(const Frames& frames, int lane) const;
  void Keep(LaneSet lanes);
  void FitLane(const Frames& frames, int lane);
  void FitAlone(const Frames& frames, int frame);

  LadderLanes lanes_;
  ContactFit alone_;
  double tolerance_ = 1e-12;
  double most_force_N_ = std::numeric_limits<double>::infinity();
  double friction_;
  bool adaptive_;
  const GaugeSurface* surface_ = nullptr;

  std::array<Lane, kFrameLanes> lane_{};
  // The lanes with a valid linearisation. For each of them Newton's step is
  // still to be taken (newton_ is 1, else 0), and the contact has moved since
  // by change_ = (l_c, f_c) in the ladder's units.
  LaneSet linearised_ = 0;
  FourFrames newton_{}, change_[2] = {};
  GaugeReading<FourFrames, 2> gauges_;  // after that step and change
  // The change between the last two linearisations, and the lanes in which both
  // are valid.
  FourFrames step_[2] = {};
  LaneSet comparable_ = 0;
  // The state from which each lane's frame started, used when the frame is
  // fitted alone; and the lanes whose state is still to be copied.
  std::vector<FourFrames> kept_state_;
  LaneSet to_keep_ = 0;

  // Set when a load needs a finer mesh than the lanes have. Frames are then
  // fitted one by one until the next Start.
  bool one_by_one_ = false;
  LadderState state_;
  std::vector<PointContact> contact_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

#ifndef FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_
#define FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "finray/ladder/ladder_lanes.h"
#include "finray/sensing/fast/contact_fit.h"

namespace finray {

/// What a fit of one contact to one frame came to.
struct FrameFit {
  bool converged = false;
  bool in_lanes = false;
  int iterations = 0;  ///< linearisations.
  double arc_mm = 0, normal_N = 0;
  double chi2 = 0;
  Eigen::Matrix2d information;  ///< Fisher's, of (l_c, f_c) per mm and N.
  Eigen::Vector3d contact_pose, tip_pose;  ///< (x, y, theta), mm and rad.
  Eigen::VectorXd rib_tension_N;
};

/// ContactFit of one contact for the frames of a log, four at a time in vector
/// lanes. Lane k takes frames k, k + 4, k + 8 .. as fast as they converge, and
/// starts each from what the last linearisation makes of its readings, as
/// ContactFit::Follow does; none runs far ahead. As the end of one frame and
/// the prediction of the next are changes of the same linearisation, they are
/// one step: a frame that converges at once costs a quarter of one
/// linearisation and one step.
///
/// Lanes have their own residuals, weights, changes, bounds and convergence.
/// What does not fit in is fitted alone by ContactFit, from where its lane
/// stood: a frame that changes a lot, does not lower its chi2 or does not
/// converge in a few iterations, and a contact in a third element or beyond
/// the end of a gauge that other lanes' have not reached.
///
/// Results depend on the state given to Start, the frames since, and the calls
/// they came in. After the first calls nothing is allocated.
class FrameGroupFit {
 public:
  /// Throws InputError as LadderModel.
  FrameGroupFit(const Finger& finger, const Discretization& discretization,
                double friction = 0);

  /// As ContactFit's.
  void set_tolerance(double relative);
  void set_most_force(double force_N);

  /// Where the next frames start: an equilibrium with a contact near theirs.
  void Start(const LadderState& state, const PointContact& contact);

  /// Fits frames that follow each other, the first one the last that was
  /// fitted (or Start). A column of angles and weights (per rad, 0: not
  /// measured) is a frame. Lanes end together, so calls of many frames are
  /// faster. Where a frame does not converge the next one of its lane starts
  /// from before it.
  void Fit(const Eigen::Ref<const Eigen::MatrixXd>& angles_rad,
           const Eigen::Ref<const Eigen::MatrixXd>& weights_per_rad,
           FrameFit* fits);

 private:
  using Columns = Eigen::Ref<const Eigen::MatrixXd>;

  struct Lane {
    int frame;  // its column; the lane is idle if that is beyond the last
    int iteration;
    bool waiting;  // for the others, before it begins
    bool converged;
    double arc_mm, normal_N;
    double last_cost, last_change;
    ContactMatrix normal;  // of the last equations
    double kept_arc_mm, kept_normal_N;
  };
  // The frames of a call.
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
  void ReadGauges();
  void Advance(const Frames& frames, int lane);
  bool Improve(const Frames& frames, int lane, bool predict);
  ContactEquations EquationsOf(const Frames& frames, int lane) const;
  double Rate(const Frames& frames, int lane, const ContactEquations& equations,
              const ContactVector& x) const;
  double ShapeChange(int lane, bool newton, const ContactVector& change) const;
  bool IsResolved(int lane) const;
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

  std::array<Lane, kFrameLanes> lane_{};
  // The lanes whose linearisation is of use, each of which then has Newton's
  // step ahead of it (1, else 0) and has moved its contact since, by (l_c, f_c)
  // in units of the ladder.
  LaneSet linearised_ = 0;
  FourFrames newton_{}, change_[2] = {};
  // Gauge angles after that step and change; slopes by (l_c, f_c).
  std::vector<FourFrames> reading_, slope_[2];
  // The slopes of the linearisation before, the change that led from there, and
  // the lanes in which it did.
  std::vector<FourFrames> slope_before_[2];
  FourFrames step_[2] = {};
  LaneSet comparable_ = 0;
  // Where each lane's frame started, for a fit alone; lanes yet to be copied.
  std::vector<FourFrames> kept_state_;
  LaneSet to_keep_ = 0;

  // A load that asks for a finer mesh than the lanes have: from there on to the
  // next Start frames are fitted one by one.
  bool one_by_one_ = false;
  LadderState state_;
  std::vector<PointContact> contact_;
  Eigen::VectorXd angles_, weights_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_FRAME_GROUP_FIT_H_

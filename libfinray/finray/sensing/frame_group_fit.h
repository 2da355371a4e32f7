#ifndef FINRAY_SENSING_FRAME_GROUP_FIT_H_
#define FINRAY_SENSING_FRAME_GROUP_FIT_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "finray/sensing/contact_fit.h"
#include "finray/statics/ladder_lanes.h"

namespace finray {

/// What a fit of one contact to one frame came to.
struct FrameFit {
  bool converged = false;
  double arc_mm = 0, normal_N = 0;
  Eigen::Matrix2d information;  ///< Fisher's, of (l_c, f_c) per mm and N.
  double chi2 = 0;
  Eigen::Vector3d contact_pose, tip_pose;  ///< (x, y, theta), mm and rad.
  Eigen::VectorXd rib_tension_N;
  int iterations = 0;  ///< linearisations.
  bool in_lanes = false;
};

/// ContactFit of one contact for frames of a log, four at a time in vector
/// lanes: lane k takes frames k, k + 4, k + 8 .. and starts each from what its
/// last frame's linearisation makes of the new readings, as ContactFit::Follow
/// does. Lanes have their own residuals, weights, changes and convergence.
/// What does not fit in is fitted alone, by ContactFit, from where its lane
/// stood: a lane that meets a bound, turns too far, does not lower its chi2 or
/// does not converge in a few iterations, and contacts in a third element or
/// beyond the end of a gauge that other lanes' have not reached.
///
/// Results depend on the state given to Start and on the frames since. After
/// the first calls nothing is allocated.
class FrameGroupFit {
 public:
  /// Throws InputError as LadderModel.
  FrameGroupFit(const Finger& finger, const Discretization& discretization,
                double friction = 0);

  /// As ContactFit's.
  void set_tolerance(double relative);
  void set_most_force(double force_N);

  /// Where the next frame starts: an equilibrium with a contact near its own.
  void Start(const LadderState& state, const PointContact& contact);

  /// Fits frames that follow each other, the first one the last that was
  /// fitted (or Start). A column of angles and weights (per rad, 0: not
  /// measured) is a frame. Where a frame does not converge the next one starts
  /// from before it.
  void Fit(const Eigen::Ref<const Eigen::MatrixXd>& angles_rad,
           const Eigen::Ref<const Eigen::MatrixXd>& weights_per_rad,
           FrameFit* fits);

 private:
  using Numbers = std::array<double, kFrameLanes>;
  using Columns = Eigen::Ref<const Eigen::MatrixXd>;

  void FitGroup(const Columns& angles_rad, const Columns& weights_per_rad,
                FrameFit* fits);
  void ReadGauges();
  ContactEquations EquationsOf(int lane, const double* angle,
                               const double* weight) const;
  bool IsResolved(int lane) const;
  void Record(int lane, const double* angle, const double* weight,
              const ContactVector& change, const ContactMatrix& normal,
              FrameFit* fit) const;
  void Keep();
  void RestoreLane(int lane);
  void FitLane(const Columns& angles_rad, const Columns& weights_per_rad,
               int lane, FrameFit* fit);
  void FitAlone(const Columns& angles_rad, const Columns& weights_per_rad,
                int frame, FrameFit* fit);

  LadderLanes lanes_;
  ContactFit alone_;
  double tolerance_ = 1e-12;
  double most_force_N_ = std::numeric_limits<double>::infinity();
  double friction_;
  bool adaptive_;

  // Of each lane: the contact, and whether the frame of lanes_ holds a
  // linearisation at the lane's state, or at the one before the last step.
  Numbers arc_mm_{}, normal_N_{};
  LaneSet linearised_ = 0;
  FourFrames newton_{};  // the share of Newton's step that is not taken yet
  // Gauge angles at the end of that step and their slopes by (l_c, f_c).
  std::vector<FourFrames> reading_, slopes_[2];

  // What a group started from.
  std::vector<FourFrames> kept_state_;
  Numbers kept_arc_mm_{}, kept_normal_N_{};

  // A load that asks for a finer mesh than the lanes have: from there on to the
  // next Start frames are fitted one by one.
  bool one_by_one_ = false;
  LadderState state_;
  std::vector<PointContact> contact_;
  Eigen::VectorXd angles_, weights_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_GROUP_FIT_H_

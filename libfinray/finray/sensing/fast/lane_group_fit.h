#ifndef FINRAY_SENSING_FAST_LANE_GROUP_FIT_H_
#define FINRAY_SENSING_FAST_LANE_GROUP_FIT_H_

#include <array>
#include <limits>
#include <vector>

#include "finray/ladder/ladder_lanes.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/fast/frame_group_fit.h"

namespace finray {

/// FrameGroupFit in the lanes of T, which is FourFrames or EightFrames.
template <class T>
class LaneGroupFit : public FrameGroupFit {
 public:
  LaneGroupFit(const Finger& finger, const Discretization& discretization,
               double friction);

  void set_surface(const GaugeSurface* surface) override;
  void set_tolerance(double relative) override;
  void set_most_force(double force_N) override;
  void Start(const LadderState& state, const PointContact& contact) override;
  void Fit(const Eigen::Ref<const Eigen::MatrixXd>& angles_rad,
           const Eigen::Ref<const Eigen::MatrixXd>& weights_per_rad,
           FrameFit* fits) override;

 private:
  static constexpr int kLanes = kFrameLanes<T>;
  using Columns = Eigen::Ref<const Eigen::MatrixXd>;
  using Column = ContactFit::Readings;

  struct Lane {
    int frame;  // its column; the lane is idle beyond the last one
    int iteration;
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

  void StartLanes();
  void TakeFrame(int lane);
  void Begin(const Frames& frames, int lane);
  void Linearize(const Frames& frames);
  void Advance(const Frames& frames, int lane);
  bool Improve(const Frames& frames, int lane, bool predict);
  double ShapeChange(int lane, bool newton, const ContactVector& change) const;
  void Record(const Frames& frames, int lane) const;
  void Keep(LaneSet lanes);
  void FitLane(const Frames& frames, int lane);
  void FitAlone(const Frames& frames, int frame);

  LadderLanes<T> lanes_;
  ContactFit alone_;
  double tolerance_ = 1e-12;
  double most_force_N_ = std::numeric_limits<double>::infinity();
  double friction_;
  bool adaptive_;
  const GaugeSurface* surface_ = nullptr;

  std::array<Lane, kLanes> lane_{};
  int next_ = 0;  // the first frame that no lane has taken
  // The lanes with a valid linearisation. For each of them Newton's step is
  // still to be taken (newton_ is 1, else 0), and the contact has moved since
  // by change_ = (l_c, f_c) in the ladder's units.
  LaneSet linearised_ = 0;
  T newton_{}, change_[2] = {};
  GaugeReading<T, 2> gauges_;  // after that step and change
  // The change between the last two linearisations, and the lanes in which both
  // are valid.
  T step_[2] = {};
  LaneSet comparable_ = 0;
  // The state from which each lane's frame started, used when the frame is
  // fitted alone; and the lanes whose state is still to be copied.
  std::vector<T> kept_state_;
  LaneSet to_keep_ = 0;

  // Until a call with more than one frame the lanes hold nothing, and state_
  // and contact_ are the start of the next frame.
  bool fresh_ = true;
  // Set when a load needs a finer mesh than the lanes have. Frames are then
  // fitted one by one until the next Start.
  bool one_by_one_ = false;
  LadderState state_;
  std::vector<PointContact> contact_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_LANE_GROUP_FIT_H_

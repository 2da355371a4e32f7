#ifndef FINRAY_ESTIMATION_LIVE_OFFSETS_H_
#define FINRAY_ESTIMATION_LIVE_OFFSETS_H_

#include <Eigen/Core>

#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/offset_belief.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// Follows gauge offsets that wander (gauge_offset_walk) while frames arrive
/// one by one, in fixed memory:
///
///   variance += q^2 dt             in every frame,
///   mean, variance: Kalman update  by the readings of free frames.
///
/// Under a touch the variance grows, and with it the std of the contacts. Once
/// moved offsets explain a frame as well as the touch that lasts (HeldTouch),
/// it is unobservable. Free frames within the guard time of a touch, before or
/// behind it, do not count: the weak begin and end of a touch look free too. It
/// takes it that the finger is free at first.
class LiveOffsets {
 public:
  LiveOffsets(const Finger& finger, const GaugeOffsetWalk& walk,
              const Eigen::VectorXd& free_angles);

  /// Returns the row with the finger's offsets, and what is not known of them
  /// in history_std_V. A row without a later time_s comes at the time of the
  /// row before.
  const Measurements& Correct(const Measurements& row);
  /// Learns from the estimate of that row, and judges it.
  void Judge(FrameEstimate* estimate);
  void Restart();

 private:
  void Learn();
  void SetClock(double time_s);

  Finger finger_;
  GaugeOffsetWalk walk_;
  Eigen::VectorXd free_angles_;
  double guard_s_;
  OffsetBelief belief_;
  // The belief one to two guard times ago, and up to one ago.
  OffsetBelief old_, recent_;
  double touched_s_;  // time of the last frame of a touch
  HeldTouch touch_;
  Measurements raw_, corrected_;  // of the row under way
  Eigen::VectorXd beside_V_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_LIVE_OFFSETS_H_

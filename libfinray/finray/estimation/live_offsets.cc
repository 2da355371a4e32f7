#include "finray/estimation/live_offsets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/estimation/free_frame.h"
#include "finray/estimation/touch_detection.h"

namespace finray {

LiveOffsets::LiveOffsets(const Finger& finger, const GaugeOffsetWalk& walk,
                         const Eigen::VectorXd& free_angles)
    : finger_(finger),
      walk_(walk),
      free_angles_(free_angles),
      guard_s_(TouchDetection::GuardTime_s(finger, walk)) {
  Restart();
}

void LiveOffsets::Restart() {
  const auto gauges = static_cast<Eigen::Index>(finger_.gauges.size());
  belief_.time_s = std::numeric_limits<double>::quiet_NaN();
  belief_.mean_V = GaugeOffsets(finger_);
  belief_.variance_V2 =
      Eigen::VectorXd::Constant(gauges, std::pow(walk_.start_std_V, 2));
  old_ = recent_ = belief_;
  touched_s_ = -std::numeric_limits<double>::infinity();
  touch_.End();
}

const Measurements& LiveOffsets::Correct(const Measurements& row) {
  // A clock that starts, or starts anew: nothing says how much time has passed.
  if (!(row.time_s >= belief_.time_s)) SetClock(row.time_s);
  if (row.time_s > belief_.time_s) {
    belief_.Wander(row.time_s, std::pow(walk_.std_V_per_sqrt_s, 2));
  }
  raw_ = row;
  MoveToOffsetsOf(finger_, belief_, row, &corrected_);
  return corrected_;
}

void LiveOffsets::SetClock(double time_s) {
  if (std::isnan(time_s)) return;  // a row without a time
  const double back_s = belief_.time_s - time_s;
  if (std::isnan(back_s)) {
    belief_.time_s = old_.time_s = recent_.time_s = time_s;
    return;
  }
  for (OffsetBelief* belief : {&belief_, &old_, &recent_}) {
    belief->time_s -= back_s;
  }
  touched_s_ -= back_s;
  touch_.MoveClock(back_s);
}

void LiveOffsets::Judge(FrameEstimate* estimate) {
  ReadBesideFree(finger_, free_angles_, raw_, &beside_V_);
  if (estimate->contacts > 0) {
    if (!estimate->IsUnexplained()) touch_.Hold(beside_V_, belief_.time_s);
    touched_s_ = belief_.time_s;
    // What was taken for free shortly before may have been its begin.
    const double now_s = belief_.time_s;
    belief_ = recent_ = old_;
    belief_.Wander(now_s, std::pow(walk_.std_V_per_sqrt_s, 2));
    // An error of an offset is common to the frames of a touch.
    double noise = 0, all = 0;
    for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
      const double noise_V = raw_.GaugeStd_V(j, finger_.gauges[j].noise_V);
      const double all_V = corrected_.GaugeStd_V(j, finger_.gauges[j].noise_V);
      noise += noise_V * noise_V;
      all += all_V * all_V;
    }
    for (int c = 0; c < estimate->contacts; ++c) {
      estimate->contact[c].arc_noise_mm *= std::sqrt(noise / all);
      estimate->contact[c].normal_noise_N *= std::sqrt(noise / all);
    }
  } else if (estimate->status == FrameStatus::kNoContact) {
    if (touch_.Lasts(finger_, beside_V_, belief_.mean_V)) {
      touch_.Hold(beside_V_, belief_.time_s);
      touched_s_ = belief_.time_s;
      LeaveUnknown(estimate);
    } else {
      touch_.End();
      Learn();
    }
  }
  estimate->gauge_offset_V.assign(belief_.mean_V.begin(), belief_.mean_V.end());
  estimate->gauge_offset_std_V.assign(belief_.variance_V2.begin(),
                                      belief_.variance_V2.end());
  for (double& std_V : estimate->gauge_offset_std_V) std_V = std::sqrt(std_V);
}

void LiveOffsets::Learn() {
  if (belief_.time_s - touched_s_ < guard_s_) return;
  belief_.Absorb(finger_, free_angles_, raw_);
  if (belief_.time_s - recent_.time_s < guard_s_) return;
  old_ = recent_;
  recent_ = belief_;
}

}  // namespace finray

#ifndef FINRAY_CONTROL_CONTACT_WATCH_H_
#define FINRAY_CONTROL_CONTACT_WATCH_H_

#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Limits that decide when the loop trusts an estimate.
struct Safety {
  /// A contact is seen if the std of its force is at most this.
  double force_std_limit_N = 0.3;
  /// How long the drive waits for a contact that is no longer seen.
  double hold_s = 0.5;
  /// A contact that is not determined counts as a light touch below this force,
  /// and the finger may move on. Above it, the contact counts as not seen.
  double touch_N = 1.5;
  /// Speed of the drive towards an object without contact, mm/s or rad/s.
  double approach_speed = 5;
};

/// What the drive does.
enum class LoopMode {
  kZero,      ///< It waits while the gauges are zeroed.
  kApproach,  ///< It moves towards the object: no contact or a light touch.
  kControl,   ///< It follows the controller: the contact is seen.
  kHold,      ///< It stays: the contact is not seen.
  kStopped,   ///< It returns to its start for good: not seen for hold_s.
};
const char* LoopModeName(LoopMode mode);

/// The uses that an estimate is good for. Several of them may hold.
struct Sight {
  bool seen;  ///< The status is ok and the std of the force within the limit.
  bool free;  ///< There is no contact.
  /// A contact can only be a light touch. Either the gauges bend less than
  /// touch_N would bend them anywhere but at the finger's ends (`signal` of
  /// TouchSignal below 1), or the estimate and its alternative both stay below
  /// touch_N with twice their std.
  bool light;

  bool blind() const { return !seen && !free && !light; }  ///< e.g. bad input
};
Sight Judge(const FrameEstimate& estimate, double signal, const Safety& safety);

/// Follows the sights of all fingers and decides what the drive does. If any
/// finger is blind, it holds. If all fingers see their contact, the controller
/// drives; it takes over after kSureFrames such frames in a row, because a few
/// of many unobservable frames look sure. Otherwise the approach goes on.
class ContactWatch {
 public:
  static constexpr int kSureFrames = 3;

  ContactWatch(const Safety& safety, double period_s);

  /// Takes the sight of each finger, once a period.
  LoopMode Next(const std::vector<Sight>& sights);

 private:
  Safety safety_;
  double period_s_;
  LoopMode mode_ = LoopMode::kApproach;
  int blind_ = 0, seen_ = 0;  // periods in a row
};

/// The bending of a finger's gauges in units of a given touch.
class TouchSignal {
 public:
  /// The unit is the least angle that a force of touch_N causes in the most
  /// bent gauge, over contacts from 0.2 to 0.8 of the front beam's length.
  TouchSignal(const Finger& finger, double touch_N,
              const Discretization& discretization);

  /// The largest bending angle of the gauges, in that unit; NaN if a gauge
  /// reads nothing or is saturated.
  double Of(const Measurements& readings) const;

 private:
  std::vector<Gauge> gauges_;
  double least_rad_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTACT_WATCH_H_

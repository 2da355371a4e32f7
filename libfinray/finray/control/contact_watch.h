#ifndef FINRAY_CONTROL_CONTACT_WATCH_H_
#define FINRAY_CONTROL_CONTACT_WATCH_H_

#include <vector>

#include "finray/sensing/frame_estimate.h"

namespace finray {

/// When the loop may trust what it sees.
struct Safety {
  /// A contact whose force has a larger std is not seen.
  double force_std_limit_N = 0.3;
  /// So long the drive waits for an unseen contact to come back.
  double hold_s = 0.5;
  /// Below it a contact that is not determined is a light touch, towards which
  /// the finger may move on; above it, one that is not seen.
  double touch_N = 1.5;
  /// Of drive towards an untouched object, mm/s or rad/s.
  double approach_speed = 5;
};

/// What the drive does.
enum class LoopMode {
  kZero,      ///< The gauges are being zeroed: the drive waits.
  kApproach,  ///< No contact, or a light touch: on towards the object.
  kControl,   ///< The contact is seen: the controller drives.
  kHold,      ///< It is not: the drive stays.
  kStopped,   ///< It was not for hold_s: back to the start, for good.
};
const char* LoopModeName(LoopMode mode);

/// What one estimate is good for.
enum class Sight {
  kSeen,   ///< Status ok and a std of the force below the limit.
  kFree,   ///< No contact.
  kLight,  ///< Neither, but IsLight.
  kBlind,  ///< All else, bad input included.
};
Sight Judge(const FrameEstimate& estimate, double signal, const Safety& safety);

/// A light touch, if any: gauges that bend less than under touch_N anywhere on
/// the finger but at its ends (`signal`, see TouchSignal, below 1); or an
/// estimate that with twice its std does not reach touch_N, nor does its
/// alternative.
bool IsLight(const FrameEstimate& estimate, double signal,
             const Safety& safety);

/// Follows what the fingers see, frame by frame, and decides who drives: nobody
/// if any finger is blind; the controller if all see, and have seen for
/// kSureFrames when it takes over, as among many unobservable frames a few look
/// sure; otherwise the approach.
class ContactWatch {
 public:
  static constexpr int kSureFrames = 3;

  ContactWatch(const Safety& safety, double period_s);

  /// With the TouchSignal of each finger.
  LoopMode Next(const std::vector<FrameEstimate>& estimates,
                const std::vector<double>& signals);

 private:
  Safety safety_;
  double period_s_;
  LoopMode mode_ = LoopMode::kApproach;
  int blind_ = 0, seen_ = 0;  // periods in a row
};

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTACT_WATCH_H_

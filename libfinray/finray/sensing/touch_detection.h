#ifndef FINRAY_SENSING_TOUCH_DETECTION_H_
#define FINRAY_SENSING_TOUCH_DETECTION_H_

#include <Eigen/Core>
#include <vector>

#include "finray/scene/scene.h"
#include "finray/sensing/contact_search.h"
#include "finray/sensing/log_problem.h"

namespace finray {

/// Gauge offsets as Gaussians that do not depend on each other.
struct OffsetBelief {
  double time_s = 0;
  Eigen::VectorXd mean_V, variance_V2;
};

/// Decides which frames of a log touch, before its offsets are known.
///
/// A pass goes through the frames and holds the offsets as the free frames so
/// far tell them, blurred by the walk since the last of them. A frame
///  - touches if a contact explains it well, and significantly better than the
///    free finger does (FrameEstimator::kSignificance);
///  - is free if the free finger explains it, and if the belief with its
///    readings also explains the frames within the guard time: this keeps the
///    begin and the end of a touch, where the force is small, out of the
///    belief;
///  - is left open otherwise.
///
/// One pass goes forward and one backward. A frame touches if one pass says so.
/// It stays open (LogFrame::Role::kUnused) if one pass leaves it open because
/// of the frames behind it. All other frames are free.
class TouchDetection {
 public:
  /// The guard time is that in which offsets wander by so many std of a
  /// reading, but at most kLongestGuard_s.
  static constexpr double kGuard = 2;
  static constexpr double kLongestGuard_s = 1;
  static constexpr double kHeavier = 2;

  /// Throws what ContactSearch throws.
  TouchDetection(const Finger& finger, const Scene& scene,
                 const Discretization& discretization);

  /// Sets the roles of the frames, given the offsets before the first of them,
  /// and where they start: offsets from the free frames on both sides, contacts
  /// from a search with these.
  void Decide(const OffsetBelief& before, std::vector<LogFrame>* frames);

  /// Searches for the contact of a frame whose offsets have this mean and
  /// variance. False if the free finger explains it about as well, unless the
  /// scene says that every frame has a contact.
  bool FindContact(const LogFrame& frame, const Eigen::VectorXd& mean_V,
                   const Eigen::VectorXd& variance_V2);
  /// The last search of FindContact.
  const ContactSearch& search() const { return search_; }
  /// Makes the frame one that touches, with what the last search has found. If
  /// that needs kHeavier times the force of its rival, the two change places: a
  /// light touch looks like a heavy one near the tip.
  void StartTouch(LogFrame* frame) const;

 private:
  enum class Verdict { kFree, kTouching, kGuard, kUnexplained };

  std::vector<Verdict> Pass(const std::vector<LogFrame>& frames,
                            OffsetBelief belief, bool forward);
  // Whether all frames that follow `first` closely could be free.
  bool CouldStayFree(const std::vector<LogFrame>& frames, std::size_t first,
                     const OffsetBelief& belief, bool forward) const;
  double FreeChi2(const LogFrame& frame, const Eigen::VectorXd& mean_V,
                  const Eigen::VectorXd& variance_V2) const;
  void Wander(double time_s, OffsetBelief* belief) const;
  void Absorb(const LogFrame& frame, OffsetBelief* belief) const;
  OffsetBelief Behind(const OffsetBelief& before,
                      const std::vector<LogFrame>& frames) const;
  std::vector<OffsetBelief> FromOneSide(const std::vector<LogFrame>& frames,
                                        OffsetBelief belief,
                                        bool forward) const;
  void Start(const OffsetBelief& before, std::vector<LogFrame>* frames);

  Finger finger_;
  Scene scene_;
  double walk_;  // V^2 per s
  double guard_s_ = 0;
  ContactSearch search_;
  PackedReadings measurement_;  // of the last FindContact
};

}  // namespace finray

#endif  // FINRAY_SENSING_TOUCH_DETECTION_H_

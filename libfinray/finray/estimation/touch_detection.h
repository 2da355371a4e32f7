#ifndef FINRAY_ESTIMATION_TOUCH_DETECTION_H_
#define FINRAY_ESTIMATION_TOUCH_DETECTION_H_

#include <Eigen/Core>
#include <vector>

#include "finray/estimation/contact_search.h"
#include "finray/estimation/log_problem.h"
#include "finray/estimation/offset_belief.h"
#include "finray/scene/scene.h"

namespace finray {

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
///  - is doubtful if the free finger explains it and a touch before has not
///    ended (HeldTouch);
///  - is left open otherwise.
///
/// One pass goes forward and one backward. The forward one takes it that the
/// log begins with a free finger. The backward one knows nothing of the end of
/// the log until it comes to a frame that the forward one calls free. A frame
/// touches if one pass says so. It stays open (LogFrame::Role::kUnused) if one
/// pass leaves it open because of the frames behind it, or if no pass calls it
/// free; in doubt, it is also LogFrame::doubtful. All other frames are free.
class TouchDetection {
 public:
  /// The guard time is that in which offsets wander by so many std of a
  /// reading, but at most kLongestGuard_s.
  static constexpr double kGuard = 2;
  static constexpr double kLongestGuard_s = 1;
  static constexpr double kHeavier = 2;
  static double GuardTime_s(const Finger& finger, const GaugeOffsetWalk& walk);

  /// Throws what ContactSearch throws.
  TouchDetection(const Finger& finger, const Scene& scene,
                 const Discretization& discretization);

  /// Sets the roles of the frames, given the offsets before the first of them,
  /// and where they start: offsets from the free frames on both sides, contacts
  /// from a search with these.
  void Decide(const OffsetBelief& before, std::vector<LogFrame>* frames);

  /// The first `settled` frames of those of Decide are done with. What lasts
  /// there goes on in the next ones.
  void Settle(std::size_t settled) {
    if (settled < touches_.size()) before_ = touches_[settled];
  }

  /// The offsets of each frame as the free frames on both sides tell them.
  std::vector<OffsetBelief> Beliefs(const OffsetBelief& before,
                                    const std::vector<LogFrame>& frames) const;

  /// The same by the free frames before each frame.
  std::vector<OffsetBelief> BeliefsBehind(
      const OffsetBelief& before, const std::vector<LogFrame>& frames) const {
    return FromOneSide(frames, before, true);
  }

  /// Searches for the contact of a frame whose offsets have this mean and
  /// variance. False if the free finger explains it about as well, unless the
  /// scene says that every frame has a contact.
  bool FindContact(const LogFrame& frame, const Eigen::VectorXd& mean_V,
                   const Eigen::VectorXd& variance_V2);
  /// chi2 of what a camera sees of a row, of the free finger.
  double FreeCameraChi2(const Measurements& row);
  /// The last search of FindContact.
  const ContactSearch& search() const { return search_; }
  /// Makes the frame one that touches, with what the last search has found. If
  /// that needs kHeavier times the force of its rival, the two change places: a
  /// light touch looks like a heavy one near the tip.
  void StartTouch(LogFrame* frame) const;

 private:
  enum class Verdict { kFree, kTouching, kDoubtful, kGuard, kUnexplained };

  // The verdicts of the forward pass, or with these those of the backward one.
  std::vector<Verdict> Pass(const std::vector<LogFrame>& frames,
                            OffsetBelief belief,
                            const std::vector<Verdict>* there);
  // Whether all frames that follow `first` closely could be free.
  bool CouldStayFree(const std::vector<LogFrame>& frames, std::size_t first,
                     const OffsetBelief& belief, bool forward) const;
  double FreeChi2(const LogFrame& frame, const Eigen::VectorXd& mean_V,
                  const Eigen::VectorXd& variance_V2) const;
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
  HeldTouch before_;                // at the first frame
  std::vector<HeldTouch> touches_;  // before each frame of Decide
  Measurements moved_;              // of the last FindContact
  PackedReadings measurement_;      // the same
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_TOUCH_DETECTION_H_

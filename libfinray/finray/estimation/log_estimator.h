#ifndef FINRAY_ESTIMATION_LOG_ESTIMATOR_H_
#define FINRAY_ESTIMATION_LOG_ESTIMATOR_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/log_problem.h"
#include "finray/estimation/touch_detection.h"
#include "finray/fit/calibration_errors.h"

namespace finray {

/// Estimates a whole log: the contacts of all frames and the wandering offsets
/// of the gauges together (LogProblem), and which frames touch.
///
/// The log passes through in windows. A window ends in a gap: there the finger
/// is free for so long that the offsets behind the gap say nothing about those
/// before it. Half of the gap belongs to the next window too. The next window's
/// prior is the exact marginal of all frames before it. Without such a gap a
/// window grows to kLongestWindow frames, and its first half is settled. So
/// time grows with the number of frames and memory does not.
///
/// After a solve, each frame is judged again with the offsets that all other
/// frames give it. A contact that is no longer significant is taken away. A
/// contact that has become significant is added. Then the window is solved
/// again, up to kMostRounds times.
///
/// The frames of a window that does not converge are estimated one by one, with
/// the offsets that the free frames on both sides tell them; where offsets
/// wander, their contacts are unobservable.
///
/// It sets the statuses of FrameEstimator, by its criteria: those of JudgeFree
/// without a contact or with one below LeastForce_N, but unobservable where the
/// frame is doubtful, ok or unobservable for any other contact, bad_input for
/// too few measurements or impossible ones.
class LogEstimator {
 public:
  static constexpr std::size_t kWindow = 2048, kLongestWindow = 16384;
  static constexpr int kMostRounds = 4;

  /// Gets the frames one by one in their order.
  using Take = std::function<void(const FrameEstimate&)>;

  /// Throws InputError as FrameEstimator does, and for more contacts than one.
  LogEstimator(const Finger& finger, const Scene& scene,
               const Discretization& discretization, int threads, Take take);

  /// The next frame. Throws InputError if the offsets wander and its time is
  /// missing or not after that of the frame before.
  void Add(const Measurements& row);

  /// There are no more frames.
  void Finish();

  /// How well the scene's gauge_offset_walk fits the frames so far. Where it is
  /// too small, or the offsets drift steadily, what is not told about them goes
  /// into the contacts, and these are unobservable.
  const WalkIncrements& walk() const { return walk_; }
  /// The number of frames that were estimated one by one.
  std::size_t alone() const { return alone_; }

 private:
  // The last gap of the frames so far that is long enough.
  struct Gap {
    std::size_t middle, end;
  };
  std::optional<Gap> FindGap() const;
  // Solves the first `window` frames, and settles the first ones of these.
  void SolveWindow(std::size_t window, std::size_t settled);
  bool Reconsider(const std::vector<LogMarginal>& marginals,
                  std::vector<LogFrame>* frames, std::vector<bool>* dropped);
  double FreeChi2(const LogFrame& frame, const LogMarginal& marginal);
  LogPrior FirstPrior() const;
  OffsetBelief BeliefBefore() const;
  void EstimateAlone(const std::vector<LogFrame>& frames, std::size_t settled);
  FrameEstimate Judge(const LogFrame& frame, const LogMarginal& marginal);
  void JudgeContact(const LogFrame& frame, const LogMarginal& marginal,
                    const PackedReadings& packed, FrameEstimate* estimate);

  Finger finger_;
  Scene scene_;
  Discretization discretization_;
  int threads_;
  Take take_;
  TouchDetection detection_;
  CalibrationErrors systematic_;
  FrameEstimate free_;
  int iterations_ = 0;  // of the window under way
  double least_force_N_;
  std::vector<LogFrame> frames_;
  LogPrior prior_;
  WalkIncrements walk_;
  bool offsets_are_told_ = true;
  std::optional<FrameEstimator> frame_estimator_;  // made when needed
  std::size_t alone_ = 0;
  std::size_t next_look_ = kWindow;  // frames at which a gap is looked for
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_LOG_ESTIMATOR_H_

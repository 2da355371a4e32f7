#ifndef FINRAY_SENSING_LOG_ESTIMATOR_H_
#define FINRAY_SENSING_LOG_ESTIMATOR_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "finray/sensing/calibration_uncertainty.h"
#include "finray/sensing/frame_estimate.h"
#include "finray/sensing/log_problem.h"
#include "finray/sensing/touch_detection.h"

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
/// It sets the statuses of FrameEstimator, by its criteria: those of JudgeFree
/// without a contact or with one below LeastForce_N, not_converged if it
/// touches in a window that did not converge, ok or unobservable for any other
/// contact, bad_input for too few measurements or impossible ones.
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
  double FreeChi2(const LogFrame& frame, const LogMarginal& marginal) const;
  LogPrior FirstPrior() const;
  OffsetBelief BeliefBefore() const;
  FrameEstimate Judge(const LogFrame& frame, const LogMarginal& marginal,
                      bool converged);
  void JudgeContact(const LogFrame& frame, const LogMarginal& marginal,
                    const PackedReadings& packed, FrameEstimate* estimate);

  Finger finger_;
  Scene scene_;
  Discretization discretization_;
  int threads_;
  Take take_;
  TouchDetection detection_;
  CalibrationUncertainty systematic_;
  FrameEstimate free_;
  int iterations_ = 0;  // of the window under way
  double least_force_N_;
  std::vector<LogFrame> frames_;
  LogPrior prior_;
  std::size_t next_look_ = kWindow;  // frames at which a gap is looked for
};

}  // namespace finray

#endif  // FINRAY_SENSING_LOG_ESTIMATOR_H_

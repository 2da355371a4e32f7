#ifndef FINRAY_VIEW_LIVE_FEED_H_
#define FINRAY_VIEW_LIVE_FEED_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "finray/estimation/frame_estimate.h"
#include "finray/scene/measurements.h"

namespace finray {

/// What a live page needs of a row.
struct LiveRow {
  double time_s = 0;
  FrameStatus status = FrameStatus::kBadInput;
  ContactEstimates contact;
  double p_value = 0, force_N = 0;
  /// Where the motion of the object tells it; NaN where it is the scene's.
  double friction = Measurements::kNotMeasured;
  std::vector<double> gauges_V, history_std_V;
  double gauge_readings = 1;
  std::uint64_t latency_ns = 0;
};

/// A queue of fixed length from the thread that estimates to the one that
/// serves pages. Neither ever waits for the other: a row that finds the queue
/// full is counted and left out.
class LiveFeed {
 public:
  explicit LiveFeed(std::size_t gauges);

  /// For the estimating thread only. Allocates nothing.
  void Push(const Measurements& readings, const FrameEstimate& estimate,
            std::uint64_t latency_ns);
  /// For the other thread only. Copies the oldest row to `row`; false if there
  /// is none.
  bool Pop(LiveRow* row);

  std::uint64_t missed() const {
    return missed_.load(std::memory_order_relaxed);
  }
  static constexpr std::size_t kRows = 1 << 13;

 private:
  std::vector<LiveRow> rows_;
  std::atomic<std::size_t> pushed_{0}, popped_{0};
  std::atomic<std::uint64_t> missed_{0};
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_FEED_H_

#ifndef FINRAY_VIEW_LIVE_UPDATE_H_
#define FINRAY_VIEW_LIVE_UPDATE_H_

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "finray/batch/live_rows.h"
#include "finray/view/estimate_solver.h"
#include "finray/view/finger_picture.h"
#include "finray/view/live_feed.h"

namespace finray {

/// Turns the rows of a feed into updates of live pages, each with the rows
/// since the one before: the least and the largest value of each channel, the
/// last row, and its shape.
class LiveUpdates {
 public:
  LiveUpdates(const Finger& finger, const Discretization& discretization,
              double friction);

  /// The data of the page before the first update.
  std::string PageJson(const std::string& name) const;
  /// Takes all rows of the feed. Returns "" if there is none. `message` and
  /// `zeroing` go to the page as they are.
  std::string Next(LiveFeed* feed, const std::string& message, bool zeroing);
  /// From now on residuals are those of these gauges: the finger has been
  /// zeroed.
  void set_gauges(const std::vector<Gauge>& gauges) {
    solver_.set_gauges(gauges);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void Take(const LiveRow& row);
  std::string Shape();

  // Returns that of the contacts of a row.
  double FrictionOf(const LiveRow& row) const {
    return std::isnan(row.friction) ? friction_ : row.friction;
  }

  double friction_;
  PictureNodes nodes_;
  EstimateSolver solver_;
  std::vector<std::string> names_;
  std::vector<double> least_, most_, last_;
  std::vector<float> found_;
  LiveRow row_;
  unsigned mask_ = 0;
  std::uint64_t rows_ = 0, rows_before_ = 0;
  LatencyHistogram latency_;
  Clock::time_point start_ = Clock::now(), rate_from_ = start_;
  double rate_ = 0, time_s_ = 0;
  bool timed_ = false;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_UPDATE_H_

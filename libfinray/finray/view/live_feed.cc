#include "finray/view/live_feed.h"

namespace finray {

LiveFeed::LiveFeed(std::size_t gauges) : rows_(kRows) {
  for (LiveRow& row : rows_) {
    row.gauges_V.resize(gauges);
    row.history_std_V.reserve(gauges);
  }
}

void LiveFeed::Push(const Measurements& readings, const FrameEstimate& estimate,
                    std::uint64_t latency_ns) {
  const std::size_t at = pushed_.load(std::memory_order_relaxed);
  if (at - popped_.load(std::memory_order_acquire) == kRows) {
    missed_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  LiveRow& row = rows_[at % kRows];
  row.time_s = readings.time_s;
  row.status = estimate.status;
  row.contact = estimate.contact;
  row.p_value = estimate.p_value();
  row.force_N = readings.Force().magnitude_N;
  row.friction = readings.friction;
  row.gauges_V.assign(readings.gauges_V.begin(), readings.gauges_V.end());
  row.history_std_V.assign(readings.history_std_V.begin(),
                           readings.history_std_V.end());
  row.gauge_readings = readings.gauge_readings;
  row.latency_ns = latency_ns;
  pushed_.store(at + 1, std::memory_order_release);
}

bool LiveFeed::Pop(LiveRow* row) {
  const std::size_t at = popped_.load(std::memory_order_relaxed);
  if (at == pushed_.load(std::memory_order_acquire)) return false;
  *row = rows_[at % kRows];  // a swap would take the memory that Push() needs
  popped_.store(at + 1, std::memory_order_release);
  return true;
}

}  // namespace finray

#ifndef FINRAY_VIEW_LIVE_VIEW_H_
#define FINRAY_VIEW_LIVE_VIEW_H_

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "finray/view/live_feed.h"
#include "finray/view/live_server.h"
#include "finray/view/live_update.h"
#include "finray/view/live_zero.h"

namespace finray {

/// A live log on a page: takes rows from the thread that estimates them and
/// serves updates of them, some a second. The estimating thread never waits.
class LiveView {
 public:
  /// Throws InputError if the port cannot be had.
  LiveView(const Finger& finger, const Scene& scene,
           const Discretization& discretization, double updates_Hz,
           const ServeSettings& settings, LiveZero::Make make);
  ~LiveView();

  int port() const { return server_.port(); }

  /// Shows a row; for the estimating thread.
  void Push(const LiveRows& rows, std::uint64_t latency_ns) {
    feed_.Push(rows.readings(), rows.estimate(), latency_ns);
    zero_.Offer(rows.raw());
  }
  /// What estimates the next row, if new offsets are in force from there on;
  /// for the estimating thread.
  std::unique_ptr<LiveEstimator> TakeZeroed() { return zero_.Take(); }
  /// What became of the zero button.
  std::string message() const { return zero_.message(); }

 private:
  void Publish(double updates_Hz);

  LiveFeed feed_;
  LiveUpdates updates_;
  LiveZero zero_;
  LiveHub hub_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ending_ = false;  // by the mutex
  LiveServer server_;
  std::thread publisher_;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_VIEW_H_

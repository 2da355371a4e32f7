#ifndef FINRAY_VIEW_LIVE_ZERO_H_
#define FINRAY_VIEW_LIVE_ZERO_H_

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "finray/batch/live_rows.h"

namespace finray {

/// What estimates the rows of a live log.
struct LiveEstimator {
  LiveEstimator(std::unique_ptr<FrameEstimator> own, const Scene& scene,
                const FrameParser& parser, const ResultFormat& format)
      : estimator(std::move(own)),
        rows(estimator->finger(), scene, parser, estimator.get(), format) {}

  const std::unique_ptr<FrameEstimator> estimator;
  LiveRows rows;
};

/// The zero button: new offsets from the next kRows rows, as finray_zero sets
/// them, while rows are estimated with the old ones. Rows and means are
/// collected by the estimating thread; all that takes time is done by another.
class LiveZero {
 public:
  /// Makes an estimator of a finger.
  using Make = std::function<std::unique_ptr<LiveEstimator>(const Finger&)>;

  /// `friction` is that of the contacts that rows are tried with.
  LiveZero(const Finger& finger, const Discretization& discretization,
           Make make, double friction = 0);
  ~LiveZero();

  // Any thread:

  /// Asks for new offsets. Returns what to tell the user.
  std::string Request();
  /// From a request until its estimator is taken.
  bool busy() const { return state_.load() != State::kIdle; }
  /// What became of the last request; "" before the first.
  std::string message() const;
  /// The finger with the offsets in force.
  Finger finger() const;

  // The thread that estimates:

  /// Takes the readings of a row as they were read, if somebody has asked.
  void Offer(const Measurements& raw) {
    if (state_.load(std::memory_order_relaxed) == State::kIdle) return;
    Collect(raw);
  }
  /// Returns the new estimator once it is made; else nullptr.
  std::unique_ptr<LiveEstimator> Take();

  static constexpr std::size_t kRows = 100;  // finray_zero --follow

 private:
  enum class State { kIdle, kAsked, kMaking, kMade, kFailed };

  void Collect(const Measurements& raw);
  void MakeZeroed();

  Discretization discretization_;
  Make make_;
  double friction_;
  std::atomic<State> state_{State::kIdle};
  std::vector<Measurements> free_rows_;
  std::thread worker_;
  std::unique_ptr<LiveEstimator> made_;
  mutable std::mutex mutex_;  // of what follows
  Finger finger_, zeroed_;
  std::string message_, words_;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_ZERO_H_

#ifndef FINRAY_VIEW_LIVE_HUB_H_
#define FINRAY_VIEW_LIVE_HUB_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace finray {

/// The last updates, for any number of readers of any speed. A reader that is
/// slower than kUpdates updates misses some; nobody waits for it.
class LiveHub {
 public:
  using Update = std::shared_ptr<const std::string>;
  struct News {
    std::vector<Update> updates;
    bool closed = false;  ///< No update follows these.
  };

  void Publish(std::string update);
  /// There will be no more updates.
  void Close();

  /// The number of updates so far: where a new reader begins.
  std::uint64_t count() const;
  /// Returns the updates from number `*next` on, and sets `*next` behind them.
  /// Waits for the first one, or for the end, for at most `wait`.
  News After(std::uint64_t* next, std::chrono::milliseconds wait) const;

  static constexpr std::size_t kUpdates = 64;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable news_;
  std::deque<Update> updates_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_HUB_H_

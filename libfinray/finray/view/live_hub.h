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

/// The last updates, for any number of readers of any speed. A new reader gets
/// the last kKept ones. From then on one that is slower than kUpdates updates
/// misses some; nobody waits for it.
class LiveHub {
 public:
  using Update = std::shared_ptr<const std::string>;
  struct News {
    std::vector<Update> updates;  ///< At most kUpdates.
    bool past = false;            ///< They came before the reader did.
    bool closed = false;          ///< No update follows these.
  };
  /// Where a reader is.
  struct Reader {
    std::uint64_t next = 0;  ///< The number of the update that it gets next.
    bool in_past = true;
  };

  void Publish(std::string update);
  /// There will be no more updates.
  void Close();

  /// Returns what comes next for a reader, and moves it behind that. Waits for
  /// the first update, or for the end, for at most `wait`.
  News Next(Reader* reader, std::chrono::milliseconds wait) const;

  static constexpr std::size_t kUpdates = 64;
  /// As many as the rings of a page: ten minutes at 20 a second.
  static constexpr std::size_t kKept = 12000;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable news_;
  std::deque<Update> updates_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
};

}  // namespace finray

#endif  // FINRAY_VIEW_LIVE_HUB_H_

#ifndef FINRAY_APPS_HEARTBEAT_H_
#define FINRAY_APPS_HEARTBEAT_H_

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace finray {

/// Prints what a long run does, every kEverySeconds on stderr: "12 s: 250
/// frames, iteration 7". A short run prints nothing.
class Heartbeat {
 public:
  static constexpr int kEverySeconds = 5;

  Heartbeat() : thread_([this] { Beat(); }) {}
  ~Heartbeat();

  /// Says what the run does now, from any thread.
  void Say(const std::string& step);

 private:
  void Beat();

  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopped_ = false;
  std::string step_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace finray

#endif  // FINRAY_APPS_HEARTBEAT_H_

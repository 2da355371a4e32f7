#include "heartbeat.h"

#include <chrono>
#include <cstdio>

namespace finray {

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
  }
  stop_.notify_one();
  thread_.join();
}

void Heartbeat::Say(const std::string& step) {
  const std::lock_guard<std::mutex> lock(mutex_);
  step_ = step;
}

void Heartbeat::Beat() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto every = std::chrono::seconds(kEverySeconds);
  for (int beats = 1; !stop_.wait_for(lock, every, [&] { return stopped_; });
       ++beats) {
    if (step_.empty()) continue;  // the logs are being read
    std::fprintf(stderr, "%d s: %s\n", beats * kEverySeconds, step_.c_str());
  }
}

}  // namespace finray

#include "finray/view/live_hub.h"

#include <algorithm>
#include <utility>

namespace finray {

void LiveHub::Publish(std::string update) {
  auto shared = std::make_shared<const std::string>(std::move(update));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    updates_.push_back(std::move(shared));
    if (updates_.size() > kUpdates) updates_.pop_front();
    ++count_;
  }
  news_.notify_all();
}

void LiveHub::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  news_.notify_all();
}

std::uint64_t LiveHub::count() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return count_;
}

LiveHub::News LiveHub::After(std::uint64_t* next,
                             std::chrono::milliseconds wait) const {
  std::unique_lock<std::mutex> lock(mutex_);
  news_.wait_for(lock, wait, [&] { return closed_ || count_ > *next; });
  const std::uint64_t oldest = count_ - updates_.size();
  const auto first = std::min(count_, std::max(*next, oldest)) - oldest;
  *next = count_;
  // Both under one lock, so that no update comes between them.
  return {
      {updates_.begin() + static_cast<std::ptrdiff_t>(first), updates_.end()},
      closed_};
}

}  // namespace finray

#include "finray/view/live_hub.h"

#include <algorithm>
#include <utility>

namespace finray {

void LiveHub::Publish(std::string update) {
  auto shared = std::make_shared<const std::string>(std::move(update));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    updates_.push_back(std::move(shared));
    if (updates_.size() > kKept) updates_.pop_front();
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

LiveHub::News LiveHub::Next(Reader* reader,
                            std::chrono::milliseconds wait) const {
  std::unique_lock<std::mutex> lock(mutex_);
  news_.wait_for(lock, wait, [&] { return closed_ || count_ > reader->next; });
  const std::uint64_t kept = updates_.size(), oldest = count_ - kept;
  const bool past = reader->in_past;
  const std::uint64_t least =
      past ? oldest : count_ - std::min<std::uint64_t>(kept, kUpdates);
  const std::uint64_t first = std::min(count_, std::max(reader->next, least));
  const std::uint64_t end = std::min<std::uint64_t>(count_, first + kUpdates);
  reader->next = end;
  reader->in_past = past && end < count_;
  const auto at = [&](std::uint64_t number) {
    return updates_.begin() + static_cast<std::ptrdiff_t>(number - oldest);
  };
  // All under one lock, so that no update comes between them and the end.
  return {{at(first), at(end)}, past, closed_ && end == count_};
}

}  // namespace finray

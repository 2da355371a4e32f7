#include "progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace finray {

ProgressBar::ProgressBar(std::size_t total)
    : total_(std::max<std::size_t>(total, 1)),
      shown_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

void ProgressBar::Add(std::size_t frames, bool kept) {
  (kept ? kept_ : done_) += frames;
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  constexpr int kWidth = 30;
  const std::size_t reached = std::min(done_ + kept_, total_);
  const double share =
      static_cast<double>(reached) / static_cast<double>(total_);
  const double rate = static_cast<double>(done_) / std::max(seconds(), 1e-6);
  const auto left = static_cast<long>(static_cast<double>(total_ - reached) /
                                      std::max(rate, 1e-6));
  std::string bar(static_cast<std::size_t>(kWidth * share), '#');
  bar.resize(kWidth, ' ');
  std::fprintf(stderr,
               "\r[%s] %3d %%  %.0f frames/s  %ld:%02ld:%02ld left\033[K",
               bar.c_str(), static_cast<int>(100 * share), rate, left / 3600,
               left / 60 % 60, left % 60);
  std::fflush(stderr);
}

void ProgressBar::Clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace finray

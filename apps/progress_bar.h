#ifndef FINRAY_APPS_PROGRESS_BAR_H_
#define FINRAY_APPS_PROGRESS_BAR_H_

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

namespace finray {

/// How far a run is, on one line of stderr if that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total)
      : total_(std::max<std::size_t>(total, 1)),
        shown_(isatty(STDERR_FILENO) != 0),
        start_(Clock::now()),
        last_(start_) {}
  ~ProgressBar() { Clear(); }

  /// Frames that were `kept` from an earlier run count, but not for the rate.
  void Add(std::size_t frames, bool kept) {
    (kept ? kept_ : done_) += frames;
    const Clock::time_point now = Clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    const std::string line = Line(seconds());
    std::fprintf(stderr, "\r%s\033[K", line.c_str());
    std::fflush(stderr);
  }

  /// Takes the line away, for others to write.
  void Clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }

  /// Frames done by this run, and kept.
  std::size_t done() const { return done_; }
  std::size_t kept() const { return kept_; }
  double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

  /// "[####      ]  42 %  1234 frames/s  0:12:34 left" after so many seconds.
  std::string Line(double seconds) const {
    constexpr int kWidth = 30;
    const std::size_t reached = std::min(done_ + kept_, total_);
    const double share =
        static_cast<double>(reached) / static_cast<double>(total_);
    const double rate = static_cast<double>(done_) / std::max(seconds, 1e-6);
    const auto left = static_cast<long>(static_cast<double>(total_ - reached) /
                                        std::max(rate, 1e-6));
    std::string bar(static_cast<std::size_t>(kWidth * share), '#');
    bar.resize(kWidth, ' ');
    char text[128];
    std::snprintf(text, sizeof text,
                  "[%s] %3d %%  %.0f frames/s  %ld:%02ld:%02ld left",
                  bar.c_str(), static_cast<int>(100 * share), rate, left / 3600,
                  left / 60 % 60, left % 60);
    return text;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t total_, done_ = 0, kept_ = 0;
  bool shown_;
  Clock::time_point start_, last_;
};

}  // namespace finray

#endif  // FINRAY_APPS_PROGRESS_BAR_H_

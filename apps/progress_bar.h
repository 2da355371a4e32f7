#ifndef FINRAY_APPS_PROGRESS_BAR_H_
#define FINRAY_APPS_PROGRESS_BAR_H_

#include <chrono>
#include <cstddef>

namespace finray {

/// Shows the progress of a run on one line of stderr, if that is a terminal:
/// "[####      ]  42 %  1234 frames/s  0:12:34 left".
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar() { Clear(); }

  /// Adds frames. Those `kept` from an earlier run do not count for the rate.
  void Add(std::size_t frames, bool kept);

  /// Removes the line, so that others can write.
  void Clear();

  std::size_t done() const { return done_; }  ///< Frames of this run.
  std::size_t kept() const { return kept_; }
  double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t total_, done_ = 0, kept_ = 0;
  bool shown_;
  Clock::time_point start_, last_;
};

}  // namespace finray

#endif  // FINRAY_APPS_PROGRESS_BAR_H_

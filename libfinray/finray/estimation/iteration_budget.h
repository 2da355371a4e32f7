#ifndef FINRAY_ESTIMATION_ITERATION_BUDGET_H_
#define FINRAY_ESTIMATION_ITERATION_BUDGET_H_

#include <algorithm>
#include <limits>
#include <optional>

namespace finray {

/// Counts the iterations of a frame's searches against two limits:
/// Scene::search_iteration_limit for all of them, and one of each search.
class IterationBudget {
 public:
  static constexpr int kUnlimited = std::numeric_limits<int>::max();

  explicit IterationBudget(std::optional<int> frame_limit)
      : frame_limit_(frame_limit.value_or(kUnlimited)) {}

  void BeginFrame() {
    frame_ = 0;
    ended_ = false;
  }
  void BeginSearch(int limit = kUnlimited) {
    search_ = 0;
    search_limit_ = limit;
  }

  /// Returns true if another fit may begin.
  bool MayGoOn() {
    if (search_ >= search_limit_) return false;
    ended_ |= left_of_frame() < 1;
    return left_of_frame() > 0;
  }
  /// Counts the iterations of a fit.
  void Spend(int iterations, bool converged) {
    search_ += iterations;
    frame_ += iterations;
    ended_ |= left_of_frame() < 1 && !converged;
  }

  bool limits_frames() const { return frame_limit_ < kUnlimited; }
  int left_of_frame() const { return frame_limit_ - frame_; }
  int left() const {
    return std::min(left_of_frame(), search_limit_ - search_);
  }
  /// Returns the number of iterations of the present search.
  int spent() const { return search_; }
  /// The limit of the frame has ended a search with starts left to try.
  bool ended() const { return ended_; }

 private:
  int frame_limit_, search_limit_ = kUnlimited;
  int frame_ = 0, search_ = 0;
  bool ended_ = false;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_ITERATION_BUDGET_H_

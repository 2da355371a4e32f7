#ifndef FINRAY_RESIDUALS_LINEAR_SIGNAL_H_
#define FINRAY_RESIDUALS_LINEAR_SIGNAL_H_

#include <vector>

namespace finray {

/// A signal that was sampled at rising times and runs linearly between them.
/// Before the first sample and behind the last one it stands still.
class LinearSignal {
 public:
  /// Appends a sample. One that is NaN, or not later than the last one kept, is
  /// left out, so a row's own reading is not At() its time where times tie.
  void Add(double time_s, double value);

  /// The value at a time and its derivative by time; at a sample the mean of
  /// those on both sides. NaN without any sample.
  struct Point {
    double value, slope;
  };
  Point At(double time_s) const;
  /// How much later the signal is than at a time: S(t + by) - S(t), and its
  /// derivative by `by`. Exactly 0 for `by` = 0, whatever the samples. 0
  /// without a sample or a time.
  Point Change(double time_s, double by_s) const;

 private:
  std::vector<double> times_s_, values_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_LINEAR_SIGNAL_H_

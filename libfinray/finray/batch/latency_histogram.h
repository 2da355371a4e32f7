#ifndef FINRAY_BATCH_LATENCY_HISTOGRAM_H_
#define FINRAY_BATCH_LATENCY_HISTOGRAM_H_

#include <array>
#include <cstddef>
#include <cstdint>

namespace finray {

/// Quantiles of any number of times in fixed memory. Each power of two of
/// nanoseconds has 64 buckets, so a quantile is off by at most 0.8 %.
class LatencyHistogram {
 public:
  void Add(std::uint64_t nanoseconds);

  std::uint64_t count() const { return count_; }
  /// Returns the time in ns that a share (0 to 1) of all times does not exceed:
  /// the middle of its bucket, or 0 if there are none.
  double Quantile(double share) const;
  /// The largest time in ns; exact.
  std::uint64_t max() const { return max_; }

 private:
  static constexpr int kBits = 6;  // 2^kBits buckets in a power of two
  static constexpr std::size_t kBuckets = (64 - kBits + 1) << kBits;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0, max_ = 0;
};

}  // namespace finray

#endif  // FINRAY_BATCH_LATENCY_HISTOGRAM_H_

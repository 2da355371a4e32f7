#ifndef FINRAY_BATCH_LATENCY_HISTOGRAM_H_
#define FINRAY_BATCH_LATENCY_HISTOGRAM_H_

#include <array>
#include <cstddef>
#include <cstdint>

namespace finray {

/// Quantiles of any number of times in fixed memory: each power of two of
/// nanoseconds has 64 buckets, so that a quantile is off by 0.8 % at most.
class LatencyHistogram {
 public:
  void Add(std::uint64_t nanoseconds);

  std::uint64_t count() const { return count_; }
  /// The time that a share of all, between 0 and 1, does not exceed: the
  /// middle of its bucket; 0 if there is none.
  double Quantile(double share) const;
  /// Exact.
  std::uint64_t max() const { return max_; }

 private:
  static constexpr int kBits = 6;  // of buckets in a power of two
  static constexpr std::size_t kBuckets = (64 - kBits + 1) << kBits;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0, max_ = 0;
};

}  // namespace finray

#endif  // FINRAY_BATCH_LATENCY_HISTOGRAM_H_

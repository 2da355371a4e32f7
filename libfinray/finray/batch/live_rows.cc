#include "finray/batch/live_rows.h"

#include <algorithm>
#include <cmath>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"

namespace finray {

LiveRows::LiveRows(const Finger& finger, const Scene& scene,
                   const FrameParser& parser, FrameEstimator* estimator,
                   const ResultFormat& format)
    : parser_(parser),
      layout_(finger, scene, parser_, format),
      estimator_(*estimator),
      history_(finger, scene),
      offsets_wander_(scene.gauge_offset_walk.has_value()) {
  RequireTimeForCreep(finger, parser_.names(), parser_.path());
  const std::vector<std::string>& names = parser_.names();
  if (offsets_wander_ &&
      std::find(names.begin(), names.end(), "time_s") == names.end()) {
    throw InputError(parser_.path() + ": " + NoColumn("time_s", names) +
                     "; the scene's gauge_offset_walk needs it");
  }
  estimator_.Restart();
  estimator_.Prepare();
}

const std::string& LiveRows::Next(const CsvLine& line) {
  rows_.Clear();
  row_.clear();
  error_.clear();
  try {
    parser_.Parse(line, &rows_);
    layout_.Read(rows_, 0, &readings_);
    if (offsets_wander_ && std::isnan(readings_.time_s)) {
      throw InputError(
          "time_s: is missing; the scene's gauge_offset_walk needs it");
    }
    if (!history_.empty()) {
      raw_ = readings_;
      history_.Remove(&readings_);
    }
  } catch (const InputError& error) {
    error_ = error.what();
    readings_ = {};
    readings_.gauges_V.assign(estimator_.finger().gauges.size(), std::nan(""));
    raw_ = readings_;
  }
  estimate_ = estimator_.Next(readings_);
  layout_.Append(rows_, 0, readings_, estimate_, &values_, &row_);
  return row_;
}

void LatencyHistogram::Add(std::uint64_t nanoseconds) {
  ++count_;
  max_ = std::max(max_, nanoseconds);
  // A bucket is the leading bit and the kBits bits behind it: value >> shift,
  // in [2^kBits, 2^(kBits + 1)) for shift > 0. Smaller values have a bucket
  // each.
  std::uint64_t value = nanoseconds;
  std::size_t shift = 0;
  while (value >= std::uint64_t{2} << kBits) {
    value >>= 1;
    ++shift;
  }
  ++buckets_[(shift << kBits) + value];
}

double LatencyHistogram::Quantile(double share) const {
  if (count_ == 0) return 0;
  const auto rank = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(
             std::ceil(share * static_cast<double>(count_))));
  std::uint64_t seen = 0;
  std::size_t bucket = 0;
  while ((seen += buckets_[bucket]) < rank) ++bucket;
  constexpr std::size_t kFirst = std::size_t{1} << kBits;
  const std::size_t shift = bucket < 2 * kFirst ? 0 : (bucket >> kBits) - 1;
  const auto low = static_cast<double>(bucket - (shift << kBits));
  const double middle = shift == 0 ? low : low + 0.5;
  return std::min(std::ldexp(middle, static_cast<int>(shift)),
                  static_cast<double>(max_));
}

}  // namespace finray

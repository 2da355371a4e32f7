#ifndef FINRAY_BENCHMARK_RECOMMENDATION_H_
#define FINRAY_BENCHMARK_RECOMMENDATION_H_

#include <string>
#include <vector>

#include "finray/benchmark/measurement.h"
#include "finray/benchmark/noise_floor.h"
#include "finray/benchmark/statistics.h"

namespace finray {

/// Returns true if `a`, which takes `time_ratio` times the time of `b`, is a
/// better choice than `b`. It then
///  - is 15 % faster, more than two runs on one machine differ by, or has at
///    most two thirds of the error();
///  - is no worse in the other of the two, to 5 % in time and 2 % in error();
///  - has no other error (l_c, f_c, tip, gauges) above twice that of `b`.
bool Dominates(const Measurement& a, const Measurement& b, double time_ratio);

/// The Pareto front of one task and scene: the settings that solve every frame
/// and that no other such setting dominates.
struct SceneFront {
  std::string task, scene;
  std::vector<std::size_t> front;  ///< Indices, by increasing time.
};
std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all);

/// The best setting for one use, out of those measured with one contact.
struct Recommendation {
  std::string use;  ///< 30_Hz, 1_kHz, batch, reference
  std::string why;  ///< The rule, in words.
  double limit_us;  ///< Period of the use; NaN: none.
  std::string id;   ///< Empty if no setting serves.
  double time_us;   ///< slow_frame_us where it is known, else the median.
  double error_mm;  ///< Of l_c.
  double margin() const { return limit_us / time_us; }
};

/// Recommends a setting for each use:
///  - 30_Hz and 1_kHz: the most accurate live estimate whose slow frames take a
///    tenth of the period at most. Settings with no error above twice the least
///    count as equally accurate; of these the fastest is taken, or the default
///    if it takes at most 1.25 times as long.
///  - batch: the fastest estimate of a log that is enough against the noise.
///  - reference: the most accurate setting of all that sense.
std::vector<Recommendation> Recommend(const std::vector<Measurement>& all,
                                      const NoiseFloor& one_contact);

/// A setting is enough against the noise if its errors of l_c and f_c (rms) are
/// at most this share of what the gauges' noise leaves. Both together are then
/// at most 3 % larger than the noise alone: sqrt(1 + 0.25^2).
constexpr double kShareOfNoise = 0.25;

/// The fastest setting that is enough and that none of these dominates, for one
/// way of use of one contact.
struct EnoughSetting {
  std::string default_id;
  std::string id;     ///< That of the default if nothing else is as fast.
  std::string words;  ///< Its SettingLabel::words.
  double contact_rms_mm, normal_rms_N;
  /// The time of the default over its own, and the 95 % interval.
  double times_faster;
  Interval interval;
};
/// Returns one for each way of use whose default was measured, where something
/// is enough.
std::vector<EnoughSetting> EnoughAgainstNoise(
    const std::vector<Measurement>& all, const NoiseFloor& one_contact);

/// Tells whether the default is a good choice for one way of use. It is, if it
/// lies on the Pareto front of the settings for that use and none of
/// them is both 20 % faster and more accurate. A setting is faster if the 95 %
/// interval of the ratio of times over the rounds lies below 1.
struct DefaultCheck {
  std::string id;
  std::vector<std::string> dominated_by;  ///< Ids.
  std::vector<std::string> better;        ///< 20 % faster and more accurate.
  /// The fastest setting whose error() is at most twice that of the default,
  /// and its time over that of the default.
  std::string rival;
  double rival_time = 1;
  Interval rival_interval = {1, 1};
  bool on_front() const { return dominated_by.empty(); }
  bool holds() const { return on_front() && better.empty(); }
};
std::vector<DefaultCheck> CheckDefaults(const std::vector<Measurement>& all);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RECOMMENDATION_H_

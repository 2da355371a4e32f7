#include "finray/benchmark/recommendation.h"

#include <algorithm>
#include <cmath>

#include "finray/benchmark/pareto.h"

namespace finray {
namespace {

constexpr double kShareOfPeriod = 0.1;
// A hundredth of the std of l_c by noise of 1e-4 rad, 0.15 .. 0.33 mm.
constexpr double kBatchError_mm = 1e-3;
// What ends of iterations differ by is no accuracy.
constexpr double kSame = 2;
constexpr double kAsFast = 1.25;
// Below this, in mm, N or rad, all is equally accurate.
constexpr double kNoError = 1e-9;

using Candidates = std::vector<const Measurement*>;

Candidates Of(const std::vector<Measurement>& all, const std::string& task,
              const std::string& how) {
  Candidates found;
  for (const Measurement& m : all) {
    if (m.name.task == task && m.name.scene == "one_contact" &&
        (how.empty() || m.name.how == how) && m.solved_percent == 100) {
      found.push_back(&m);
    }
  }
  return found;
}

double TimeOf(const Measurement& m) {
  return std::isnan(m.slow_frame_us) ? m.median_us() : m.slow_frame_us;
}

// The least of each error among candidates.
BenchmarkErrors Least(const Candidates& candidates) {
  BenchmarkErrors least;
  const auto lower = [](double* value, double other) {
    other = std::max(other, kNoError);
    if (!(*value <= other)) *value = other;
  };
  for (const Measurement* m : candidates) {
    lower(&least.contact_mm, m->errors.contact_mm);
    lower(&least.normal_N, m->errors.normal_N);
    lower(&least.tip_mm, m->errors.tip_mm);
    lower(&least.gauges_rad, m->errors.gauges_rad);
  }
  return least;
}

// The fastest of those with no error above twice the least, or the default if
// it is one of them and about as fast: measured times are noisy, and the
// default refines its mesh under loads that no other scheme was measured with.
const Measurement* MostAccurate(const Candidates& candidates) {
  const BenchmarkErrors least = Least(candidates);
  const Measurement *best = nullptr, *ours = nullptr;
  for (const Measurement* m : candidates) {
    const BenchmarkErrors& e = m->errors;
    if (e.contact_mm > kSame * least.contact_mm ||
        e.normal_N > kSame * least.normal_N ||
        e.tip_mm > kSame * least.tip_mm ||
        e.gauges_rad > kSame * least.gauges_rad) {
      continue;
    }
    if (best == nullptr || m->ratio() < best->ratio()) best = m;
    if (m->name.solver == "default") ours = m;
  }
  if (ours != nullptr && ours->ratio() < kAsFast * best->ratio()) return ours;
  return best;
}

Recommendation Made(const char* use, const char* why, double limit_us,
                    const Measurement* m) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (m == nullptr) return {use, "", why, limit_us, nan, nan, nan};
  return {use,
          m->name.id(),
          why,
          limit_us,
          TimeOf(*m),
          limit_us / TimeOf(*m),
          m->errors.contact_mm};
}

Recommendation ForRate(const char* use, double period_us,
                       const std::vector<Measurement>& all) {
  Candidates fast;
  for (const Measurement* m : Of(all, "estimation", "live")) {
    if (TimeOf(*m) <= kShareOfPeriod * period_us) fast.push_back(m);
  }
  return Made(use,
              "the most accurate live estimate in a tenth of the period, of "
              "equal ones the fastest",
              period_us, MostAccurate(fast));
}

}  // namespace

std::vector<Recommendation> Recommend(const std::vector<Measurement>& all) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Measurement* batch = nullptr;
  for (const Measurement* m : Of(all, "estimation", "block")) {
    if (m->errors.contact_mm <= kBatchError_mm &&
        (batch == nullptr || m->ratio() < batch->ratio())) {
      batch = m;
    }
  }
  return {ForRate("30_Hz", 1e6 / 30, all), ForRate("1_kHz", 1e3, all),
          Made("batch",
               "the fastest estimate of logs with l_c off by 1e-3 mm at most",
               nan, batch),
          Made("reference", "the most accurate, of equal ones the fastest", nan,
               MostAccurate(Of(all, "sensing", "")))};
}

std::vector<DefaultCheck> CheckDefaults(const std::vector<Measurement>& all) {
  constexpr double kConfidence = 0.95;
  constexpr double kMuchFaster = 0.8;
  static const struct {
    const char *task, *how;
  } kUses[] = {{"estimation", "block"},
               {"estimation", "live"},
               {"sensing", "lanes"},
               {"sensing", "alone"}};
  std::vector<DefaultCheck> checks;
  for (const auto& [task, how] : kUses) {
    const Candidates candidates = Of(all, task, how);
    const auto found =
        std::find_if(candidates.begin(), candidates.end(),
                     [](const auto* m) { return m->name.solver == "default"; });
    if (found == candidates.end()) continue;
    const Measurement& ours = **found;
    DefaultCheck check;
    check.id = ours.name.id();
    for (const Measurement* other : candidates) {
      if (other == &ours) continue;
      const std::string id = other->name.id();
      const double ratio = other->ratio() / ours.ratio();
      const Interval interval =
          RatioOfQuantiles(ours.ratios(), other->ratios(),
                           Measurement::kUndisturbed, kConfidence);
      const double our_error = PointOf(ours).error;
      const double error = PointOf(*other).error;
      // The longest that its time may be.
      if (DominatesSetting(*other, ours, interval.high)) {
        check.dominated_by.push_back(id);
      }
      if (interval.high < kMuchFaster && kSameError * error < our_error) {
        check.better.push_back(id);
      }
      if (error <= kSame * our_error &&
          (check.rival.empty() || ratio < check.rival_time)) {
        check.rival = id;
        check.rival_time = ratio;
        check.rival_interval = interval;
      }
    }
    check.on_front = check.dominated_by.empty();
    checks.push_back(check);
  }
  return checks;
}

}  // namespace finray

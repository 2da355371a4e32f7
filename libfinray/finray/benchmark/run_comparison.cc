#include "finray/benchmark/run_comparison.h"

#include <algorithm>
#include <cmath>

#include "finray/io/number_text.h"

namespace finray {
namespace {

constexpr double kConfidence = 0.99;
constexpr double kWorse = 1.5;
// With less rounds an interval says nothing.
constexpr std::size_t kLeastRounds = 3;
// What another order of summation may change, in mm, N, % and rad.
constexpr double kRoundingSpread = 1e-8;

void AddIfWorse(const char* what, double a, double b, std::string* words) {
  if (!(b > kWorse * a && b > kRoundingSpread) && !(std::isnan(b) && a >= 0))
    return;
  *words += std::string(words->empty() ? "" : ", ") + what + " " +
            NumberText(a) + " -> " + NumberText(b);
}

std::string WhatIsWorse(const Measurement& a, const Measurement& b) {
  std::string words;
  AddIfWorse("contact_mm", a.errors.contact_mm, b.errors.contact_mm, &words);
  AddIfWorse("normal_N", a.errors.normal_N, b.errors.normal_N, &words);
  AddIfWorse("tip_mm", a.errors.tip_mm, b.errors.tip_mm, &words);
  AddIfWorse("gauges_rad", a.errors.gauges_rad, b.errors.gauges_rad, &words);
  if (b.solved_percent < a.solved_percent) {
    words += (words.empty() ? "" : ", ") + std::string("solved ") +
             NumberText(a.solved_percent) + " % -> " +
             NumberText(b.solved_percent) + " %";
  }
  return words;
}

// Other programs are no business of this gate.
bool IsPeer(const Measurement& m) { return m.name.how == "peer"; }

void AddDifference(const char* what, const std::string& a, const std::string& b,
                   std::vector<std::string>* differences) {
  if (a != b) {
    differences->push_back(std::string(what) + ": " + a + " against " + b);
  }
}

}  // namespace

const char* SpeedVerdictName(SpeedVerdict verdict) {
  switch (verdict) {
    case SpeedVerdict::kFaster:
      return "faster";
    case SpeedVerdict::kSlower:
      return "slower";
    case SpeedVerdict::kSame:
      return "same";
    case SpeedVerdict::kUndecided:
      break;
  }
  return "undecided";
}

SpeedVerdict JudgeSpeed(const Interval& ratio, double band) {
  const double high = 1 + band, low = 1 / high;
  if (ratio.low > high) return SpeedVerdict::kSlower;
  if (ratio.high < low) return SpeedVerdict::kFaster;
  if (ratio.low >= low && ratio.high <= high) return SpeedVerdict::kSame;
  return SpeedVerdict::kUndecided;
}

int BenchmarkComparison::Count(SpeedVerdict verdict) const {
  return static_cast<int>(
      std::count_if(settings.begin(), settings.end(),
                    [&](const auto& one) { return one.speed == verdict; }));
}

int BenchmarkComparison::CountWorse() const {
  return static_cast<int>(
      std::count_if(settings.begin(), settings.end(),
                    [](const auto& one) { return !one.worse.empty(); }));
}

BenchmarkComparison CompareRuns(const BenchmarkRun& a, const BenchmarkRun& b,
                                double most_slowdown) {
  BenchmarkComparison comparison;
  AddDifference("machine", a.machine.cpu, b.machine.cpu,
                &comparison.differences);
  AddDifference("instruction set", a.machine.instruction_set,
                b.machine.instruction_set, &comparison.differences);
  AddDifference("compiler", a.build.compiler, b.build.compiler,
                &comparison.differences);
  AddDifference("flags", a.build.flags, b.build.flags, &comparison.differences);
  AddDifference("version", a.build.version, b.build.version,
                &comparison.differences);
  AddDifference("finger sha256", a.finger_sha256, b.finger_sha256,
                &comparison.differences);
  AddDifference("depth", a.quick ? "quick" : "full", b.quick ? "quick" : "full",
                &comparison.differences);
  const auto find = [](const BenchmarkRun& run, const std::string& id) {
    return std::find_if(
        run.settings.begin(), run.settings.end(),
        [&](const Measurement& m) { return m.name.id() == id; });
  };
  for (const Measurement& of_a : a.settings) {
    if (IsPeer(of_a)) continue;
    const std::string id = of_a.name.id();
    const auto of_b = find(b, id);
    if (of_b == b.settings.end()) {
      comparison.only_a.push_back(id);
      continue;
    }
    SettingComparison one;
    one.id = id;
    one.ratio = of_b->ratio() / of_a.ratio();
    if (std::min(of_a.time_us.size(), of_b->time_us.size()) >= kLeastRounds) {
      one.interval = RatioOfQuantiles(of_a.ratios(), of_b->ratios(),
                                      Measurement::kUndisturbed, kConfidence);
    }
    one.speed = JudgeSpeed(one.interval, most_slowdown);
    one.worse = WhatIsWorse(of_a, *of_b);
    comparison.settings.push_back(one);
  }
  for (const Measurement& of_b : b.settings) {
    if (IsPeer(of_b)) continue;
    const std::string id = of_b.name.id();
    if (find(a, id) == a.settings.end()) comparison.only_b.push_back(id);
  }
  return comparison;
}

}  // namespace finray

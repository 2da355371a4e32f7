#include "finray/benchmark/run_comparison.h"

#include <algorithm>
#include <cmath>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

constexpr double kVerdictConfidence = 0.99;
constexpr double kWorse = 1.5;
// With fewer rounds an interval says nothing.
constexpr std::size_t kLeastRounds = 3;
// Errors, in mm, N and rad, up to which rounding explains a change.
constexpr double kRoundingSpread = 1e-8;

std::string WhatIsWorse(const Measurement& a, const Measurement& b) {
  std::vector<std::string> worse;
  for (const ComparedError& error : kComparedErrors) {
    const double of_a = a.errors.*error.value, of_b = b.errors.*error.value;
    if ((of_b > kWorse * of_a && of_b > kRoundingSpread) ||
        (std::isnan(of_b) && of_a >= 0)) {
      worse.push_back(std::string(error.name) + " " + NumberText(of_a) +
                      " -> " + NumberText(of_b));
    }
  }
  if (b.solved_percent < a.solved_percent) {
    worse.push_back("solved " + NumberText(a.solved_percent) + " % -> " +
                    NumberText(b.solved_percent) + " %");
  }
  return Joined(worse);
}

// The gate leaves other programs out.
bool IsPeer(const Measurement& m) { return m.name.how == "peer"; }

std::vector<std::string> Differences(const BenchmarkRun& a,
                                     const BenchmarkRun& b) {
  std::vector<std::string> differences;
  const auto compare = [&](const char* what, const std::string& of_a,
                           const std::string& of_b) {
    if (of_a == of_b) return;
    differences.push_back(std::string(what) + ": " + of_a + " against " + of_b);
  };
  const auto facts = [&](const char* what, const char* name, Facts of_a,
                         Facts of_b) { compare(what, of_a[name], of_b[name]); };
  facts("machine", "cpu", a.machine, b.machine);
  facts("instruction set", "instruction_set", a.machine, b.machine);
  facts("compiler", "compiler", a.build, b.build);
  facts("flags", "flags", a.build, b.build);
  facts("version", "version", a.build, b.build);
  facts("finger sha256", "sha256", a.finger, b.finger);
  compare("depth", a.quick ? "quick" : "full", b.quick ? "quick" : "full");
  return differences;
}

const Measurement* Find(const BenchmarkRun& run, const std::string& id) {
  for (const Measurement& m : run.settings) {
    if (m.name.id() == id) return &m;
  }
  return nullptr;
}

}  // namespace

const char* SpeedVerdictName(SpeedVerdict verdict) {
  const char* names[] = {"faster", "slower", "same", "undecided"};
  return names[static_cast<int>(verdict)];
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
                                double band) {
  BenchmarkComparison comparison;
  comparison.differences = Differences(a, b);
  for (const Measurement& of_a : a.settings) {
    if (IsPeer(of_a)) continue;
    const std::string id = of_a.name.id();
    const Measurement* of_b = Find(b, id);
    if (of_b == nullptr) {
      comparison.only_a.push_back(id);
      continue;
    }
    SettingComparison one;
    one.id = id;
    one.ratio = of_b->ratio() / of_a.ratio();
    if (std::min(of_a.time_us.size(), of_b->time_us.size()) >= kLeastRounds) {
      one.interval =
          RatioOfQuantiles(of_a.ratios(), of_b->ratios(),
                           Measurement::kUndisturbed, kVerdictConfidence);
    }
    one.speed = JudgeSpeed(one.interval, band);
    one.worse = WhatIsWorse(of_a, *of_b);
    comparison.settings.push_back(one);
  }
  for (const Measurement& of_b : b.settings) {
    const std::string id = of_b.name.id();
    if (!IsPeer(of_b) && Find(a, id) == nullptr) {
      comparison.only_b.push_back(id);
    }
  }
  return comparison;
}

}  // namespace finray

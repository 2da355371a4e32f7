#ifndef FINRAY_TESTS_CALIB_HARD_LOG_H_
#define FINRAY_TESTS_CALIB_HARD_LOG_H_

// Logs as a lab has them on a good day, a bad one and a terrible one.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "calib/standard_log.h"
#include "finray/scene/frame_columns.h"

namespace finray {

struct HardLogKind {
  const char* name;
  int frames;
  double noise = 1;          ///< in units of the standard log's
  double outliers = 0;       ///< share of the frames
  double dropouts = 0;       ///< share of the cells
  double drift_V_per_h = 0;  ///< std of the gauges' rates
};
constexpr HardLogKind kHardLogKinds[] = {
    {"clean", 240},
    {"noisy", 320, 2},
    {"nasty", 400, 1, 0.05, 0.04, 0.05},
};

struct HardLog {
  Finger truth;
  FrameTable log;
  std::set<int> outliers;  ///< rows
};

/// A finger with gains of 1.5 to 2.6 V/rad, ribs off by 0.5 mm at most and
/// stiffness by 25 %, and what it records in a minute for every ten frames.
inline HardLog MakeHardLog(const HardLogKind& kind, unsigned seed) {
  std::mt19937_64 generator(1000 + seed);
  std::normal_distribution<double> normal;
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator);
  };
  HardLog hard;
  hard.truth = PaperFinger();
  Finger& finger = hard.truth;
  finger.front_stiffness_N_mm2 *= uniform(0.75, 1.25);
  finger.back_stiffness_N_mm2 *= uniform(0.75, 1.25);
  for (Gauge& gauge : finger.gauges) {
    gauge.gain_V_per_rad = uniform(1.5, 2.6);
    gauge.offset_V = uniform(-0.08, 0.08);
    gauge.noise_V = kind.noise * 3e-4 * gauge.gain_V_per_rad;
  }
  for (Rib& rib : finger.ribs) rib.length_mm += uniform(-0.5, 0.5);

  FrameTable frames(kind.frames);
  std::vector<double>& x = frames.MutableNumbers("object_x_mm");
  std::vector<double>& y = frames.MutableNumbers("object_y_mm");
  std::vector<double>& time = frames.MutableNumbers("time_s");
  for (int i = 0; i < kind.frames; ++i) {
    time[i] = 6 * i;
    y[i] = uniform(20, 112);
    const double stiffness = 0.85 + 6.5 * std::exp(-(y[i] - 22) / 10) +
                             1.2 * std::exp((y[i] - 118) / 8);
    x[i] = i % 20 == 0 ? -25 : -15 + uniform(0.5, 7) / stiffness;
  }
  EXPECT_EQ(Simulate(finger, StandardScene(), {}, &frames).not_converged, 0);
  hard.log =
      MakeLog(finger, frames, {0.02 * kind.noise, 0.05 * kind.noise, seed});
  FrameTable& log = hard.log;
  const auto gauge = [&](int j) -> std::vector<double>& {
    return log.MutableNumbers(GaugeVolts(j));
  };
  for (int j = 0; j < 4; ++j) {
    const double rate = kind.drift_V_per_h * normal(generator);
    for (int i = 0; i < kind.frames; ++i) gauge(j)[i] += rate * time[i] / 3600;
  }
  const auto sign = [&] { return uniform(0, 1) < 0.5 ? -1 : 1; };
  while (static_cast<double>(hard.outliers.size()) <
         kind.outliers * kind.frames) {
    const int i = static_cast<int>(uniform(0, kind.frames));
    if (!hard.outliers.insert(i).second) continue;
    switch (static_cast<int>(uniform(0, 4))) {
      case 0:  // a spike in a gauge
        gauge(static_cast<int>(uniform(0, 4)))[i] += sign() * uniform(0.03, 1);
        break;
      case 1:  // somebody touches the force sensor
        log.MutableNumbers("force_N")[i] += uniform(0.5, 5);
        break;
      case 2:  // the stage has lost steps
        log.MutableNumbers(uniform(0, 1) < 0.5 ? "object_x_mm"
                                               : "object_y_mm")[i] +=
            sign() * uniform(1, 6);
        break;
      default: {  // gauges of another row
        const int other = (i + kind.frames / 3) % kind.frames;
        for (int j = 0; j < 4; ++j) gauge(j)[i] = gauge(j)[other];
      }
    }
  }
  for (const char* name : {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V",
                           "force_N", "object_x_mm"}) {
    for (double& cell : log.MutableNumbers(name)) {
      if (uniform(0, 1) < kind.dropouts) {
        cell = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
  return hard;
}

/// The nominal finger with unit gains; gauges as noisy as they are.
inline Finger HardStart(const HardLog& hard) {
  Finger start = PaperFinger();
  for (std::size_t j = 0; j < start.gauges.size(); ++j) {
    start.gauges[j].noise_V = hard.truth.gauges[j].noise_V;
  }
  return start;
}

inline Plan HardPlan(const HardLogKind& kind) {
  Plan plan = StandardPlan();
  plan.force_std_N *= kind.noise;
  plan.object_std_mm *= kind.noise;
  if (kind.outliers > 0) {
    plan.loss = RobustLoss::kHuber;
    plan.loss_scale = 2;
  }
  if (kind.drift_V_per_h > 0) {
    FamilyPlan& drift =
        plan.families[static_cast<int>(ParameterFamily::kGaugeDrift)];
    drift.free = true;
    drift.prior_std = 0.2;
  }
  return plan;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_HARD_LOG_H_

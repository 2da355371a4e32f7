// What is named for faults whose truth is known. The logs are simulated by
// finray's own statics, and the faults are added to the readings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "calib/recorded_log.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/io/error.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

using FourVolts = std::array<double, 4>;
using Change = std::function<void(std::size_t row, FourVolts*)>;

FrameTable Changed(FrameTable log, const Change& change) {
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const auto cell = [&](int j) -> double& {
      return log.MutableNumbers("gauge_" + std::to_string(j + 1) + "_V")[i];
    };
    FourVolts volts;
    for (int j = 0; j < 4; ++j) volts[j] = cell(j);
    change(i, &volts);
    for (int j = 0; j < 4; ++j) cell(j) = volts[j];
  }
  return log;
}

FrameTable Touches(unsigned seed = 31) {
  return MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), seed),
                 {0.02, 0.05, seed});
}

// The refusal, or the warning that names the cause.
std::string SaidOf(const FrameTable& log) {
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  CalibrationProblem problem(
      Nominal(), StandardPlan(),
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), StandardPlan()),
      {}, 2);
  try {
    RefuseImplausible(&problem);
  } catch (const InputError& error) {
    return error.what();
  }
  const CalibrationResult result = Calibrate(&problem);
  if (result.Verdict() == "good") return "good";
  for (const Warning& warning : result.warnings) {
    if (warning.code == "doubtful") return warning.text;
  }
  return result.Verdict();
}

TEST(CausesTest, FaultsOfGaugesAreNamedBeforeAnyEffect) {
  const double offset_V = HiddenFinger().gauges[1].offset_V;
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0, 3e-4);
  const struct {
    Change change;
    const char* words;
  } kCases[] = {
      {[](std::size_t row, FourVolts* v) {
         if (row >= 150) (*v)[1] = -0.02;
       },
       "gauge 2 is stuck at -0.02 V from row 151 to 210"},
      {[](std::size_t row, FourVolts* v) {
         if (row >= 60 && row < 90) (*v)[2] = 0.05;
       },
       "gauge 3 is stuck at 0.05 V from row 61 to 90"},
      {[&](std::size_t, FourVolts* v) {
         (*v)[1] = offset_V + noise(generator);
       },
       "gauge 2 is dead"},
      {[](std::size_t, FourVolts* v) { (*v)[3] = std::min((*v)[3], 0.0); },
       "gauge 4 is clipped"},
      {[](std::size_t, FourVolts* v) { (*v)[0] = std::max((*v)[0], 0.02); },
       "gauge 1 is clipped"},
      {[](std::size_t, FourVolts* v) { std::swap((*v)[0], (*v)[2]); },
       "gauges seem to be swapped"},
      {[](std::size_t, FourVolts* v) { (*v)[1] = -(*v)[1]; },
       "gauge_2_V falls where"},
      {[](std::size_t row, FourVolts* v) {
         if (row >= 100) (*v)[1] /= 2;
       },
       "gauge_2_V responds 0.5 times"},
      {[](std::size_t, FourVolts* v) {
         (*v)[2] = std::round((*v)[2] / 0.006) * 0.006;
       },
       "likeliest cause: gauge 3 has steps of 6 mV"},
  };
  for (const auto& one : kCases) {
    EXPECT_THAT(SaidOf(Changed(Touches(), one.change)), HasSubstr(one.words));
  }
}

// Two loads of these shares at these distances in place of each contact.
FrameTable Pressed(double apart_mm, double share) {
  const Finger finger = HiddenFinger();
  FrameTable frames = StandardFrames(finger, 32);
  const FrameTable as_one = frames;
  EquilibriumSolver solver(finger, {});
  for (std::size_t i = 0; i < frames.rows(); ++i) {
    const double at = as_one.Numbers("contact_1_mm")[i];
    const double force = as_one.Numbers("normal_1_N")[i];
    if (!(force > 0)) continue;
    solver.Reset();
    if (!solver.Solve({{at - apart_mm / 2, (1 - share) * force},
                       {std::min(138.0, at + apart_mm / 2), share * force}})) {
      continue;
    }
    for (int j = 0; j < 4; ++j) {
      const std::string gauge = "gauge_" + std::to_string(j + 1);
      frames.MutableNumbers(gauge + "_rad")[i] = solver.gauge_angle(j);
      frames.MutableNumbers(gauge + "_V")[i] =
          finger.gauges[j].Volts(solver.gauge_angle(j));
    }
  }
  return MakeLog(finger, frames, {0.02, 0.05, 32});
}

TEST(CausesTest, NoEffectIsNamedForWhatNoneExplains) {
  for (const auto& [apart_mm, share] :
       {std::pair(10.0, 0.5), std::pair(40.0, 0.5), std::pair(30.0, 0.3)}) {
    EXPECT_THAT(SaidOf(Pressed(apart_mm, share)),
                Not(HasSubstr("residuals look like")))
        << apart_mm;
  }
}

TEST(CausesTest, RowsInAnotherOrderAreNoEffect) {
  const FrameTable log = MakeLog(
      HiddenFinger(), RecordedFrames(HiddenFinger(), 5, 8), {0.02, 0.05, 5});
  std::vector<std::size_t> order(log.rows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(3));
  FrameTable shuffled = log;
  for (const char* name :
       {"time_s", "gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V", "force_N",
        "object_x_mm", "object_y_mm"}) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      shuffled.MutableNumbers(name)[i] = log.Numbers(name)[order[i]];
    }
  }
  EXPECT_THAT(SaidOf(shuffled), AnyOf("good", Not(HasSubstr("look like"))));
}

}  // namespace
}  // namespace finray

#include "finray/calib/problem/repeated_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#include "calib/log_rows.h"
#include "calib/standard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

// Every row of the log `times` times.
FrameTable Repeated(const FrameTable& log, int times) {
  std::vector<std::size_t> rows;
  for (int k = 0; k < times; ++k) {
    for (std::size_t i = 0; i < log.rows(); ++i) rows.push_back(i);
  }
  return RowsOf(log, rows);
}

struct Repetition {
  std::unique_ptr<CalibrationProblem> problem;
  CalibrationResult result;
};

Repetition Solve(const FrameTable& log) {
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  const Plan plan = StandardPlan();
  Repetition solved;
  solved.problem = std::make_unique<CalibrationProblem>(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), plan),
      Discretization(), 2);
  solved.result = Calibrate(solved.problem.get());
  return solved;
}

// A log that is a copy as a whole is an input all the same.
TEST(RepeatedRowsTest, ACopyOfALogIsLeftOut) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 3);
  const std::string copy = folder.Path("copy.csv");
  FrameTable::Read(log).Write(copy);
  const CalibrationLogs logs =
      ReadCalibrationLogs({log, copy}, Nominal(), StandardPlan());
  EXPECT_EQ(logs.paths, std::vector<std::string>{log});
  EXPECT_EQ(logs.left_out, std::vector<std::string>{copy});
  EXPECT_EQ(
      logs.copies,
      "210 of 420 rows have all the numbers of an earlier row, the first of "
      "them copy.csv row 1, which repeats log.csv row 1; they count once; "
      "nothing is left of copy.csv");
}

// A pasted row tells nothing new: the estimates and their std stay.
TEST(RepeatedRowsTest, PastedRowsCountOnce) {
  const TempFolder folder;
  const FrameTable once =
      FrameTable::Read(StandardLog(folder, HiddenFinger(), 3));
  const Repetition a = Solve(once), b = Solve(Repeated(once, 5));
  EXPECT_EQ(b.result.Verdict(), "good");
  EXPECT_NEAR(b.result.effective_rows, a.result.effective_rows, 1e-9);
  for (std::size_t k = 0; k < a.result.identifiability.std.size(); ++k) {
    const double std = a.result.identifiability.std[k];
    EXPECT_NEAR(b.result.identifiability.std[k], std, 0.02 * std) << k;
    EXPECT_NEAR(b.problem->Values()[static_cast<int>(k)],
                a.problem->Values()[static_cast<int>(k)], 0.1 * std);
  }
  for (int f = 0; f < kResidualFamilies; ++f) {
    const auto& once_noise = a.result.identifiability.noise[f];
    const auto& noise = b.result.identifiability.noise[f];
    EXPECT_NEAR(noise.dof, once_noise.dof, 0.02 * once_noise.dof + 1e-9);
    EXPECT_NEAR(noise.chi2, once_noise.chi2, 0.03 * once_noise.chi2 + 1e-9);
  }
}

TEST(RepeatedRowsTest, EightRowsAreNeverGood) {
  const TempFolder folder;
  const FrameTable whole =
      FrameTable::Read(StandardLog(folder, HiddenFinger(), 3));
  const FrameTable eight = RowsOf(whole, {0, 10, 35, 60, 90, 120, 150, 180});
  const Repetition solved = Solve(Repeated(eight, 20));
  EXPECT_EQ(solved.result.Verdict(), "unidentifiable");
  EXPECT_NEAR(solved.result.effective_rows, 8, 1e-9);
  std::vector<std::string> codes;
  for (const auto& warning : solved.result.warnings) {
    codes.push_back(warning.code);
  }
  EXPECT_THAT(codes, testing::Contains("too_few_rows"));
}

// The object stands still at 12 places and is read 20 times at each. All
// readings of a place share the error of the place; gauges and force do not.
TEST(RepeatedRowsTest, PlacesReadManyTimesAreHonest) {
  constexpr int kPlaces = 12, kReadings = 20;
  const std::vector<double> truth = [] {
    const Finger finger = HiddenFinger();
    return std::vector<double>{std::log(finger.front_stiffness_N_mm2),
                               std::log(finger.back_stiffness_N_mm2)};
  }();
  double squares = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> place_error(0, 0.05);
    const FrameTable standard = StandardFrames(HiddenFinger(), seed);
    std::vector<std::size_t> rows;
    for (int place = 0; place < kPlaces; ++place) {
      rows.insert(rows.end(), kReadings, 5 + 17 * place);
    }
    rows.insert(rows.end(), 10, 0);  // free
    FrameTable frames(rows.size());
    for (const char* column : {"object_x_mm", "object_y_mm"}) {
      std::vector<double>& cells = frames.MutableNumbers(column);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        cells[i] = standard.Numbers(column)[rows[i]];
      }
    }
    Simulate(HiddenFinger(), StandardScene(), {}, &frames);
    FrameTable log = MakeLog(HiddenFinger(), frames, {0.02, 0, seed});
    for (const char* column : {"object_x_mm", "object_y_mm"}) {
      std::vector<double>& cells = log.MutableNumbers(column);
      for (int place = 0; place < kPlaces; ++place) {
        const double error = place_error(generator);
        for (int k = 0; k < kReadings; ++k) {
          cells[place * kReadings + k] += error;
        }
      }
    }
    const Repetition solved = Solve(log);
    for (int k = 0; k < 2; ++k) {
      const double z = (solved.problem->Values()[k] - truth[k]) /
                       solved.result.identifiability.std[k];
      squares += z * z;
      ++count;
    }
    EXPECT_NEAR(solved.result.effective_rows, kPlaces + 10, 1e-9);
  }
  const double rms_z = std::sqrt(squares / count);
  std::printf("stiffness: rms z %.2f\n", rms_z);
  EXPECT_LT(rms_z, 1.35);
  EXPECT_GT(rms_z, 0.5);
}

}  // namespace
}  // namespace finray

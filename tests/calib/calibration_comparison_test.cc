#include "finray/calib/analysis/calibration_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calib/calibrated.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/finger/finger_yaml.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

// A result folder, of all but the comparison with the force sensor.
std::string Folder(const TempFolder& folder, const std::string& name,
                   const std::string& log, bool* good = nullptr) {
  Calibrated calibrated(StandardPlan(), {log});
  if (good != nullptr) {
    // One calibration in a hundred or so ends in a wrong minimum, which
    // calibration.yaml warns of.
    for (const auto& noise : calibrated.found.noise) {
      *good &= noise.chi2 <= 2 * noise.dof;
    }
  }
  CalibrationResult result;
  result.solution.solve.converged = true;
  result.identifiability = calibrated.found;
  result.finger = calibrated.problem->parameters().Apply(Nominal());
  KeepCovariance(calibrated.problem->parameters(), calibrated.found,
                 &result.finger);
  std::filesystem::create_directory(folder.Path(name));
  folder.Write(name + "/calibration.yaml",
               CalibrationYaml(*calibrated.problem, result,
                               {log, log, "taylor", 0, ""}));
  folder.Write(name + "/finger.yaml", FingerToYaml(result.finger));
  return folder.Path(name);
}

void CheckPairs(int pairs_tried, double tolerance) {
  const TempFolder folder;
  double chi2 = 0, sigma2 = 0, force2 = 0, contact2 = 0;
  int pairs = 0, dof = 0, parameters = 0, points = 0, not_shared = 0;
  for (int pair = 0; pair < pairs_tried; ++pair) {
    std::string folders[2];
    bool good = true;
    for (int i = 0; i < 2; ++i) {
      const auto name = std::to_string(pair) + "_" + std::to_string(i);
      folders[i] = Folder(
          folder, name, StandardLog(folder, HiddenFinger(), 200 + 2 * pair + i),
          &good);
    }
    if (!good) continue;
    ++pairs;
    const Comparison found =
        Compare(ReadCalibration(folders[0]), ReadCalibration(folders[1]), {});
    EXPECT_EQ(found.dof, 15);
    chi2 += found.chi2;
    dof += found.dof;
    not_shared += found.shared_logs == 0;
    for (const auto& p : found.parameters) {
      if (std::isnan(p.std)) continue;
      sigma2 += p.sigma() * p.sigma();
      ++parameters;
    }
    for (const auto& point : found.grid) {
      // What is known to a few mm only is not linear.
      if (!(point.contact_std_mm < 1)) continue;
      force2 += std::pow(point.force_difference_N / point.force_std_N, 2);
      contact2 +=
          std::pow(point.contact_difference_mm / point.contact_std_mm, 2);
      ++points;
    }
  }
  std::printf(
      "%d pairs: chi2/dof %.2f over %d, parameters %.2f, force %.2f, "
      "contact %.2f over %d points\n",
      pairs, chi2 / dof, dof, sigma2 / parameters, force2 / points,
      contact2 / points, points);
  EXPECT_GE(pairs, pairs_tried - 1);
  EXPECT_EQ(not_shared, pairs);
  // chi2/dof of twelve pairs is known to sqrt(2 / 180) = 0.11; parameters and
  // points go together.
  EXPECT_NEAR(chi2 / dof, 1, 0.66 * tolerance);
  EXPECT_NEAR(sigma2 / parameters, 1, tolerance);
  EXPECT_GT(points, pairs * 25);
  EXPECT_NEAR(force2 / points, 1, tolerance);
  EXPECT_NEAR(contact2 / points, 1, tolerance);
}

TEST(ComparisonTest, IndependentCalibrationsDifferAsTheirStdSay) {
  CheckPairs(4, 0.7);
}
TEST(ComparisonTest, SlowIndependentCalibrationsDifferAsTheirStdSay) {
  CheckPairs(12, 0.5);
}

TEST(ComparisonTest, AStifferFingerPressesHarder) {
  const TempFolder folder;
  const std::string a =
      Folder(folder, "a", StandardLog(folder, HiddenFinger(), 300));
  std::filesystem::copy(a, folder.Path("b"));
  Finger stiff = ReadFinger(a + "/finger.yaml");
  stiff.front_stiffness_N_mm2 *= 1.03;
  stiff.back_stiffness_N_mm2 *= 1.03;
  folder.Write("b/finger.yaml", FingerToYaml(stiff));
  const CalibrationFile first = ReadCalibration(a);
  const CalibrationFile second =
      ReadCalibration(folder.Path("b/calibration.yaml"));
  const Comparison found = Compare(first, second, {});
  EXPECT_EQ(found.chi2, 0);  // the numbers are the same
  EXPECT_EQ(found.shared_logs, 1);
  int compared = 0;
  for (const auto& point : found.grid) {
    if (std::isnan(point.force_difference_N)) continue;
    ++compared;
    EXPECT_NEAR(point.force_difference_N, 0.03 * point.normal_N,
                1e-5 * point.normal_N);
    EXPECT_NEAR(point.contact_difference_mm, 0, 1e-4);
  }
  EXPECT_GE(compared, 27);
  EXPECT_NEAR(found.largest().force_N, 0.3 * ForceUnit(first.finger), 1e-4);
}

std::string Replaced(std::string text, const std::string& old,
                     const std::string& with) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos;
       at += with.size()) {
    text.replace(at, old.size(), with);
  }
  return text;
}

// Offsets of logs that have one name but are not the same.
TEST(ComparisonTest, OffsetsOfDifferentLogsAreNotCompared) {
  const TempFolder folder;
  const std::string a =
      Folder(folder, "a", StandardLog(folder, HiddenFinger(), 302));
  std::string text =
      Replaced(folder.Read("a/calibration.yaml"), "gauge_1_offset_V",
               "\"gauge_1_offset_V[log.csv]\"");
  folder.Write("a/calibration.yaml", text);
  const CalibrationFile first = ReadCalibration(a);
  const Comparison same = Compare(first, first, {});
  EXPECT_EQ(same.parameters.size(), first.parameters.size());
  EXPECT_TRUE(same.of_other_logs.empty());

  std::filesystem::copy(a, folder.Path("b"));
  text = Replaced(text, first.logs[0].sha256, std::string(64, '0'));
  text = Replaced(text, "gauge_2_offset_V", "gauge_9_offset_V");
  folder.Write("b/calibration.yaml", text);
  const Comparison other =
      Compare(first, ReadCalibration(folder.Path("b")), {});
  EXPECT_THAT(other.of_other_logs,
              testing::ElementsAre("gauge_1_offset_V[log.csv]"));
  EXPECT_THAT(other.only_a, testing::ElementsAre("gauge_2_offset_V"));
  EXPECT_THAT(other.only_b, testing::ElementsAre("gauge_9_offset_V"));
  EXPECT_EQ(other.parameters.size(), first.parameters.size() - 2);
  EXPECT_EQ(other.dof, same.dof - 2);
}

TEST(ComparisonTest, CountsWhatOnlyAFinds) {
  const TempFolder folder;
  const CalibrationFile a = ReadCalibration(
      Folder(folder, "a", StandardLog(folder, HiddenFinger(), 303)));
  EXPECT_EQ(Compare(a, a, {}).largest().lost, 0);
  // A dead finger: no readings of a's come near to its own.
  CalibrationFile dead = a;
  for (Gauge& gauge : dead.finger.gauges) gauge.noise_V *= 1e5;
  const Comparison found = Compare(a, dead, {});
  EXPECT_EQ(found.largest().points, 0);
  EXPECT_GE(found.largest().lost, 27);
}

TEST(ComparisonTest, RefusesWhatCannotBeCompared) {
  const TempFolder folder;
  const std::string a =
      Folder(folder, "a", StandardLog(folder, HiddenFinger(), 301));
  const CalibrationFile first = ReadCalibration(a);
  CalibrationFile other = first;
  other.finger.gauges.pop_back();
  EXPECT_THAT([&] { Compare(first, other, {}); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("a finger of 3 gauges")));
  CalibrationFile none = first;
  for (auto& parameter : none.parameters) parameter.name += "_x";
  EXPECT_THROW(Compare(first, none, {}), InputError);
  const std::string once =
      "  - {name: x, unit: mm, value: 1, std: 1, status: estimated}\n";
  folder.Write("a/calibration.yaml",
               "schema_version: 1\nparameters:\n" + once + once);
  EXPECT_THAT([&] { ReadCalibration(a); },
              testing::ThrowsMessage<InputError>(
                  testing::AllOf(testing::HasSubstr("calibration.yaml:4:"),
                                 testing::HasSubstr("'x' is there twice"))));
  folder.Write("a/calibration.yaml", "schema_version: 1\nparameters: []\n");
  EXPECT_THROW(ReadCalibration(a), InputError);
}

}  // namespace
}  // namespace finray

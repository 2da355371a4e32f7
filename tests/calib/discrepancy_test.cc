#include "finray/calib/analysis/discrepancy.h"

#include <gtest/gtest.h>

#include <random>

#include "calib/standard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

// Errors with the noise of 0.3 mrad, and with a discrepancy or without.
HeldOutErrors Drawn(unsigned seed, int count,
                    const GaugeDiscrepancy* discrepancy) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  HeldOutErrors errors;
  for (int i = 0; i < count; ++i) {
    GaugeError at{20 + 100 * uniform(generator), 7 * uniform(generator),
                  Eigen::VectorXd(4), Eigen::MatrixXd::Identity(4, 4) * 9e-8};
    Eigen::MatrixXd covariance = at.expected;
    if (discrepancy != nullptr) {
      discrepancy->AddTo(at.place_mm, at.force_N, &covariance);
    }
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    at.error_rad = root * Eigen::VectorXd::NullaryExpr(
                              4, [&] { return normal(generator); });
    errors.fitted.push_back(at);
  }
  return errors;
}

GaugeDiscrepancy Typical() {
  Eigen::Vector4d near(1e-4, 2e-4, -1e-4, 0), far(0, 1e-4, 3e-4, 2e-4);
  return {1, {{40, near * near.transpose()}, {100, far * far.transpose()}}};
}

TEST(DiscrepancyTest, FindsTheCovarianceThatErrorsWereDrawnFrom) {
  const GaugeDiscrepancy truth = Typical();
  const auto found = FitDiscrepancy(Drawn(3, 2000, &truth));
  ASSERT_TRUE(found.has_value());
  for (const double arc_mm : {40.0, 70.0, 100.0}) {
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(4, 4), fitted = expected;
    truth.AddTo(arc_mm, 5, &expected);
    found->AddTo(arc_mm, 5, &fitted);
    // A covariance that changes with the place is known to some 20 %.
    EXPECT_LT((fitted - expected).norm(), 0.25 * expected.norm()) << arc_mm;
  }
}

// A covariance from a few errors fits these better than those to come.
TEST(DiscrepancyTest, HoldsForErrorsThatItHasNotSeen) {
  const GaugeDiscrepancy truth = Typical();
  double chi2 = 0;
  int values = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const auto found = FitDiscrepancy(Drawn(seed, 40, &truth));
    ASSERT_TRUE(found.has_value());
    for (const GaugeError& at : Drawn(1000 + seed, 200, &truth).fitted) {
      Eigen::MatrixXd covariance = at.expected;
      found->AddTo(at.place_mm, at.force_N, &covariance);
      chi2 += at.error_rad.dot(covariance.llt().solve(at.error_rad));
      values += 4;
    }
  }
  EXPECT_NEAR(chi2 / values, 1, 0.06);
}

TEST(DiscrepancyTest, NoiseAloneHasNone) {
  int some = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    some += FitDiscrepancy(Drawn(seed, 200, nullptr)).has_value();
  }
  EXPECT_LE(some, 1);
}

TEST(DiscrepancyTest, RejectedFramesJoinIfTheyLookLikeTheOthers) {
  const GaugeDiscrepancy truth = Typical();
  HeldOutErrors errors = Drawn(4, 200, &truth);
  const auto without = FitDiscrepancy(errors);
  GaugeDiscrepancy twice = truth;
  for (auto& place : twice.places) place.covariance_rad2 *= 4;
  errors.rejected = Drawn(5, 60, &twice).fitted;
  const auto with = FitDiscrepancy(errors);
  // A gross error is something else.
  for (GaugeError& at : errors.rejected) at.error_rad[0] += 0.1;
  const auto gross = FitDiscrepancy(errors);
  ASSERT_TRUE(without && with && gross);
  const auto size = [](const GaugeDiscrepancy& of) {
    // Over all places, whose number may differ.
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(4, 4);
    for (int arc_mm = 25; arc_mm <= 115; arc_mm += 10) {
      of.AddTo(arc_mm, 5, &covariance);
    }
    return covariance.trace();
  };
  EXPECT_GT(size(*with), 1.05 * size(*without));
  EXPECT_EQ(size(*gross), size(*without));
}

TEST(DiscrepancyTest, ACalibrationKeepsItInTheFinger) {
  const TempFolder folder;
  const auto calibrated = [&](const std::string& log) {
    CalibrationProblem problem(
        Nominal(), StandardPlan(),
        ReadCalibrationLogs({log}, Nominal(), StandardPlan()), {}, 2);
    return Calibrate(&problem).finger.calibration->discrepancy;
  };
  Scene scene = StandardScene();
  scene.friction_coefficient = 0.3;
  MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), 71, scene),
          {0.02, 0.05, 71})
      .Write(folder.Path("rough.csv"));
  const auto rough = calibrated(folder.Path("rough.csv"));
  ASSERT_TRUE(rough.has_value());
  EXPECT_NE(WordsOf(*rough).find("mrad rms"), std::string::npos);
  EXPECT_FALSE(calibrated(StandardLog(folder, HiddenFinger(), 72)).has_value());
}

}  // namespace
}  // namespace finray

#include "finray/calib/analysis/validation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calib/calibrated.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/io/error.h"

namespace finray {
namespace {

Plan ValidationPlan() {
  Plan plan = StandardPlan();
  plan.scene.contacts = 1;
  return plan;
}

// Point contacts of `finger` over the middle of the beam, with noise.
std::string PointLog(const TempFolder& folder, const Finger& finger, int rows,
                     unsigned seed, bool with_place = true) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  FrameTable frames(rows);
  auto& arc = frames.MutableNumbers("contact_1_mm");
  auto& force = frames.MutableNumbers("normal_1_N");
  for (int i = 0; i < rows; ++i) {
    arc[i] = 30 + 75 * uniform(generator);
    force[i] = 2 + 5 * uniform(generator);
  }
  EXPECT_EQ(Simulate(finger, {}, {}, &frames).not_converged, 0);
  FrameTable log = MakeLog(finger, frames, {0.02, 0, seed});
  std::normal_distribution<double> normal;
  for (int i = 0; with_place && i < rows; ++i) {
    log.MutableNumbers("contact_1_mm")[i] =
        frames.Numbers("contact_1_mm")[i] + 0.3 * normal(generator);
  }
  log.Write(folder.Path("points.csv"));
  return folder.Path("points.csv");
}

Validation ValidateLog(const Finger& finger, const Plan& plan,
                       const std::string& log) {
  return Validate(finger, {}, plan, ReadCalibrationLogs({log}, finger, plan),
                  {}, 2);
}

// Fingers drawn from the covariance that a calibration has left, which they say
// of themselves: intervals cover what they promise. Frames of half the noise,
// so that the fingers' errors show without it.
void CheckCoverage(unsigned draws, double tolerance_68, double tolerance_95) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  Calibrated calibrated(StandardPlan(), {StandardLog(folder, truth, 2)});
  KeepCovariance(calibrated.problem->parameters(), calibrated.found, &truth);
  truth.calibration->std *= 3;
  const ParameterCovariance covariance = *truth.calibration;
  const Eigen::MatrixXd factor = covariance.Factor();
  for (Gauge& gauge : truth.gauges) gauge.noise_V /= 2;
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  ErrorStatistics force, contact, alone;
  const auto pool = [](const ErrorStatistics& from, ErrorStatistics* to) {
    to->judged += from.judged;
    to->within_68 += from.within_68;
    to->within_95 += from.within_95;
  };
  for (unsigned i = 0; i < draws; ++i) {
    const std::string log = PointLog(folder, truth, 25, i);
    const Eigen::VectorXd draw =
        factor * Eigen::VectorXd::NullaryExpr(
                     factor.cols(), [&] { return normal(generator); });
    Finger wrong = truth;
    for (std::size_t k = 0; k < covariance.parameters.size(); ++k) {
      const FingerParameter& p = covariance.parameters[k];
      SetParameter(p, ParameterValue(truth, p) + draw[k], &wrong);
    }
    const Validation with = ValidateLog(wrong, ValidationPlan(), log);
    pool(with.errors.contact.force_N, &force);
    pool(with.errors.contact.contact_mm, &contact);
    wrong.calibration.reset();
    const Validation without = ValidateLog(wrong, ValidationPlan(), log);
    pool(without.errors.contact.force_N, &alone);
  }
  std::printf(
      "coverage: force %.1f, %.1f %%; contact %.1f, %.1f %%; force without the "
      "covariance %.1f, %.1f %%\n",
      force.coverage_68_percent(), force.coverage_95_percent(),
      contact.coverage_68_percent(), contact.coverage_95_percent(),
      alone.coverage_68_percent(), alone.coverage_95_percent());
  // Frames of a finger share its errors, so that draws count, not frames.
  EXPECT_NEAR(force.coverage_68_percent(), 68.3, tolerance_68);
  EXPECT_NEAR(force.coverage_95_percent(), 95, tolerance_95);
  EXPECT_NEAR(contact.coverage_68_percent(), 68.3, tolerance_68);
  EXPECT_NEAR(contact.coverage_95_percent(), 95, tolerance_95);
  EXPECT_LT(alone.coverage_68_percent(), force.coverage_68_percent() - 3);
}

TEST(ValidationTest, CoverageOfFingersWithKnownErrors) {
  CheckCoverage(20, 8, 4);
}
TEST(ValidationTest, SlowCoverageOfFingersWithKnownErrors) {
  CheckCoverage(80, 5, 2.5);
}

// All stiffness 2 % too high: all forces 2 % too high, places right.
TEST(ValidationTest, ForceErrorOfAStiffFinger) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  for (Gauge& gauge : truth.gauges) gauge.noise_V = 1e-9;
  FrameTable frames(5);
  for (int i = 0; i < 5; ++i) {
    frames.MutableNumbers("contact_1_mm")[i] = 15 + 25 * i;
    frames.MutableNumbers("normal_1_N")[i] = 5;
  }
  ASSERT_EQ(Simulate(truth, {}, {}, &frames).not_converged, 0);
  FrameTable log = MakeLog(truth, frames, {});
  log.MutableNumbers("contact_1_mm") = frames.Numbers("contact_1_mm");
  log.Write(folder.Path("clean.csv"));
  Finger stiff = truth;
  stiff.front_stiffness_N_mm2 *= 1.02;
  stiff.back_stiffness_N_mm2 *= 1.02;
  const Plan plan = ValidationPlan();
  const Validation result = Validate(
      stiff, truth, plan,
      ReadCalibrationLogs({folder.Path("clean.csv")}, stiff, plan), {}, 1);
  EXPECT_NEAR(result.errors.contact.force_N.percent(), 2, 1e-3);
  EXPECT_NEAR(result.errors.contact.force_N.bias(), 0.1, 1e-4);
  EXPECT_LT(result.errors.contact.contact_mm.largest, 1e-3);
  EXPECT_LT(result.baseline_errors->contact.force_N.rms(), 1e-4);
  // 15, 40, 65, 90, 115 mm of 140: one a region.
  for (const ErrorRow& region : result.errors.regions) {
    EXPECT_EQ(region.frames, 1u);
    EXPECT_NEAR(region.force_N.percent(), 2, 1e-3);
  }
}

TEST(ValidationTest, ACircleTellsThePlace) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  FrameTable frames(4);
  for (int i = 0; i < 4; ++i) {
    frames.MutableNumbers("object_x_mm")[i] = i == 0 ? -25 : -13;
    frames.MutableNumbers("object_y_mm")[i] = 20 + 25 * i;
  }
  const Plan plan = StandardPlan();
  ASSERT_EQ(Simulate(truth, plan.scene, {}, &frames).not_converged, 0);
  MakeLog(truth, frames, {}).Write(folder.Path("circle.csv"));
  const CalibrationLogs logs =
      ReadCalibrationLogs({folder.Path("circle.csv")}, truth, plan);
  const auto references = ReferencesOf(logs, truth, plan, {}, 2);
  EXPECT_FALSE(references[0].contact);
  for (int i = 1; i < 4; ++i) {
    EXPECT_NEAR(references[i].contact_mm, frames.Numbers("contact_1_mm")[i],
                1e-4);
    EXPECT_EQ(references[i].contact_std_mm, plan.object_std_mm);
    EXPECT_NEAR(references[i].force_N, frames.Numbers("normal_1_N")[i], 1e-5);
  }
  // Another stiffness of all moves it little.
  Finger stiff = truth;
  stiff.front_stiffness_N_mm2 *= 1.1;
  EXPECT_NEAR(ReferencesOf(logs, stiff, plan, {}, 2)[2].contact_mm,
              references[2].contact_mm, 0.1);
}

// The stage was set up anew, 0.6 and 0.8 mm away. Its origin is found, and what
// is left is error of the finger.
TEST(ValidationTest, AStageSetUpAnewIsAligned) {
  const TempFolder folder;
  const Eigen::Vector2d moved(0.6, -0.8);
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 6));
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("object_x_mm")[i] -= moved.x();
    log.MutableNumbers("object_y_mm")[i] -= moved.y();
  }
  log.Write(folder.Path("moved.csv"));
  Plan plan = StandardPlan();
  FamilyPlan& origin =
      plan.families[static_cast<int>(ParameterFamily::kObjectOrigin)];
  const std::string path = folder.Path("moved.csv");
  origin = {};
  const ErrorStatistics far =
      ValidateLog(HiddenFinger(), plan, path).errors.contact.contact_mm;
  EXPECT_LT(far.coverage_95_percent(), 80);
  origin = {true, 0.5, false};
  const Validation aligned = ValidateLog(HiddenFinger(), plan, path);
  ASSERT_EQ(aligned.stages.size(), 1u);
  const FittedStage& stage = aligned.stages[0];
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_LT(stage.origin_std_mm[axis], 0.1);
    EXPECT_NEAR(stage.origin_mm[axis], moved[axis],
                4 * stage.origin_std_mm[axis]);
  }
  EXPECT_GT(stage.over_prior, 1.2);
  const ErrorRow& errors = aligned.errors.contact;
  EXPECT_NEAR(errors.contact_mm.rms_z(), 1, 0.2);
  EXPECT_GT(errors.contact_mm.coverage_95_percent(), 90);
  // The origin does not stand for what a drawn finger lacks.
  EXPECT_TRUE(ValidateLog(Nominal(), plan, path).stages.empty());
  // A stiffer finger cannot hide behind the origin.
  Finger stiff = HiddenFinger();
  stiff.front_stiffness_N_mm2 *= 1.2;
  stiff.back_stiffness_N_mm2 *= 1.2;
  EXPECT_GT(ValidateLog(stiff, plan, path).errors.contact.force_N.percent(),
            15);
}

// A plateau of a hundred readings has a tenth of the noise of one. Force and
// gauges of each row are judged by that.
TEST(ValidationTest, MeansHaveTheNoiseOfMeans) {
  const TempFolder folder;
  constexpr double kReadings = 100;
  Finger finger = HiddenFinger(), quiet = finger;
  for (Gauge& gauge : quiet.gauges) gauge.noise_V /= std::sqrt(kReadings);
  FrameTable frames = StandardFrames(finger, 3);
  FrameTable log = MakeLog(quiet, frames, {0.002, 0.005, 3});
  Plan plan = StandardPlan();
  plan.object_std_mm = 0.005;
  const auto z_of = [&] {
    log.Write(folder.Path("means.csv"));
    const ErrorRow errors =
        ValidateLog(finger, plan, folder.Path("means.csv")).errors.contact;
    return std::pair(errors.force_N.rms_z(), errors.contact_mm.rms_z());
  };
  plan.families = {};
  EXPECT_LT(z_of().first, 0.3);
  log.MutableNumbers("gauge_readings").assign(log.rows(), kReadings);
  log.MutableNumbers("force_readings").assign(log.rows(), kReadings);
  log.MutableNumbers("force_scatter_N").assign(log.rows(), 0.02);
  EXPECT_NEAR(z_of().first, 1, 0.2);
  EXPECT_NEAR(z_of().second, 1, 0.2);
  // A stated std of rows counts, whatever the log says.
  plan.force_std_stated = true;
  EXPECT_LT(z_of().first, 0.7);
}

TEST(ValidationTest, Gates) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const Plan plan = ValidationPlan();
  const Validation result =
      ValidateLog(truth, plan, PointLog(folder, truth, 30, 5));
  const double rms = result.errors.contact.force_N.rms();
  const std::vector<Gate> results =
      CheckGates(result, {{"most_force_rms_N", 1.01 * rms},
                          {"most_force_rms_N", 0.99 * rms},
                          {"least_usable_percent", 90},
                          {"least_coverage_95_percent", 100.5}});
  EXPECT_TRUE(results[0].passed);
  EXPECT_FALSE(results[1].passed);
  EXPECT_TRUE(results[2].passed);
  EXPECT_FALSE(results[3].passed);
  EXPECT_EQ(results[1].value, rms);

  const Validation placeless =
      ValidateLog(truth, plan, PointLog(folder, truth, 5, 5, false));
  EXPECT_THROW(CheckGates(placeless, {{"most_contact_rms_mm", 1}}), InputError);
  FrameTable blind = FrameTable::Read(PointLog(folder, truth, 5, 5, false));
  blind.MutableNumbers("force_N").assign(5, NAN);
  blind.Write(folder.Path("blind.csv"));
  EXPECT_THAT([&] { ValidateLog(truth, plan, folder.Path("blind.csv")); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("no frame with contact has a reference")));
}

// 86 of 100 may well come from 90 %, 80 may not. A true share at an end of the
// range makes such a sample, or a more extreme one, in 1 to 2 % of cases.
TEST(ValidationTest, ACoverageIsJudgedByItsBinomialRange) {
  for (const auto& [hits, passes] : {std::pair(86, true), {80, false}}) {
    Validation found;
    found.errors.contact.force_N.judged = 100;
    found.errors.contact.force_N.within_95 = hits;
    const std::vector<Gate> gates =
        CheckGates(found, {{"least_coverage_95_percent", 90}});
    EXPECT_EQ(gates[0].passed, passes) << hits;
    EXPECT_EQ(gates[0].value, hits);
    const auto tail = [](double share, int from, int to) {
      double sum = 0;
      for (int k = from; k <= to; ++k) {
        sum += std::exp(std::lgamma(101) - std::lgamma(k + 1) -
                        std::lgamma(101 - k) + k * std::log(share) +
                        (100 - k) * std::log1p(-share));
      }
      return sum;
    };
    EXPECT_NEAR(tail(gates[0].range->second / 100, 0, hits), 0.015, 0.012);
    EXPECT_NEAR(tail(gates[0].range->first / 100, hits, 100), 0.015, 0.012);
  }
}

// Rows of the bench are no frames of the finger, and the std of one of two
// contacts is not that of their sum.
TEST(ValidationTest, BenchRowsAndTwoContacts) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const Plan plan = ValidationPlan();
  CalibrationLogs logs =
      ReadCalibrationLogs({PointLog(folder, truth, 5, 6)}, truth, plan);
  CalibrationFrame bench;
  bench.cylinder_radius_mm = 100;
  bench.gauges_V = {0, 0, 0, 0};
  logs.frames.insert(logs.frames.begin() + 2, bench);
  Validation result = Validate(truth, {}, plan, logs, {}, 1);
  EXPECT_EQ(result.errors.contact.frames, 5u);
  EXPECT_EQ(result.errors.free.frames, 0u);
  result.estimates[3].contacts = 2;
  const FrameTable table = ValidationFrames(logs, result, 0);
  ASSERT_EQ(table.rows(), 5u);
  EXPECT_EQ(table.Numbers("row")[2], 3);
  EXPECT_TRUE(std::isfinite(table.Numbers("force_std_N")[1]));
  EXPECT_TRUE(std::isnan(table.Numbers("force_std_N")[2]));
}

// Without a gate too, wrong estimates are no good ones.
TEST(FaultsTest, SaysWhatIsWrong) {
  using testing::ElementsAre;
  using testing::HasSubstr;
  using testing::IsEmpty;
  ErrorRow good;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    good.force_N.Add(0.02 * normal(generator), 3, 0.02);
  }
  good.frames = good.usable = 50;
  EXPECT_THAT(FaultsOf(good), IsEmpty());

  // A twentieth of the frames is far off: the coverage is nearly right.
  ErrorRow tail = good;
  for (int i = 0; i < 3; ++i) tail.force_N.Add(0.3, 3, 0.02);
  EXPECT_GT(tail.force_N.coverage_95_percent(), 88);
  EXPECT_THAT(FaultsOf(tail),
              ElementsAre(HasSubstr("errors of force are 3.7 times")));

  // Std that are as wide as the errors.
  ErrorRow vague;
  vague.frames = 50;
  vague.usable = 20;
  for (int i = 0; i < 20; ++i) vague.force_N.Add(i % 2 ? 3 : -4, 3, 4);
  EXPECT_THAT(FaultsOf(vague),
              ElementsAre("forces are off by 118 % rms",
                          "only 40 % of the frames with contact are usable"));
}

}  // namespace
}  // namespace finray

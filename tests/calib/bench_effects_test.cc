// Effects of the bench that a plan may free: the axes of the stage, the radius
// of the object, the reference sensor.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/io/error.h"
#include "finray/residuals/linear_signal.h"

namespace finray {
namespace {

// The log as a stage reads it whose axes are turned and stretched.
std::string SeenByStage(const TempFolder& folder, const std::string& path,
                        const StageFrame& stage) {
  FrameTable log = FrameTable::Read(path);
  std::vector<double>& x = log.MutableNumbers("object_x_mm");
  std::vector<double>& y = log.MutableNumbers("object_y_mm");
  const Eigen::Rotation2Dd turn(-stage.rotation_deg * M_PI / 180);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const Eigen::Vector2d seen =
        turn * (Eigen::Vector2d(x[i], y[i]) - stage.origin_mm) /
        std::exp(stage.ln_scale);
    x[i] = seen.x();
    y[i] = seen.y();
  }
  log.Write(folder.Path("seen.csv"));
  return folder.Path("seen.csv");
}

TEST(BenchEffectsTest, AxesOfTheStage) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const std::string log = SeenByStage(folder, StandardLog(folder, truth, 21),
                                      {{0.4, -0.3}, 1, std::log(1.01)});
  Plan plan = StandardPlan();
  Free(ParameterFamily::kObjectOrigin, &plan).prior_std = 0.5;
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kObjectRotation, &plan).prior_std = 1;
  Free(ParameterFamily::kObjectScale, &plan).prior_std = 2;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(truth);
  with.Expect("object_rotation_deg", 1, 0.2);
  with.Expect("object_scale", 1.01, 0.01);
  with.Expect("object_origin_x_mm", 0.4, 0.3);
  EXPECT_FALSE(without.Has("object_rotation_deg"));
  EXPECT_GT(without.Chi2(), with.Chi2() + 100);

  // Corrected places are in frame S again.
  CalibrationParameters& parameters = with.problem().parameters();
  const CalibrationLogs corrected =
      parameters.Corrected(with.problem().logs(), parameters.Apply(Nominal()));
  const FrameTable frames = StandardFrames(truth, 21);
  for (std::size_t i = 0; i < corrected.frames.size(); ++i) {
    if (!corrected.frames[i].contact) continue;
    EXPECT_NEAR(corrected.frames[i].object_mm.x(),
                frames.Numbers("object_x_mm")[i], 0.5);
    EXPECT_NEAR(corrected.frames[i].object_mm.y(),
                frames.Numbers("object_y_mm")[i], 1);
  }
}

TEST(BenchEffectsTest, NothingIsFreeWithoutAPlace) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 27));
  log.MutableNumbers("object_x_mm").assign(log.rows(), std::nan(""));
  log.Write(folder.Path("placeless.csv"));
  Plan plan = StandardPlan();
  for (const ParameterFamily family :
       {ParameterFamily::kObjectOrigin, ParameterFamily::kObjectRotation,
        ParameterFamily::kObjectScale, ParameterFamily::kObjectRadius}) {
    Free(family, &plan).prior_std = 0.5;
  }
  const CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("placeless.csv")}, Nominal(), plan), {},
      1);
  EXPECT_EQ(problem.parameters().free().size(), 15u);
}

TEST(BenchEffectsTest, RotationOfEachLog) {
  const TempFolder folder, first, second;
  const Finger truth = HiddenFinger();
  const std::string a =
      SeenByStage(first, StandardLog(folder, truth, 22), {{0, 0}, 0.8, 0});
  const std::string b =
      SeenByStage(second, StandardLog(folder, truth, 23), {{0, 0}, -0.5, 0});
  Plan plan = StandardPlan();
  FamilyPlan& rotation = Free(ParameterFamily::kObjectRotation, &plan);
  rotation.prior_std = 1;
  rotation.per_log = true;
  const Recovery each(Nominal(), plan, {a, b});
  each.Expect("object_rotation_deg[" + a + "]", 0.8, 0.05);
  each.Expect("object_rotation_deg[" + b + "]", -0.5, 0.05);
}

TEST(BenchEffectsTest, RadiusOfTheObject) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15.4}), {}};
  MakeLog(truth, StandardFrames(truth, 24, scene), {0.02, 0.05, 24})
      .Write(folder.Path("log.csv"));
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {folder.Path("log.csv")});
  Free(ParameterFamily::kObjectRadius, &plan).prior_std = 0.5;
  Recovery with(Nominal(), plan, {folder.Path("log.csv")});
  with.ExpectFinger(truth);
  with.Expect("object_radius_mm", 15.4, 0.1);
  EXPECT_GT(without.Chi2(), with.Chi2() + 100);
  EXPECT_NEAR(*with.problem()
                   .parameters()
                   .Corrected(with.problem().plan())
                   .scene.circle_radius_mm(),
              with.Value("object_radius_mm"), 1e-12);
}

// Frames in which the force comes and goes slowly, a row every second.
FrameTable SlowPresses(const Finger& finger) {
  FrameTable frames(100);
  for (int i = 0; i < 100; ++i) {
    frames.MutableNumbers("time_s")[i] = i;
    frames.MutableNumbers("object_x_mm")[i] =
        -15 + 3.5 + 2.5 * std::sin(0.26 * i);
    frames.MutableNumbers("object_y_mm")[i] = 65 + 30 * std::sin(0.062 * i);
    frames.MutableNumbers("object_angle_deg")[i] = 90 * std::sin(0.1 * i);
  }
  EXPECT_EQ(Simulate(finger, StandardScene(), {}, &frames).not_converged, 0);
  return frames;
}

TEST(BenchEffectsTest, LateForces) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const FrameTable frames = SlowPresses(truth);
  FrameTable log = MakeLog(truth, frames, {0, 0.05, 25});
  // The sensor reads what was there 0.3 s ago.
  LinearSignal force;
  for (std::size_t i = 0; i < frames.rows(); ++i) {
    force.Add(frames.Numbers("time_s")[i], frames.Numbers("force_N")[i]);
  }
  std::mt19937_64 generator(25);
  std::normal_distribution<double> normal(0, 0.02);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("force_N")[i] =
        force.At(log.Numbers("time_s")[i] - 0.3).value + normal(generator);
  }
  log.Write(folder.Path("late.csv"));
  Plan plan = StandardPlan();
  plan.scene.contacts = 1;
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].prior_std =
      0.1;
  const Recovery without(Nominal(), plan, {folder.Path("late.csv")});
  Free(ParameterFamily::kForceTimeOffset, &plan).prior_std = 1;
  Recovery with(Nominal(), plan, {folder.Path("late.csv")});
  with.Expect("force_time_offset_s", 0.3, 0.05);
  EXPECT_FALSE(without.Has("force_time_offset_s"));
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  CalibrationParameters& parameters = with.problem().parameters();
  const CalibrationLogs corrected =
      parameters.Corrected(with.problem().logs(), parameters.Apply(Nominal()));
  for (std::size_t i = 2; i + 2 < corrected.frames.size(); ++i) {
    EXPECT_NEAR(corrected.frames[i].force_N, frames.Numbers("force_N")[i], 0.2);
  }
}

TEST(BenchEffectsTest, TiltAndWeightOfTheForceSensor) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const FrameTable frames = SlowPresses(truth);
  FrameTable log = MakeLog(truth, frames, {0, 0.05, 26});
  std::mt19937_64 generator(26);
  std::normal_distribution<double> normal(0, 0.02);
  const auto& angle = frames.Numbers("contact_1_angle_rad");
  const Eigen::Rotation2Dd tilt(3 * M_PI / 180);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const Eigen::Vector2d force =
        frames.Numbers("force_N")[i] *
        Eigen::Vector2d(std::sin(angle[i]), -std::cos(angle[i]));
    const Eigen::Rotation2Dd turn(frames.Numbers("object_angle_deg")[i] * M_PI /
                                  180);
    const Eigen::Vector2d read =
        tilt * force + turn * Eigen::Vector2d(0.2, 0.5);
    log.MutableNumbers("force_x_N")[i] = read.x() + normal(generator);
    log.MutableNumbers("force_y_N")[i] = read.y() + normal(generator);
  }
  log.Write(folder.Path("tilted.csv"));
  Plan plan = StandardPlan();
  plan.scene.contacts = 1;
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].prior_std =
      0.1;
  const Recovery without(Nominal(), plan, {folder.Path("tilted.csv")});
  Free(ParameterFamily::kForceTilt, &plan).prior_std = 5;
  Free(ParameterFamily::kForceWeight, &plan).prior_std = 1;
  Recovery with(Nominal(), plan, {folder.Path("tilted.csv")});
  with.Expect("force_tilt_deg", 3, 0.3);
  with.Expect("force_weight_x_N", 0.2, 0.05);
  with.Expect("force_weight_y_N", 0.5, 0.05);
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  CalibrationParameters& parameters = with.problem().parameters();
  const CalibrationLogs corrected =
      parameters.Corrected(with.problem().logs(), parameters.Apply(Nominal()));
  for (std::size_t i = 0; i < corrected.frames.size(); ++i) {
    EXPECT_NEAR(corrected.frames[i].force_xy_N.norm(),
                frames.Numbers("force_N")[i], 0.2);
  }
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("force_x_N")[i] = std::nan("");
  }
  log.Write(folder.Path("magnitude.csv"));
  EXPECT_THROW(
      ReadCalibrationLogs({folder.Path("magnitude.csv")}, Nominal(), plan),
      InputError);
}

}  // namespace
}  // namespace finray

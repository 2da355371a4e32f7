// Effects of the bench that a plan may free: the axes of the stage, the radius
// of the object, the reference sensor.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/calib/problem/parameters.h"

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

}  // namespace
}  // namespace finray

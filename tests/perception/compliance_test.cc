#include "finray/perception/compliance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "perception/simulated_slider.h"
#include "test_finger.h"

namespace finray {
namespace {

ComplianceFinger Estimator() {
  ComplianceFinger estimator{PaperFinger(), Scene()};
  estimator.scene.contacts = 1;
  estimator.scene.object = RigidObject{Outline(CircleOutline{10}), {}};
  return estimator;
}

ForceFunction Spring(double stiffness) {
  return [=](double u) { return stiffness * u; };
}

TEST(ComplianceTest, SpringAndFrictionWithoutNoise) {
  SliderProtocol protocol;
  protocol.friction_N = 0.4;
  const FrameTable log =
      SimulateSlider(PaperFinger(), Spring(1.5), {}, protocol, {false, 0, 1});
  ComplianceSettings settings;
  settings.direction_rad = M_PI;
  const Compliance found =
      MeasureCompliance({{"spring", {log}}}, {Estimator()}, {}, settings);
  ASSERT_EQ(found.trials.size(), 1u);
  EXPECT_NEAR(found.objects[0].mean.N_per_mm, 1.5, 2e-4);
  EXPECT_NEAR(found.trials[0].fit.friction_N(), 0.4, 2e-4);
  EXPECT_GT(found.trials[0].fit.standing, 0u);
  // The sensed force is the component along the slider.
  for (const ForcePoint& point : found.trials[0].points) {
    EXPECT_NEAR(point.force_N, log.Numbers("force_N")[point.row], 1e-4);
  }
}

// An exact path gives the direction of the slider.
TEST(ComplianceTest, DirectionFromThePath) {
  const FrameTable log =
      SimulateSlider(PaperFinger(), Spring(0.5), {}, {}, {false, 0, 1});
  ContactSensor sensor(PaperFinger(), Estimator().scene, {});
  const SliderDirection found =
      EstimateDirection(SenseLoads(log, &sensor, PaperFinger()), 10);
  EXPECT_NEAR(std::remainder(found.angle_rad - M_PI, 2 * M_PI), 0, 1e-3);
}

TEST(ComplianceTest, SqueezeBetweenTwoFingers) {
  Finger second = PaperFinger();
  second.back_stiffness_N_mm2 *= 1.2;
  const SqueezeLogs logs =
      SimulateSqueeze(PaperFinger(), second, [](double f) { return 0.5 * f; },
                      {}, {}, 3, {false, 0, 1});
  ComplianceFinger other = Estimator();
  other.finger = second;
  ComplianceSettings settings;
  settings.direction_rad = M_PI;
  const Compliance found =
      MeasureCompliance({{"object", {logs.first, logs.second}}},
                        {Estimator(), other}, {}, settings);
  EXPECT_NEAR(found.objects[0].mean.N_per_mm, 2, 2e-3);
}

// The back beam is 2 % stiffer than its model, and its std is 2 %.
TEST(ComplianceTest, CalibrationWidensTheStd) {
  Finger plant = PaperFinger();
  plant.back_stiffness_N_mm2 *= 1.02;
  SliderProtocol protocol;
  protocol.unloading = false;
  const FrameTable log =
      SimulateSlider(plant, Spring(1), {}, protocol, {false, 0, 1});
  ComplianceFinger estimator = Estimator();
  estimator.finger.calibration =
      ParameterCovariance{{{FingerParameterKind::kBackStiffness, 0}},
                          Eigen::VectorXd::Constant(1, 250),
                          Eigen::MatrixXd::Identity(1, 1),
                          0,
                          std::nullopt};
  ComplianceSettings settings;
  settings.direction_rad = M_PI;
  settings.most_degree = 1;
  const Compliance found =
      MeasureCompliance({{"spring", {log}}}, {estimator}, {}, settings);
  const ObjectStiffness& spring = found.objects[0];
  EXPECT_GT(std::abs(spring.mean.N_per_mm - 1), 1e-3);
  EXPECT_NEAR(spring.calibration_std, std::abs(spring.mean.N_per_mm - 1),
              0.3 * spring.calibration_std);
}

TEST(ForceDisplacementTest, SliderStandsAfterAReversal) {
  std::vector<ForcePoint> points(8);
  const double approach[] = {0, 1, 2, 3, 2, 1, 0, -1};
  const double way[] = {0, 0.5, 1.0, 1.5, 1.5, 1.49, 0.9, 0.4};
  for (std::size_t i = 0; i < 8; ++i) {
    points[i].approach_mm = approach[i];
    points[i].displacement_mm = way[i];
    points[i].covariance = 1e-4 * Eigen::Matrix2d::Identity();
  }
  MarkDirections(0.02, &points);
  const int directions[] = {1, 1, 1, 1, -1, -1, -1, -1};
  const bool slides[] = {true, true, true, true, false, false, true, true};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(points[i].direction, directions[i]) << i;
    EXPECT_EQ(points[i].slides, slides[i]) << i;
  }
}

TEST(ComplianceTest, TooFewPointsNameTheTrial) {
  SliderProtocol protocol;
  protocol.steps = 3;
  protocol.unloading = false;
  FrameTable log =
      SimulateSlider(PaperFinger(), Spring(1), {}, protocol, {false, 0, 1});
  EXPECT_THAT(
      [&] {
        MeasureCompliance({{"spring", {log}}}, {Estimator()}, {}, {});
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr(
          "object 'spring', trial '1': too few force-displacement points")));
}

TEST(StiffnessOrderTest, MeanOfTrials) {
  const Stiffness equal = MeanStiffness({{1.0, 0.1}, {1.1, 0.1}});
  EXPECT_NEAR(equal.N_per_mm, 1.05, 1e-12);
  EXPECT_NEAR(equal.std, 0.1 / std::sqrt(2.0), 1e-12);
  // Two trials that differ by 2 have chi2 = 200, which scales the std.
  const Stiffness apart = MeanStiffness({{0.0, 0.1}, {2.0, 0.1}});
  EXPECT_NEAR(apart.std, 0.1 / std::sqrt(2.0) * std::sqrt(200.0), 1e-9);
}

TEST(StiffnessOrderTest, ConfidenceOfNeighbours) {
  std::vector<ObjectStiffness> objects(3);
  objects[0].name = "soft";
  objects[0].mean = {1, 0.3};
  objects[1].name = "stiff";
  objects[1].mean = {5, 0.1};
  objects[2].name = "middle";
  objects[2].mean = {1.5, 0.4};
  const std::vector<double> confidence = SortByStiffness(&objects);
  EXPECT_EQ(objects[0].name, "stiff");
  EXPECT_EQ(objects[1].name, "middle");
  ASSERT_EQ(confidence.size(), 2u);
  EXPECT_NEAR(confidence[0], 1, 1e-12);
  EXPECT_NEAR(confidence[1], 0.841345, 1e-6);  // one std apart
  EXPECT_NEAR(OrderConfidence(objects), 0.8413, 0.01);
}

}  // namespace
}  // namespace finray

#include "finray/perception/reconstruction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "finray/perception/polygon.h"
#include "perception/touch_fixture.h"
#include "studies/ten_objects.h"
#include "test_finger.h"

namespace finray {
namespace {

Reconstruction Touched(const NamedObject& object, bool noisy,
                       const Finger& finger = PaperFinger()) {
  const LogNoise noise{noisy, noisy ? 0.02 : 0.0, 1};
  return Reconstruct(
      SimulateTouches(PaperFinger(), object.touched, {}, {}, noise), finger,
      Scene(), {}, kStageStd_mm);
}

TEST(ReconstructionTest, EllipseWithoutNoise) {
  const NamedObject ellipse = StudyObjects()[1];
  const Reconstruction found = Touched(ellipse, false);
  EXPECT_EQ(found.touches.usable.size(), 36u);
  EXPECT_TRUE(found.gaps.empty());
  EXPECT_LT(CompareRadii(found.polygon(), ellipse.truth).Largest(), 0.01);
  // The paper's method with the same touches.
  const RadialError envelope = CompareRadii(
      FourierDescriptors(InteriorEnvelope(found.touches.usable, 10), 19)
          .Sampled(720),
      ellipse.truth);
  EXPECT_LT(envelope.Largest(), 0.5);
  EXPECT_GT(envelope.Mean(), 0.05);
}

TEST(ReconstructionTest, SquareWithNoise) {
  const NamedObject square = StudyObjects()[5];
  const Reconstruction found = Touched(square, true);
  EXPECT_EQ(found.fit.edges.size(), 4u);
  EXPECT_EQ(found.gaps.size(), 4u);
  EXPECT_LT(CompareRadii(found.polygon(), square.truth).Largest(), 2);
}

// The finger touches only the hull of a dumbbell; its waist is marked.
TEST(ReconstructionTest, DentIsMarkedAsNotTouched) {
  const NamedObject dumbbell = StudyObjects()[10];
  const Reconstruction found = Touched(dumbbell, true);
  EXPECT_EQ(found.gaps.size(), 2u);
  const RadialError error = CompareRadii(found.polygon(), dumbbell.truth);
  EXPECT_GT(error.Largest(), 4);
  for (std::size_t i = 0; i < found.outline.size(); ++i) {
    if (std::abs(error.percent[i]) > 2) {
      EXPECT_FALSE(found.outline[i].supported) << i;
    }
  }
}

// An error of the stiffness moves forces and beams, hence the outline.
TEST(ReconstructionTest, CalibrationWidensTheBand) {
  const NamedObject circle = StudyObjects()[0];
  Finger finger = PaperFinger();
  finger.calibration =
      ParameterCovariance{{{FingerParameterKind::kBackStiffness, 0}},
                          Eigen::VectorXd::Constant(1, 250),
                          Eigen::MatrixXd::Identity(1, 1),
                          0,
                          std::nullopt};
  const Reconstruction known = Touched(circle, false);
  const Reconstruction uncertain = Touched(circle, false, finger);
  Finger moved = finger;
  moved.back_stiffness_N_mm2 += 250;
  const Reconstruction other = Touched(circle, false, moved);
  for (std::size_t i = 0; i < 360; i += 45) {
    const double change =
        other.outline[i].radius_mm - known.outline[i].radius_mm;
    EXPECT_NEAR(uncertain.outline[i].std_mm,
                std::hypot(known.outline[i].std_mm, change), 5e-3);
    EXPECT_GT(uncertain.outline[i].std_mm, known.outline[i].std_mm);
  }
}

TEST(ReconstructionSlowTest, TenObjectsMeetTheirBounds) {
  for (const NamedObject& object : StudyObjects()) {
    if (object.kind == "concave") continue;
    const bool smooth = object.kind == "smooth";
    const auto largest = [&](bool noisy) {
      return CompareRadii(Touched(object, noisy).polygon(), object.truth)
          .Largest();
    };
    EXPECT_LT(largest(false), smooth ? 0.1 : 2) << object.name;
    EXPECT_LT(largest(true), smooth ? 1 : 2) << object.name;
  }
}

using testing::HasSubstr;
using testing::ThrowsMessage;

Touches Usable(const std::vector<Touch>& touches) {
  Touches all;
  all.usable = touches;
  all.rows[FrameStatus::kOk] = touches.size();
  return all;
}

TEST(TouchCoverageTest, RefusesTooFewTouches) {
  Touches few = Usable(ExactTouches(Outline(CircleOutline{10}), 7));
  few.rows[FrameStatus::kUnobservable] = 3;
  EXPECT_THAT([&] { CheckSpread(few, "a.csv"); },
              ThrowsMessage<InputError>(
                  HasSubstr("a.csv: too few touches: 7 usable in 10 rows (7 "
                            "ok, 3 unobservable)")));
  EXPECT_NO_THROW(
      CheckSpread(Usable(ExactTouches(Outline(CircleOutline{10}), 8)), ""));
}

TEST(TouchCoverageTest, RefusesTouchesFromOneSide) {
  std::vector<Touch> side;
  for (int i = 0; i < 20; ++i) {
    side.push_back(ExactTouch(Outline(CircleOutline{10}), 0.2 * i - 1.9));
  }
  EXPECT_THAT([&] { CheckSpread(Usable(side), "a.csv"); },
              ThrowsMessage<SpreadError>(HasSubstr(
                  "none has a normal between 109 and -109 deg of the object's "
                  "frame, a gap of 142 deg")));
}

// No touch lies within 60 deg of a circle. That part is open, except for R / 20
// at each end.
TEST(TouchCoverageTest, SaysWhereNoTouchLies) {
  const Outline circle(CircleOutline{20});
  const ConvexCurve curve(NormalGrid(90), {20, 0},
                          Eigen::VectorXd::Constant(90, 20));
  std::vector<Touch> touches;
  for (int i = 0; i <= 30; ++i) {
    touches.push_back(ExactTouch(circle, M_PI / 3 + i * M_PI / 18));
  }
  const TouchCoverage coverage(curve, touches);
  ASSERT_EQ(coverage.gaps().size(), 1u);
  EXPECT_NEAR(coverage.gaps()[0].length_mm, 20 * (M_PI / 3 - 0.1), 0.1);
  EXPECT_NEAR(coverage.SupportedShare(), 1 - (M_PI / 3 - 0.1) / (2 * M_PI),
              1e-3);
  EXPECT_FALSE(coverage.Supports(M_PI / 6));
  EXPECT_TRUE(coverage.Supports(M_PI / 3 - 0.04));
  EXPECT_TRUE(coverage.Supports(M_PI));
}

}  // namespace
}  // namespace finray

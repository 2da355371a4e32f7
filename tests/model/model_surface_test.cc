#include "finray/model/model_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "finray/finger/geometry.h"
#include "test_finger.h"

namespace finray {
namespace {

// A finger, its statics, and a surface that leaves out a millionth of a usual
// noise of gauges, 3e-4 rad.
class ModelSurfaceTest : public testing::Test {
 protected:
  explicit ModelSurfaceTest(Finger finger = PaperFinger())
      : finger_(std::move(finger)),
        solver_(finger_, {}),
        heaviest_N_(40 * ForceUnit(finger_)),
        surface_(solver_, SharedParameters::Of(finger_), 0, false, Wanted()) {}

  // Gauge angles, and the poses of contact and tip in mm and rad.
  static Eigen::VectorXd Resolution() {
    Eigen::VectorXd resolution(10);
    resolution.head<4>().setConstant(3e-10);
    resolution.segment<3>(4) << 1e-7, 1e-7, 1e-9;
    resolution.tail<3>() << 1e-7, 1e-7, 1e-9;
    return resolution;
  }

  ModelSurface::Content Wanted() const {
    ModelSurface::Content content{Resolution()};
    content.by_parameter = false;
    content.heaviest_N = heaviest_N_;
    return content;
  }

  bool Serves(double arc_mm, double normal_N) {
    return surface_.Evaluate(arc_mm, normal_N, false, &values_);
  }

  void ExpectAsTheStatics(double arc_mm, double normal_N) {
    SCOPED_TRACE(testing::Message() << arc_mm << " mm, " << normal_N << " N");
    ASSERT_TRUE(Serves(arc_mm, normal_N));
    ASSERT_TRUE(solver_.Solve({{arc_mm, normal_N}}));
    ASSERT_EQ(values_.outputs.size(), solver_.outputs().size());
    const Eigen::VectorXd off =
        (values_.outputs - solver_.outputs()).cwiseQuotient(Resolution());
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 10);
  }

  Finger finger_;
  EquilibriumSolver solver_;
  double heaviest_N_;
  ModelSurface surface_;
  ModelSurface::Values values_;
};

class FrontGaugeModelSurfaceTest : public ModelSurfaceTest {
 protected:
  FrontGaugeModelSurfaceTest() : ModelSurfaceTest(WithFrontGauge()) {}
  static Finger WithFrontGauge() {
    Finger finger = PaperFinger();
    finger.gauges[2].beam = Side::kFront;
    return finger;
  }
};

// The statics are exact, so the surface shows its own error. It lies far below
// any noise, also where the load folds the finger.
TEST_F(ModelSurfaceTest, AgreesWithTheStatics) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> arc(0, 140), force(0, 1);
  for (int i = 0; i < 300; ++i) {
    const double arc_mm = arc(generator);
    ExpectAsTheStatics(arc_mm, heaviest_N_ * std::pow(force(generator), 2));
  }
}

// A contact bends a gauge of the front beam differently on either side of its
// ends.
TEST_F(FrontGaugeModelSurfaceTest, AgreesWithTheStaticsBesideAGaugesEnds) {
  for (const double end_mm : {76.0, 94.0}) {
    for (const double beside_mm : {-0.3, -1e-3, 0.0, 1e-3, 0.3}) {
      ExpectAsTheStatics(end_mm + beside_mm, 3);
    }
  }
}

TEST_F(ModelSurfaceTest, EndsAtTheHeaviestForce) {
  EXPECT_TRUE(Serves(70, heaviest_N_));
  EXPECT_FALSE(Serves(70, 1.01 * heaviest_N_));
  EXPECT_FALSE(Serves(140.01, 1));
  EXPECT_FALSE(Serves(-0.01, 1));
  EXPECT_FALSE(Serves(std::nan(""), 1));
}

}  // namespace
}  // namespace finray

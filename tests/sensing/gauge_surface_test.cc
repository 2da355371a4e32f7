#include "finray/sensing/gauge_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_table.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kGaugeNoise_rad = 3e-4;

// The paper's finger, its statics, and its surface.
class GaugeSurfaceTest : public testing::Test {
 protected:
  explicit GaugeSurfaceTest(Finger finger = PaperFinger(),
                            std::optional<double> radius_mm = {})
      : finger_(std::move(finger)),
        solver_(finger_, {}),
        heaviest_N_(GaugeTable::HeaviestForce_N(finger_)),
        surface_(solver_, 0, radius_mm, heaviest_N_) {
    weights_.setConstant(static_cast<Eigen::Index>(finger_.gauges.size()),
                         1 / kGaugeNoise_rad);
  }

  Eigen::VectorXd Angles(double arc_mm, double normal_N) {
    EXPECT_TRUE(solver_.Solve({{arc_mm, normal_N}}));
    return solver_.outputs().head(weights_.size());
  }

  Finger finger_;
  EquilibriumSolver solver_;
  double heaviest_N_;
  GaugeSurface surface_;
  Eigen::VectorXd weights_;
};

class FrontGaugeSurfaceTest : public GaugeSurfaceTest {
 protected:
  FrontGaugeSurfaceTest() : GaugeSurfaceTest(WithFrontGauge()) {}
  static Finger WithFrontGauge() {
    Finger finger = PaperFinger();
    finger.gauges[2].beam = Side::kFront;
    return finger;
  }
};

constexpr double kMeasuredRadius_mm = 15;

class CircleSurfaceTest : public GaugeSurfaceTest {
 protected:
  CircleSurfaceTest() : GaugeSurfaceTest(PaperFinger(), kMeasuredRadius_mm) {}
};

// The statics are exact, so the surface shows its own error. It lies far below
// any noise, also where the load folds the finger.
TEST_F(GaugeSurfaceTest, AgreesWithTheStatics) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> arc(0, 140), force(0, 1);
  Eigen::VectorXd values;
  for (int i = 0; i < 300; ++i) {
    const double arc_mm = arc(generator);
    const double normal_N = heaviest_N_ * std::pow(force(generator), 2);
    ASSERT_TRUE(surface_.ValuesAt(arc_mm, normal_N, &values));
    EXPECT_LT((values - Angles(arc_mm, normal_N)).cwiseAbs().maxCoeff(),
              1e-5 * kGaugeNoise_rad)
        << arc_mm << " mm, " << normal_N << " N";
  }
}

// A contact bends a gauge of the front beam differently on either side of its
// ends.
TEST_F(FrontGaugeSurfaceTest, AgreesWithTheStaticsBesideAGaugesEnds) {
  Eigen::VectorXd values;
  for (const double end_mm : {76.0, 94.0}) {
    for (const double beside_mm : {-0.3, -1e-3, 0.0, 1e-3, 0.3}) {
      ASSERT_TRUE(surface_.ValuesAt(end_mm + beside_mm, 3, &values));
      EXPECT_LT((values - Angles(end_mm + beside_mm, 3)).cwiseAbs().maxCoeff(),
                1e-5 * kGaugeNoise_rad)
          << end_mm << " mm, " << beside_mm;
    }
  }
}

TEST_F(CircleSurfaceTest, CentresOfCirclesAgreeWithTheStatics) {
  Eigen::VectorXd values;
  for (double arc_mm = 0.3; arc_mm < 140; arc_mm += 3.1) {
    ASSERT_TRUE(surface_.ValuesAt(arc_mm, 2.3, &values));
    Angles(arc_mm, 2.3);
    const Eigen::Vector2d centre =
        CircleCentre(solver_.contact_pose(0), kMeasuredRadius_mm);
    EXPECT_LT((values.tail<2>() - centre).norm(), 1e-8) << arc_mm << " mm";
  }
}

TEST_F(GaugeSurfaceTest, EndsAtTheHeaviestForce) {
  Eigen::VectorXd values;
  EXPECT_TRUE(surface_.ValuesAt(70, heaviest_N_, &values));
  EXPECT_FALSE(surface_.ValuesAt(70, 1.01 * heaviest_N_, &values));
  EXPECT_FALSE(surface_.ValuesAt(140.01, 1, &values));
  EXPECT_FALSE(surface_.ValuesAt(-0.01, 1, &values));
  EXPECT_FALSE(surface_.ValuesAt(std::nan(""), 1, &values));
}

// A fit on the surface ends where a fit that solves the equilibria ends.
TEST_F(GaugeSurfaceTest, FitsAsTheLadderDoes) {
  ContactFit fit(finger_, {});
  fit.set_most_force(heaviest_N_);
  std::mt19937 generator(2);
  std::normal_distribution<double> noise(0, kGaugeNoise_rad);
  ContactSolution solution;
  for (double arc_mm = 32; arc_mm < 108; arc_mm += 5.3) {
    for (const double normal_N : {0.3, 1.1, 4.0, 11.0}) {
      Eigen::VectorXd angles = Angles(arc_mm, normal_N);
      for (double& angle : angles) angle += noise(generator);
      std::vector<PointContact> contacts = {{arc_mm, normal_N}};
      fit.set_state(solver_.state());
      ASSERT_TRUE(fit.Fit(angles, weights_, &contacts));
      ASSERT_TRUE(surface_.Fit(angles, weights_, heaviest_N_,
                               {arc_mm + 1.5, 0.9 * normal_N}, &solution));
      const Eigen::Vector2d off(
          solution.contacts[0].arc_mm - contacts[0].arc_mm,
          solution.contacts[0].normal_N - contacts[0].normal_N);
      EXPECT_LT(std::sqrt(off.dot(fit.information() * off)), 1e-4)
          << arc_mm << " " << normal_N;
      EXPECT_NEAR(solution.chi2, fit.chi2(), 1e-6 * (1 + fit.chi2()));
      EXPECT_LT((solution.information - fit.information()).norm(),
                1e-3 * fit.information().norm());
      EXPECT_LT((solution.poses[0] - fit.contact_pose(0)).norm(), 1e-4);
      EXPECT_LT((solution.tip_pose - fit.tip_pose()).norm(), 1e-4);
      for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(solution.rib_tension_N[i], fit.rib_tension(i), 1e-4);
      }
    }
  }
}

// Readings without noise show how exact a fit is: the contact comes back.
TEST_F(GaugeSurfaceTest, ExactReadingsGiveTheContact) {
  ContactSolution solution;
  for (double arc_mm = 21; arc_mm < 110; arc_mm += 7.7) {
    for (const double normal_N : {0.5, 3.0, 8.0}) {
      ASSERT_TRUE(surface_.Fit(Angles(arc_mm, normal_N), weights_, heaviest_N_,
                               {arc_mm - 2, 1.2 * normal_N}, &solution));
      EXPECT_NEAR(solution.contacts[0].arc_mm, arc_mm, 1e-5);
      EXPECT_NEAR(solution.contacts[0].normal_N, normal_N, 1e-7);
      EXPECT_LT(solution.chi2, 1e-9);
      EXPECT_LT(
          (solution.poses[0] - solver_.contact_pose(0)).cwiseAbs().maxCoeff(),
          1e-5);
    }
  }
}

// Readings that ask for more force than allowed leave the force on its bound,
// and the place at the best contact with that force.
TEST_F(GaugeSurfaceTest, StaysWithinItsBounds) {
  ContactSolution solution;
  const Eigen::VectorXd angles = Angles(70, 9);
  // These forces are no exact multiple of the unit.
  for (const double most_N : {1.5, 3.0, 4.0, 6.0}) {
    ASSERT_TRUE(surface_.Fit(angles, weights_, most_N, {60, 1}, &solution));
    EXPECT_EQ(solution.contacts[0].normal_N, most_N);
  }
  const double best = solution.chi2;
  Eigen::VectorXd values;
  for (const double beside_mm : {-0.1, 0.1}) {
    ASSERT_TRUE(
        surface_.ValuesAt(solution.contacts[0].arc_mm + beside_mm, 6, &values));
    EXPECT_GT(weights_.cwiseProduct(values - angles).squaredNorm(), best);
  }
}

// Without a reading of a gauge the others tell the contact.
TEST_F(GaugeSurfaceTest, MissingReadingsDoNotCount) {
  Eigen::VectorXd angles = Angles(70, 3), weights = weights_;
  angles[1] = 0.3;
  weights[1] = 0;
  ContactSolution solution;
  ASSERT_TRUE(surface_.Fit(angles, weights, heaviest_N_, {65, 2}, &solution));
  EXPECT_NEAR(solution.contacts[0].arc_mm, 70, 1e-4);
  EXPECT_NEAR(solution.contacts[0].normal_N, 3, 1e-5);
}

// Gauges whose noise is rounding ask for more than the surface has.
TEST_F(GaugeSurfaceTest, RefusesWhatItIsNotExactEnoughFor) {
  ContactSolution solution;
  const Eigen::VectorXd angles = Angles(70, 3);
  EXPECT_FALSE(
      surface_.Fit(angles, 1e10 * weights_, heaviest_N_, {69, 3}, &solution));
}

}  // namespace
}  // namespace finray

#include "finray/sensing/gauge_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"
#include "finray/sensing/fast/contact_fit.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kGaugeNoise_rad = 3e-4;

class GaugeSurfaceTest : public testing::Test {
 protected:
  GaugeSurfaceTest()
      : finger_(PaperFinger()),
        solver_(finger_, {}),
        table_(&solver_, 0, {}),
        surface_(table_, finger_),
        length_mm_(finger_.front_length_mm),
        unit_N_(ForceUnit(finger_)) {
    weights_.setConstant(4, 1 / kGaugeNoise_rad);
  }

  Eigen::VectorXd Angles(double arc_mm, double normal_N) {
    EXPECT_TRUE(solver_.Solve({{arc_mm, normal_N}}));
    return solver_.outputs().head<4>();
  }

  Finger finger_;
  EquilibriumSolver solver_;
  GaugeTable table_;
  GaugeSurface surface_;
  double length_mm_, unit_N_;
  Eigen::VectorXd weights_;
};

// The statics are exact, so the surface shows its own error. It stays far below
// the noise, between rows and between forces.
TEST_F(GaugeSurfaceTest, AgreesWithTheStatics) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> arc(1, 139.5), force(0.05, 8);
  for (int i = 0; i < 200; ++i) {
    const double arc_mm = arc(generator), normal_N = force(generator);
    const Eigen::VectorXd angles = Angles(arc_mm, normal_N);
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(surface_.At(j, arc_mm / length_mm_, normal_N / unit_N_).value,
                  angles[j], 0.2 * kGaugeNoise_rad)
          << arc_mm << " mm, " << normal_N << " N";
    }
  }
}

// The centre of a measured circle moves along the beam, at the clamp too.
TEST_F(GaugeSurfaceTest, CentresOfCirclesAgreeWithTheStatics) {
  constexpr double kRadius_mm = 15, kNoise_mm = 0.1;
  const GaugeTable table(&solver_, 0, kRadius_mm);
  const GaugeSurface surface(table, finger_);
  for (double arc_mm = 0.3; arc_mm < 140; arc_mm += 3.1) {
    Angles(arc_mm, 2.3);
    const Eigen::Vector2d centre =
        CircleCentre(solver_.contact_pose(0), kRadius_mm);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(surface.At(4 + i, arc_mm / length_mm_, 2.3 / unit_N_).value,
                  centre[i], 0.2 * kNoise_mm)
          << arc_mm << " mm";
    }
  }
}

TEST_F(GaugeSurfaceTest, DerivativesAreThoseOfTheValue) {
  constexpr double kStep = 1e-5;
  for (const double arc : {0.004, 0.31, 0.62, 0.995}) {
    for (const double force : {0.2, 1.7, 8.3, 33.0}) {
      for (int j = 0; j < 4; ++j) {
        const auto at = [&](double by_arc, double by_force) {
          return surface_.At(j, arc + by_arc, force + by_force);
        };
        const GaugeSurface::Value s = at(0, 0);
        const GaugeSurface::Value right = at(kStep, 0), left = at(-kStep, 0),
                                  up = at(0, kStep), down = at(0, -kStep);
        const auto slope = [](double above, double below) {
          return (above - below) / (2 * kStep);
        };
        EXPECT_NEAR(s.by_arc, slope(right.value, left.value), 1e-6);
        EXPECT_NEAR(s.by_force, slope(up.value, down.value), 1e-8);
        EXPECT_NEAR(s.by_arc_arc, slope(right.by_arc, left.by_arc), 1e-4);
        EXPECT_NEAR(s.by_arc_force, slope(up.by_arc, down.by_arc), 1e-6);
        EXPECT_NEAR(s.by_force_force, slope(up.by_force, down.by_force), 1e-8);
      }
    }
  }
}

// A descent ends where a fit by the ladder ends, and the fit that goes on from
// there takes two thirds of the iterations.
TEST_F(GaugeSurfaceTest, AFitGoesOnFromItsEnd) {
  ContactFit fit(finger_, {});
  fit.set_most_force(table_.heaviest_N());
  std::mt19937 generator(2);
  std::normal_distribution<double> noise(0, kGaugeNoise_rad);
  std::vector<ContactStart> profile, starts;
  int directly = 0, by_surface = 0;
  for (double arc_mm = 32; arc_mm < 108; arc_mm += 5.3) {
    for (const double normal_N : {0.3, 1.1, 4.0}) {
      Eigen::VectorXd angles = Angles(arc_mm, normal_N);
      for (double& angle : angles) angle += noise(generator);
      table_.Profile(angles, weights_, &profile);
      GaugeTable::FindStarts(profile, &starts);
      ASSERT_FALSE(starts.empty());
      const ContactStart& start = starts[0];
      ContactStart end = start;
      ASSERT_TRUE(
          surface_.Descend(angles, weights_, table_.heaviest_N(), &end));
      std::vector<PointContact> one = {start.contacts[0]},
                                other = {end.contacts[0]};
      fit.set_state(*start.state);
      ASSERT_TRUE(fit.Fit(angles, weights_, &one));
      directly += fit.iterations();
      const ContactMatrix information = fit.information();
      const double chi2 = fit.chi2();
      const auto deviations = [&](const PointContact& contact) {
        const Eigen::Vector2d off(contact.arc_mm - one[0].arc_mm,
                                  contact.normal_N - one[0].normal_N);
        return std::sqrt(off.dot(information * off));
      };
      EXPECT_LT(deviations(end.contacts[0]), 0.2);
      LadderState between;
      if (table_.StateAt(end.contacts[0].arc_mm, end.contacts[0].normal_N,
                         &between)) {
        fit.set_state(between);
      } else {
        fit.set_state(*start.state);
        ASSERT_TRUE(fit.Settle(other));
        ++by_surface;
      }
      ASSERT_TRUE(fit.Finish(angles, weights_, surface_, &other));
      by_surface += fit.iterations();
      EXPECT_LT(deviations(other[0]), 1e-5) << arc_mm << " " << normal_N;
      EXPECT_NEAR(fit.chi2(), chi2, 1e-8 * (1 + chi2));
    }
  }
  EXPECT_LT(by_surface, 0.7 * directly);
}

// The curvatures by which fits converge are those of the values.
TEST_F(GaugeSurfaceTest, CurvaturesAreThoseOfTheValues) {
  GaugeCurvatures second;
  surface_.CurvaturesAt(0.51, 2.2 / unit_N_, &second);
  ASSERT_EQ(second.rows(), 4);
  for (int j = 0; j < 4; ++j) {
    const GaugeSurface::Value s = surface_.At(j, 0.51, 2.2 / unit_N_);
    EXPECT_EQ(second(j, 0), s.by_arc_arc);
    EXPECT_EQ(second(j, 1), s.by_arc_force);
    EXPECT_EQ(second(j, 2), s.by_force_force);
  }
}

// A descent ends where the gradient of chi2 vanishes.
TEST_F(GaugeSurfaceTest, DescentEndsInAMinimum) {
  Eigen::VectorXd angles = Angles(71, 2.2);
  angles += Eigen::Vector4d(8e-4, -6e-4, 9e-4, -5e-4);
  std::vector<ContactStart> profile, starts;
  table_.Profile(angles, weights_, &profile);
  GaugeTable::FindStarts(profile, &starts);
  ContactStart end = starts[0];
  ASSERT_TRUE(surface_.Descend(angles, weights_, table_.heaviest_N(), &end));
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double most = 0;
  for (int j = 0; j < 4; ++j) {
    const GaugeSurface::Value s =
        surface_.At(j, end.contacts[0].arc_mm / length_mm_,
                    end.contacts[0].normal_N / unit_N_);
    const double off = weights_[j] * weights_[j] * (s.value - angles[j]);
    gradient += off * Eigen::Vector2d(s.by_arc, s.by_force);
    most += weights_[j] * weights_[j] *
            (s.by_arc * s.by_arc + s.by_force * s.by_force);
  }
  EXPECT_LT(gradient.norm(), 1e-3 * most);
}

TEST_F(GaugeSurfaceTest, EndsWithTheTable) {
  EXPECT_TRUE(surface_.Covers(table_.heaviest_N() / unit_N_));
  EXPECT_FALSE(surface_.Covers(1.01 * table_.heaviest_N() / unit_N_));
}

}  // namespace
}  // namespace finray

// The law of a bending rib against the elastica, closed forms and differences.

#include "finray/ladder/rib_law.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace finray {
namespace {

using Turns = std::array<double, 2>;
constexpr double kClampedEnd = std::numeric_limits<double>::infinity();
constexpr double kRibLength = 30, kRibStiffness = 1500;
constexpr double kRibForce = kRibStiffness / (kRibLength * kRibLength);

RibLaw ClampedRib() {
  return {kRibLength, kRibStiffness, {0, 0}, {kClampedEnd, kClampedEnd}};
}
RibLaw JoinedRib() {
  return {kRibLength, kRibStiffness, {1.5, 3}, {400, kClampedEnd}};
}

// A beam of any rotation whose ends lie on a line and are turned against it:
// theta' = M / EI (0 in rigid ends), M' = T sin(theta) - Q cos(theta), by Runge
// and Kutta's method; M at the front and Q by Newton's from the law's.
struct Elastica {
  double moment[2], bow;
  bool solved;
};

Elastica SolveElastica(const RibLaw& rib, double tension, const Turns& turn,
                       const RibReaction& start) {
  const double pieces[3] = {rib.end[0], rib.length - rib.end[0] - rib.end[1],
                            rib.end[1]};
  const auto shoot = [&](const Eigen::Vector2d& at) {
    // theta, M, x, y
    Eigen::Vector4d z(turn[0] + at[0] / rib.hinge_stiffness[0], at[0], 0, 0);
    for (int piece = 0; piece < 3; ++piece) {
      const double bends = piece == 1 ? 1 / rib.bending_stiffness : 0;
      const int steps = piece == 1 ? 800 : 20;
      const double h = pieces[piece] / steps;
      const auto slope = [&](const Eigen::Vector4d& by) -> Eigen::Vector4d {
        const double c = std::cos(by[0]), s = std::sin(by[0]);
        return {by[1] * bends, tension * s - at[1] * c, c, s};
      };
      for (int i = 0; i < steps; ++i) {
        const Eigen::Vector4d a = slope(z), b = slope(z + h / 2 * a),
                              c = slope(z + h / 2 * b), d = slope(z + h * c);
        z += h / 6 * (a + 2 * b + 2 * c + d);
      }
    }
    return z;
  };
  const auto miss = [&](const Eigen::Vector4d& z) {
    return Eigen::Vector2d(z[0] - turn[1] + z[1] / rib.hinge_stiffness[1],
                           z[3] / rib.length);
  };
  Eigen::Vector2d x(-start.moment[0],
                    -(start.moment[0] + start.moment[1]) / rib.length);
  const Eigen::Vector2d unit(kRibForce * kRibLength, kRibForce);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector4d z = shoot(x);
    const Eigen::Vector2d off = miss(z);
    if (off.norm() < 1e-12) return {{-x[0], z[1]}, rib.length - z[2], true};
    Eigen::Matrix2d by;
    for (int k = 0; k < 2; ++k) {
      Eigen::Vector2d moved = x;
      moved[k] += 1e-6 * unit[k];
      by.col(k) = (miss(shoot(moved)) - off) / 1e-6;
    }
    x -= unit.cwiseProduct(by.inverse() * off);
  }
  return {{}, 0, false};
}

// The largest difference of moments, over the larger of them and of what an arc
// has, and of the shortening.
double Difference(const RibReaction& law, const Elastica& exact,
                  const Turns& turn) {
  const double arc = 2 * kRibStiffness / kRibLength *
                     std::max(std::abs(turn[0]), std::abs(turn[1]));
  const double scale =
      std::max({std::abs(exact.moment[0]), std::abs(exact.moment[1]), arc});
  return std::max({std::abs(law.moment[0] - exact.moment[0]) / scale,
                   std::abs(law.moment[1] - exact.moment[1]) / scale,
                   std::abs(law.bow - exact.bow) / exact.bow});
}

TEST(RibLawTest, AgreesWithTheElastica) {
  double worst[3] = {};  // with a bow of up to 0.1 %, 1 % and 4 %
  double worst_taut = 0;
  for (const RibLaw& rib : {ClampedRib(), JoinedRib()}) {
    for (const double tension : {-25.0, -12.0, -3.0, 0.0, 4.0, 30.0}) {
      for (const Turns& shape :
           {Turns{1, 1}, {1, -1}, {1, 0}, {-0.3, 1}, {0.7, -1}}) {
        for (const double size : {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5}) {
          const Turns turn = {size * shape[0], size * shape[1]};
          const RibReaction law =
              React(rib, tension * kRibForce, turn.data(), false);
          const double bow = law.bow / kRibLength;
          if (bow > 0.04) continue;
          const Elastica exact =
              SolveElastica(rib, tension * kRibForce, turn, law);
          ASSERT_TRUE(exact.solved) << tension << " " << size;
          const double off = Difference(law, exact, turn);
          if (tension >= 0) worst_taut = std::max(worst_taut, off);
          for (int k = 0; k < 3; ++k) {
            const double up_to[] = {1e-3, 1e-2, 4e-2};
            if (bow <= up_to[k]) worst[k] = std::max(worst[k], off);
          }
        }
      }
    }
  }
  std::printf(
      "against the elastica: %.2g with a bow of up to 0.1 %%, %.2g of 1 %%, "
      "%.2g of 4 %%; without compression %.2g\n",
      worst[0], worst[1], worst[2], worst_taut);
  EXPECT_LT(worst[0], 2e-3);
  EXPECT_LT(worst[1], 2e-2);
  EXPECT_LT(worst[2], 7e-2);
  EXPECT_LT(worst_taut, 4.5e-2);
}

TEST(RibLawTest, HasTheClosedFormsOfBeams) {
  const Turns turn = {0.1, -0.04};
  const RibReaction at = React(ClampedRib(), 0, turn.data(), false);
  const double unit = kRibStiffness / kRibLength;
  EXPECT_NEAR(at.stiffness[0], 4 * unit, 1e-12 * unit);
  EXPECT_NEAR(at.stiffness[1], 2 * unit, 1e-12 * unit);
  EXPECT_NEAR(at.stiffness[2], 4 * unit, 1e-12 * unit);
  // Half the mean square of the cubic's slope.
  EXPECT_NEAR(
      at.bow,
      kRibLength *
          (2 * turn[0] * turn[0] + 2 * turn[1] * turn[1] - turn[0] * turn[1]) /
          30,
      1e-12);
  // Under a large tension an end is sqrt(T EI) stiff.
  const double taut = 1e4 * kRibForce;
  EXPECT_NEAR(React(ClampedRib(), taut, turn.data(), false).stiffness[0] /
                  std::sqrt(taut * kRibStiffness),
              1, 0.02);
}

// Euler's loads: clamped 4 pi^2, on hinges pi^2, one end clamped 20.19.
TEST(RibLawTest, IsSilentPastTheBucklingLoad) {
  const Turns turn = {0.01, -0.01};
  RibLaw hinged = ClampedRib(), half = ClampedRib();
  hinged.hinge_stiffness[0] = hinged.hinge_stiffness[1] = 1e-6;
  half.hinge_stiffness[0] = 1e-6;
  const std::vector<std::pair<RibLaw, double>> cases = {
      {ClampedRib(), 4 * M_PI * M_PI}, {hinged, M_PI * M_PI}, {half, 20.1907}};
  for (const auto& [rib, load] : cases) {
    EXPECT_TRUE(std::isfinite(
        React(rib, -0.999 * load * kRibForce, turn.data(), true).bow));
    const RibReaction past =
        React(rib, -1.001 * load * kRibForce, turn.data(), true);
    EXPECT_TRUE(std::isnan(past.bow)) << load;
    EXPECT_TRUE(std::isnan(past.moment[0]));
  }
}

TEST(RibLawTest, DerivativesMatchDifferences) {
  const Turns turn = {0.2, -0.07};
  const auto numbers = [](const RibReaction& at) {
    return Eigen::Vector3d(at.moment[0], at.moment[1], at.bow);
  };
  RibLaw both = JoinedRib();
  both.hinge_stiffness[1] = 400;
  for (const RibLaw& rib : {ClampedRib(), JoinedRib(), both}) {
    // At 8 the series ends and the closed form begins.
    for (const double tension : {-30.0, -8.02, 0.0, 7.98, 8.02, 300.0}) {
      const double force = tension * kRibForce;
      const auto at = [&](double by_force, const RibLaw& of,
                          const Turns& turned) {
        return React(of, force + by_force, turned.data(), true);
      };
      const RibReaction here = at(0, rib, turn);
      const auto expect = [&](const Eigen::Vector3d& slope,
                              const Eigen::Vector3d& analytic) {
        EXPECT_LT((slope - analytic).norm(), 1e-6 * (analytic.norm() + 1e-3))
            << tension << ": " << slope.transpose() << ", "
            << analytic.transpose();
      };
      const double h = 1e-4 * kRibForce;
      expect((numbers(at(h, rib, turn)) - numbers(at(-h, rib, turn))) / (2 * h),
             {here.moment_by_tension[0], here.moment_by_tension[1],
              here.bow_by_tension});
      for (int end = 0; end < 2; ++end) {
        Turns more = turn, less = turn;
        more[end] += 1e-5;
        less[end] -= 1e-5;
        expect((numbers(at(0, rib, more)) - numbers(at(0, rib, less))) / 2e-5,
               {here.stiffness[end], here.stiffness[1 + end],
                here.moment_by_tension[end]});
      }
      for (int by = 0; by < 3; ++by) {
        RibLaw low = rib, high = rib;
        const double step = by == kByLength ? 1e-4 : 1e-2;
        const auto move = [&](RibLaw* of, double d) {
          if (by == kByLength) of->length += d;
          if (by == kByBending) of->bending_stiffness += d;
          if (by == kByHinge) {
            for (double& k : of->hinge_stiffness) k += d;
          }
        };
        move(&low, -step);
        move(&high, step);
        expect((numbers(at(0, high, turn)) - numbers(at(0, low, turn))) /
                   (2 * step),
               Eigen::Map<const Eigen::Vector3d>(here.by[by]));
      }
    }
  }
}

}  // namespace
}  // namespace finray

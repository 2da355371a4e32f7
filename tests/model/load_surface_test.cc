#include "finray/model/load_surface.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace finray {
namespace {

// Closed forms that fall off as equilibria do, with their derivatives.
struct Closed {
  double value, by_arc, by_force;
};
Closed ClosedAt(double l, double f) {
  const double s = std::sin(0.3 * l + 0.1), c = std::cos(0.3 * l + 0.1);
  const double e = std::exp(-0.2 * f);
  return {s * e, 0.3 * c * e, -0.2 * s * e};
}

LoadSampler Smooth() {
  return [](double l, double f, double* to) {
    to[0] = ClosedAt(l, f).value;
    to[1] = l * f;
    to[2] = l + 2 * f;
    return true;
  };
}

LoadSurface MakeSurface(LoadSampler (*sampler)(), double resolution = 1e-10) {
  return LoadSurface(
      {{0, 2, 7}, {0, 3, 8, 11}},
      {{1, 2}, Eigen::VectorXd::Constant(1, resolution), sampler});
}

TEST(LoadSurfaceTest, ValuesAndDerivativesAreThoseOfAClosedForm) {
  const LoadSurface surface = MakeSurface(Smooth);
  LoadSurface::Place place;
  for (double l = 0; l <= 7; l += 0.35) {
    for (double f = 0; f <= 11; f += 0.55) {
      ASSERT_TRUE(surface.Locate(l, f, &place));
      EXPECT_LE(place.error(), 1);
      double gradients[3 * 4], others[4];
      surface.Gradients(place, 0, gradients);
      const Closed exact = ClosedAt(l, f);
      EXPECT_NEAR(gradients[0], exact.value, 1e-10);
      EXPECT_NEAR(gradients[4], exact.by_arc, 1e-8);
      EXPECT_NEAR(gradients[8], exact.by_force, 1e-8);
      surface.Values(place, 1, others);
      EXPECT_NEAR(others[0], l * f, 1e-12);
      EXPECT_NEAR(others[1], l + 2 * f, 1e-12);
    }
  }
}

TEST(LoadSurfaceTest, NothingLiesOutsideItsDomain) {
  const LoadSurface surface = MakeSurface(Smooth);
  LoadSurface::Place place;
  EXPECT_TRUE(surface.Locate(7, 11, &place));
  EXPECT_FALSE(surface.Locate(7.001, 1, &place));
  EXPECT_FALSE(surface.Locate(-0.001, 1, &place));
  EXPECT_FALSE(surface.Locate(1, 11.001, &place));
  EXPECT_FALSE(surface.Locate(1, std::nan(""), &place));
}

// Bends too sharply for one cell.
LoadSampler Sharp() {
  return [](double l, double f, double* to) {
    to[0] = std::tanh(2 * (l - 4.4) + 0.3 * (f - 5));
    to[1] = to[2] = 0;
    return true;
  };
}

TEST(LoadSurfaceTest, ACellIsHalvedWhereItsSeriesIsNotEnough) {
  const LoadSurface surface = MakeSurface(Sharp, 1e-6);
  LoadSurface::Place place;
  for (double l = 0.01; l < 7; l += 0.17) {
    for (double f = 0.01; f < 11; f += 0.37) {
      ASSERT_TRUE(surface.Locate(l, f, &place));
      double gradients[3 * 4];
      surface.Gradients(place, 0, gradients);
      const double off =
          gradients[0] - std::tanh(2 * (l - 4.4) + 0.3 * (f - 5));
      EXPECT_LT(std::abs(off), 1e-6 * std::max(1.0, 4 * place.error()))
          << l << " " << f;
    }
  }
}

// A kink cannot be resolved, and the error says so.
LoadSampler Kinked() {
  return [](double l, double f, double* to) {
    to[0] = std::abs(l - 4.4) + f;
    to[1] = to[2] = 0;
    return true;
  };
}

TEST(LoadSurfaceTest, TheErrorTellsOfAKink) {
  const LoadSurface surface = MakeSurface(Kinked, 1e-8);
  LoadSurface::Place place;
  ASSERT_TRUE(surface.Locate(4.41, 5, &place));
  EXPECT_GT(place.error(), 100);
  ASSERT_TRUE(surface.Locate(1, 5, &place));
  EXPECT_LT(place.error(), 1);
}

// No equilibrium beyond a load.
LoadSampler Folded() {
  return [](double l, double f, double* to) {
    to[0] = l * f;
    to[1] = to[2] = 0;
    return f < 9.5;
  };
}

TEST(LoadSurfaceTest, NoCellLiesWhereThereIsNoEquilibrium) {
  const LoadSurface surface = MakeSurface(Folded);
  LoadSurface::Place place;
  EXPECT_FALSE(surface.Locate(3, 10.5, &place));
  EXPECT_TRUE(surface.Locate(3, 7, &place));
  EXPECT_TRUE(surface.Locate(3, 9, &place));  // half of a cell
}

std::atomic<int> cells_made{0};
LoadSampler Counted() {
  ++cells_made;
  return Smooth();
}

TEST(LoadSurfaceTest, ThreadsShareCellsThatAreMadeWhenNeeded) {
  cells_made = 0;
  const LoadSurface surface = MakeSurface(Counted);
  EXPECT_EQ(cells_made, 0);
  std::vector<std::thread> threads;
  std::array<double, 4> values{};
  for (double& value : values) {
    threads.emplace_back([&surface, to = &value] {
      LoadSurface::Place place;
      double gradients[3 * 4];
      for (int i = 0; i < 100; ++i) {
        if (surface.Locate(1, 1, &place))
          surface.Gradients(place, 0, gradients);
      }
      *to = gradients[0];
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(cells_made, 2);  // one, made again if it needs more terms
  for (const double value : values) EXPECT_EQ(value, values[0]);
}

TEST(LoadSurfaceTest, AllCellsAreMadeBeforehandAsTheyAreWhenNeeded) {
  const LoadSurface surface = MakeSurface(Counted), lazy = MakeSurface(Smooth);
  surface.MakeAll();
  cells_made = 0;
  LoadSurface::Place made, needed;
  for (const double l : {1.0, 6.0}) {
    for (const double f : {1.0, 5.0, 10.0}) {
      ASSERT_TRUE(surface.Locate(l, f, &made));
      ASSERT_TRUE(lazy.Locate(l, f, &needed));
      double gradients[2][3 * 4];
      surface.Gradients(made, 0, gradients[0]);
      lazy.Gradients(needed, 0, gradients[1]);
      for (int i = 0; i < 3 * 4; ++i)
        EXPECT_EQ(gradients[0][i], gradients[1][i]);
    }
  }
  EXPECT_EQ(cells_made, 0);
}

// The domain has six cells. One of them holds two of the loads.
TEST(LoadSurfaceTest, CellsOfLoadsAreMadeBeforehand) {
  const LoadSurface surface = MakeSurface(Counted);
  cells_made = 0;
  surface.MakeFor({{1, 1}, {6, 1}, {1.5, 2}, {1, 12}, {std::nan(""), 1}});
  const int made = cells_made;
  EXPECT_GE(made, 2);
  LoadSurface::Place place;
  EXPECT_TRUE(surface.Locate(0.5, 2.5, &place));
  EXPECT_TRUE(surface.Locate(3, 0, &place));
  EXPECT_EQ(cells_made, made);
  EXPECT_TRUE(surface.Locate(1, 5, &place));
  EXPECT_GT(cells_made, made);
}

}  // namespace
}  // namespace finray

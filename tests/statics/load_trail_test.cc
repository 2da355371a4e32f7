// The guess of three equilibria: its order, and what it saves a solver.

#include "finray/statics/load_trail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr double kLength_mm = 100, kForceUnit_N = 2;

std::vector<PointContact> At(double arc, double force) {
  return {{arc * kLength_mm, force * kForceUnit_N, 0}};
}

// A state that is a polynomial of the load.
Vector2d Linear(double arc, double force) {
  return {1 + 2 * arc - 3 * force, arc + force};
}
Vector2d Quadratic(double arc, double force) {
  return {arc * arc - 2 * force, arc * force + force * force};
}

template <class F>
Vector2d Guess(F state, const std::vector<Vector2d>& loads,
               const Vector2d& next) {
  LoadTrail trail(kLength_mm, kForceUnit_N);
  Vector2d z;
  for (const Vector2d& load : loads) {
    z = state(load.x(), load.y());
    trail.Add(At(load.x(), load.y()), z.data(), 2);
  }
  EXPECT_TRUE(trail.Predict(At(next.x(), next.y()), z.data(), 2));
  return z;
}

// Three loads off one line determine a plane.
TEST(LoadTrailTest, IsRightToFirstOrderInAPlane) {
  for (const double h : {1e-2, 1e-3}) {
    const Vector2d guess =
        Guess(Linear, {{0.5, 1}, {0.5 + h, 1 - h}, {0.5 + h, 1 + h}},
              {0.5 + 2 * h, 1 + 0.5 * h});
    const Vector2d error = guess - Linear(0.5 + 2 * h, 1 + 0.5 * h);
    // The second term moves it by less than the square of the steps.
    EXPECT_LT(error.norm(), 10 * h * h) << h;
  }
}

TEST(LoadTrailTest, IsRightToSecondOrderOnALine) {
  const auto load = [](double t) { return Vector2d(0.5 + t, 1 - 2 * t); };
  for (const double h : {1e-2, 1e-3}) {
    const Vector2d next = load(3 * h);
    const Vector2d guess =
        Guess(Quadratic, {load(0), load(h), load(2.1 * h)}, next);
    EXPECT_LT((guess - Quadratic(next.x(), next.y())).norm(), 1e-9);
  }
}

// A search for a load comes near it and then corrects it. If the trail kept
// both, its three loads would span a plane, and the guess would be right to
// first order only.
TEST(LoadTrailTest, ACorrectionTakesThePlaceOfTheNewestOne) {
  const double h = 1e-2;
  const auto load = [](double t) { return Vector2d(0.5 + t, 1 - 2 * t); };
  const Vector2d off(4e-4, 3e-4);
  const Vector2d next = load(3 * h);
  const Vector2d guess = Guess(
      Quadratic,
      {load(0), load(h) + off, load(h), load(2.1 * h) + off, load(2.1 * h)},
      next);
  EXPECT_LT((guess - Quadratic(next.x(), next.y())).norm(), 1e-9);
}

TEST(LoadTrailTest, StepsOfRoundingAndRepeatsAreNotKept) {
  const double h = 1e-2;
  const auto load = [](double t) { return Vector2d(0.5 + t, 1 - 2 * t); };
  const Vector2d off(4e-4, 3e-4), less(4e-12, 3e-12);
  const Vector2d next = load(3 * h);
  const Vector2d guess = Guess(
      Quadratic,
      {load(0), load(h) + off, load(h) + off, load(h), load(2.1 * h) + off,
       load(2.1 * h) + less, load(2.1 * h) - less, load(2.1 * h)},
      next);
  EXPECT_LT((guess - Quadratic(next.x(), next.y())).norm(), 1e-9);
}

// After a long step the first short one counts as a correction. The next ones
// are as long as it, and are kept.
TEST(LoadTrailTest, ShortStepsAreKept) {
  const double h = 1e-6;
  const auto load = [](double t) { return Vector2d(0.5 + t, 1 - 2 * t); };
  const Vector2d next = load(8 * h);
  const Vector2d guess =
      Guess(Linear,
            {load(-0.1), load(0), load(2 * h), load(4 * h), load(6 * h)}, next);
  EXPECT_LT((guess - Linear(next.x(), next.y())).norm(), 1e-12);
}

TEST(LoadTrailTest, TwoLoadsMakeALine) {
  const Vector2d guess = Guess(Linear, {{0.5, 1}, {0.51, 1.01}}, {0.52, 1.02});
  EXPECT_LT((guess - Linear(0.52, 1.02)).norm(), 1e-2 * 0.05);
}

TEST(LoadTrailTest, SaysNothingOfOtherContacts) {
  LoadTrail trail(kLength_mm, kForceUnit_N);
  Vector2d z(1, 2);
  const auto predicts = [&](const std::vector<PointContact>& contacts) {
    Vector2d guess = z;
    const bool says = trail.Predict(contacts, guess.data(), 2);
    EXPECT_TRUE(says || guess == z);
    return says;
  };
  EXPECT_FALSE(predicts(At(0.5, 1)));
  trail.Add(At(0.5, 1), z.data(), 2);
  EXPECT_FALSE(predicts(At(0.5, 1.1)));  // one point
  trail.Add(At(0.5, 1), z.data(), 2);
  EXPECT_FALSE(predicts(At(0.5, 1.1)));  // twice the same load
  trail.Add(At(0.5, 1.01), z.data(), 2);
  trail.Add(At(0.51, 1.02), z.data(), 2);
  EXPECT_TRUE(predicts(At(0.505, 1.02)));
  EXPECT_FALSE(predicts(At(0.9, 5)));  // far away
  EXPECT_FALSE(predicts(At(NAN, 1.03)));
  std::vector<PointContact> other = At(0.5, 1.03);
  other[0].friction = 0.1;
  EXPECT_FALSE(predicts(other));
  other[0] = {50, 2.06, 0, Side::kBack};
  EXPECT_FALSE(predicts(other));
  EXPECT_FALSE(predicts({}));
  trail.Add({}, z.data(), 2);
  EXPECT_FALSE(predicts(At(0.5, 1.03)));
  trail.Clear();
  trail.Add(At(0.5, 1), z.data(), 2);
  trail.Add(At(0.5, 1.01), z.data(), 2);
  EXPECT_TRUE(predicts(At(0.5, 1.02)));
  trail.Clear();
  EXPECT_FALSE(predicts(At(0.5, 1.02)));
}

// A solver on a path needs fewer iterations than one that forgets its trail. It
// finds the same equilibria to what its tolerance leaves, and under heavy loads
// on the same branch.
TEST(LoadTrailTest, SavesASolverIterations) {
  for (const double force : {1.5, 30.}) {
    EquilibriumSolver with(PaperFinger(), {}), without(PaperFinger(), {});
    with.set_tolerance(1e-6);
    without.set_tolerance(1e-6);
    int iterations = 0, forgetful = 0;
    for (int i = 0; i < 400; ++i) {
      const std::vector<PointContact> contacts = {
          {70 + 40 * std::sin(0.0015 * i),
           force * (1 + 0.5 * std::cos(0.006 * i)), 0}};
      ASSERT_TRUE(with.Solve(contacts));
      if (i > 0) without.set_state(without.state());  // forgets the others
      ASSERT_TRUE(without.Solve(contacts));
      EXPECT_LT((with.outputs() - without.outputs()).norm(), 1e-4) << i;
      iterations += with.iterations();
      forgetful += without.iterations();
    }
    std::printf("%g N: %d iterations, %d without a trail\n", force, iterations,
                forgetful);
    EXPECT_LT(iterations, (force < 2 ? 0.65 : 0.9) * forgetful);
  }
}

// A jump to a load that the trail leads away from is solved all the same.
TEST(LoadTrailTest, AJumpIsSolved) {
  EquilibriumSolver solver(PaperFinger(), {});
  for (int i = 0; i < 300; ++i) {
    const std::vector<PointContact> contacts = {
        {20 + 29. * (i * i % 5), 0.1 + 5.0 * (i * i % 7), 0}};
    ASSERT_TRUE(solver.Solve(contacts));
    EquilibriumSolver fresh(PaperFinger(), {});
    ASSERT_TRUE(fresh.Solve(contacts));
    EXPECT_LT((solver.outputs() - fresh.outputs()).norm(), 1e-9) << i;
  }
}

}  // namespace
}  // namespace finray

#include "finray/sensing/fast/frame_group_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "finray/sensing/gauge_surface.h"
#include "finray/statics/equilibrium.h"
#include "sensing/gauge_log.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kWeight = 1 / GaugeLog::kNoise_rad;

// Frames with the contacts given, noisy.
struct Frames {
  Frames(const Finger& finger, const std::vector<PointContact>& contacts)
      : truth(contacts),
        angles(finger.gauges.size(), contacts.size()),
        weights(
            Eigen::MatrixXd::Constant(angles.rows(), angles.cols(), kWeight)) {
    EquilibriumSolver solver(finger, {});
    std::mt19937_64 generator(3);
    std::normal_distribution<double> noise(0, GaugeLog::kNoise_rad);
    for (Eigen::Index i = 0; i < angles.cols(); ++i) {
      EXPECT_TRUE(solver.Solve({contacts[i]}));
      angles.col(i) = solver.outputs().head(angles.rows());
      for (double& angle : angles.col(i)) angle += noise(generator);
    }
  }
  std::vector<PointContact> truth;
  Eigen::MatrixXd angles, weights;
};

// Each frame against ContactFit from its true equilibrium; returns the share of
// frames that went in lanes.
double ExpectAsAlone(const Finger& finger, const Discretization& discretization,
                     const Frames& frames, const std::vector<FrameFit>& fits) {
  ContactFit alone(finger, discretization);
  alone.set_tolerance(1e-13);
  alone.set_most_force(40);
  EquilibriumSolver solver(finger, discretization);
  double worst = 0;
  int in_lanes = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const FrameFit& fit = fits[i];
    std::vector<PointContact> contacts = {frames.truth[i]};
    EXPECT_TRUE(solver.Solve(contacts));
    alone.set_state(solver.state());
    EXPECT_TRUE(
        alone.Fit(frames.angles.col(i), frames.weights.col(i), &contacts));
    EXPECT_TRUE(fit.converged) << i;
    in_lanes += fit.in_lanes;
    const double length = finger.front_length_mm;
    const double information = (fit.information - alone.information()).norm() /
                               alone.information().norm();
    double tension = 0, largest = 1e-3;
    for (Eigen::Index k = 0; k < fit.rib_tension_N.size(); ++k) {
      tension = std::max(tension,
                         std::abs(fit.rib_tension_N[k] - alone.rib_tension(k)));
      largest = std::max(largest, std::abs(alone.rib_tension(k)));
    }
    const double off =
        std::max({std::abs(fit.arc_mm - contacts[0].arc_mm) / length,
                  std::abs(fit.normal_N - contacts[0].normal_N) /
                      (contacts[0].normal_N + 1e-2),
                  (fit.contact_pose - alone.contact_pose(0)).norm() / length,
                  (fit.tip_pose - alone.tip_pose()).norm() / length,
                  std::abs(fit.chi2 - alone.chi2()) / (1 + alone.chi2()),
                  tension / largest});
    // The information is that of the last linearisation, a small change before
    // the end.
    EXPECT_LT(information, 1e-6) << "frame " << i;
    // Where the data hardly determine the contact, a fit alone may end 1e-5 std
    // away.
    EXPECT_LT(off, fit.in_lanes ? 1e-9 : 1e-7)
        << "frame " << i << ", " << fit.arc_mm << " mm, " << fit.normal_N
        << " N, in lanes " << fit.in_lanes;
    worst = std::max(worst, off);
  }
  const double share = static_cast<double>(in_lanes) / fits.size();
  std::printf("%.0f %% in lanes, within %.1e\n", 100 * share, worst);
  return share;
}

// With so many lanes.
class FrameGroupFitTest : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > FrameLanes()) {
      GTEST_SKIP() << "this machine has no registers for so many lanes";
    }
  }

  std::vector<FrameFit> FitInLanes(const Finger& finger,
                                   const Discretization& discretization,
                                   const Frames& frames, int block = 64,
                                   const GaugeSurface* surface = nullptr) {
    const PointContact first = frames.truth[0];
    const auto fitting =
        FrameGroupFit::Make(finger, discretization, first.friction, GetParam());
    FrameGroupFit& fit = *fitting;
    fit.set_surface(surface);
    fit.set_tolerance(1e-13);
    fit.set_most_force(40);
    EquilibriumSolver solver(finger, discretization);
    EXPECT_TRUE(solver.Solve({first}));
    fit.Start(solver.state(), first);
    const int count = static_cast<int>(frames.angles.cols());
    std::vector<FrameFit> fits(count);
    for (int i = 0; i < count; i += block) {
      const int here = std::min(block, count - i);
      fit.Fit(frames.angles.middleCols(i, here),
              frames.weights.middleCols(i, here), fits.data() + i);
    }
    return fits;
  }

  double Compare(const Finger& finger, const Discretization& discretization,
                 const Frames& frames) {
    return ExpectAsAlone(finger, discretization, frames,
                         FitInLanes(finger, discretization, frames));
  }
};
INSTANTIATE_TEST_SUITE_P(Lanes, FrameGroupFitTest, testing::Values(4, 8));

// Along the front beam and back, across all ribs.
std::vector<PointContact> Sweep(int count, double from_mm, double to_mm,
                                double force_N, double friction = 0) {
  std::vector<PointContact> contacts;
  for (int i = 0; i < count; ++i) {
    const double share = 0.5 - 0.5 * std::cos(6.0 * i / count);
    contacts.push_back({from_mm + share * (to_mm - from_mm),
                        force_N * (1 + 0.3 * std::sin(0.1 * i)), friction});
  }
  return contacts;
}

TEST_P(FrameGroupFitTest, EveryFrameIsAsFittedAlone) {
  const Finger finger = PaperFinger();
  const std::vector<PointContact> across = Sweep(402, 25, 110, 3);
  EXPECT_GT(Compare(finger, {Scheme::kTaylor8, 12}, {finger, across}), 0.9);
  EXPECT_GT(Compare(finger, {Scheme::kTaylor4, 24}, {finger, across}), 0.9);
  EXPECT_GT(Compare(finger, {}, {finger, across}), 0.9);
  EXPECT_GT(Compare(finger, {Scheme::kRigidChain, 50}, {finger, across}), 0.8);
  EXPECT_GT(Compare(finger, {Scheme::kTaylor8, 12},
                    {finger, Sweep(200, 40, 100, 2, 0.3)}),
            0.9);
  Finger other = finger;
  other.front_axial_stiffness_N = 1e4;
  other.ribs[2].axial_stiffness_N = 500;
  EXPECT_GT(
      Compare(other, {Scheme::kTaylor12, 12}, {other, Sweep(200, 40, 100, 2)}),
      0.9);
}

int Iterations(const std::vector<FrameFit>& fits) {
  int sum = 0;
  for (const FrameFit& fit : fits) sum += fit.iterations;
  return sum;
}

// The curvatures of a surface change the way of a fit and not its end.
// That holds under 3 and 10 N, and with the curvatures of a finger that is a
// little other.
TEST_P(FrameGroupFitTest, CurvaturesSaveIterations) {
  const Finger finger = PaperFinger();
  const Discretization discretization{Scheme::kTaylor8, 12};
  EquilibriumSolver solver(finger, {});
  const GaugeSurface surface(GaugeTable(&solver, 0, {}), finger);
  Finger other = finger;
  other.back_stiffness_N_mm2 *= 1.1;
  other.back_angle_rad += 0.01;
  EquilibriumSolver other_solver(other, {});
  const GaugeSurface other_surface(GaugeTable(&other_solver, 0, {}), other);
  const struct {
    double force_N;
    const GaugeSurface& surface;
    double share;
  } cases[] = {{3, surface, 0.9}, {10, surface, 0.95}, {3, other_surface, 0.9}};
  for (const auto& c : cases) {
    const Frames frames(finger, Sweep(402, 25, 110, c.force_N));
    const auto with =
        FitInLanes(finger, discretization, frames, 64, &c.surface);
    EXPECT_GT(ExpectAsAlone(finger, discretization, frames, with), 0.85);
    const auto without = FitInLanes(finger, discretization, frames);
    std::printf("%g N: %d iterations, without curvatures %d\n", c.force_N,
                Iterations(with), Iterations(without));
    EXPECT_LT(Iterations(with), c.share * Iterations(without));
  }
}

// With gauges on the touched beam, a lane whose contact is on another side of a
// gauge's end is fitted alone.
TEST_P(FrameGroupFitTest, GaugesBesideTheContact) {
  Finger finger = PaperFinger();
  finger.gauges[0].beam = Side::kFront;
  finger.gauges[0].start_mm = 66;
  const double share =
      Compare(finger, {Scheme::kTaylor8, 12}, {finger, Sweep(200, 50, 100, 2)});
  EXPECT_GT(share, 0.6);
  EXPECT_LT(share, 1);
}

// Contacts far apart, light contacts and jumps. Where the data hardly determine
// the contact, Gauss-Newton from another start may reach another minimum.
TEST_P(FrameGroupFitTest, MixedContacts) {
  const Finger finger = PaperFinger();
  std::mt19937_64 generator(8);
  std::uniform_real_distribution<double> arc(-12, 12), force(0.6, 1.6);
  std::vector<PointContact> contacts;
  for (int i = 0; i < 200; ++i) {
    contacts.push_back({70 + arc(generator), 3 * force(generator), 0});
  }
  const double share =
      Compare(finger, {Scheme::kTaylor8, 12}, {finger, contacts});
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 1);
}

// The bounds l_c <= l_0, f_c >= 0 and f_c <= 40 N hold in every lane.
TEST_P(FrameGroupFitTest, StaysWithinItsBounds) {
  const Finger finger = PaperFinger();
  Frames frames(finger, Sweep(64, 60, 80, 2));
  frames.angles.rightCols(48) *= -0.5;
  frames.angles.rightCols(16) *= -40;
  frames.truth[0] = {60, 2, 0};
  int converged = 0;
  for (const FrameFit& fit : FitInLanes(finger, {}, frames)) {
    if (!fit.converged) continue;
    ++converged;
    EXPECT_GE(fit.arc_mm, 0);
    EXPECT_LE(fit.arc_mm, 140);
    EXPECT_GE(fit.normal_N, 0);
    EXPECT_LE(fit.normal_N, 40 * (1 + 1e-12));
  }
  EXPECT_GE(converged, 16);
}

// One lane lacks a gauge, and others have different weights.
TEST_P(FrameGroupFitTest, LanesHaveTheirOwnWeights) {
  const Finger finger = PaperFinger();
  Frames frames(finger, Sweep(200, 40, 100, 3));
  for (int i = 0; i < 200; ++i) {
    frames.weights(i % 3, i) *= 0.3;
    if (i % 5 == 0) {
      frames.weights(3, i) = 0;
      frames.angles(3, i) = 0.7;
    }
  }
  EXPECT_GT(Compare(finger, {Scheme::kTaylor8, 12}, frames), 0.8);
}

// Frames that no contact explains disturb no other frame.
TEST_P(FrameGroupFitTest, AFrameThatDoesNotConvergeIsLeftOut) {
  const Finger finger = PaperFinger();
  const Discretization discretization{Scheme::kTaylor8, 12};
  Frames frames(finger, Sweep(128, 50, 100, 3));
  const std::vector<int> bad = {5, 40, 41, 42, 43, 90};
  for (const int i : bad) {
    frames.angles.col(i) << 2, -3, 3, -2;
    frames.angles.col(i) *= i;
  }
  std::vector<FrameFit> fits = FitInLanes(finger, discretization, frames);
  int lost = 0;
  for (const int i : bad) lost += !fits[i].converged || fits[i].chi2 > 1e6;
  EXPECT_EQ(lost, static_cast<int>(bad.size()));
  // The others.
  Frames good = frames;
  std::vector<FrameFit> good_fits;
  int kept = 0;
  for (int i = 0; i < 128; ++i) {
    if (std::find(bad.begin(), bad.end(), i) != bad.end()) continue;
    good.truth[kept] = frames.truth[i];
    good.angles.col(kept++) = frames.angles.col(i);
    good_fits.push_back(fits[i]);
  }
  ExpectAsAlone(finger, discretization, good, good_fits);
}

// Once the mesh has to be refined, frames are fitted one by one.
TEST_P(FrameGroupFitTest, AMeshThatIsTooCoarseIsRefined) {
  const Finger finger = PaperFinger();
  std::vector<PointContact> contacts;
  for (int i = 0; i < 100; ++i) contacts.push_back({70, 2 + 0.25 * i, 0});
  const Frames frames(finger, contacts);
  const std::vector<FrameFit> fits = FitInLanes(finger, {}, frames);
  EXPECT_TRUE(fits.front().in_lanes);
  EXPECT_FALSE(fits.back().in_lanes);
  ContactFit fine(finger, {Scheme::kTaylor, 96});
  EquilibriumSolver solver(finger, {Scheme::kTaylor, 96});
  for (int i = 0; i < 100; ++i) {
    std::vector<PointContact> contact = {contacts[i]};
    ASSERT_TRUE(solver.Solve(contact));
    fine.set_state(solver.state());
    ASSERT_TRUE(
        fine.Fit(frames.angles.col(i), frames.weights.col(i), &contact));
    ASSERT_TRUE(fits[i].converged) << i;
    EXPECT_NEAR(fits[i].arc_mm, contact[0].arc_mm, 1e-6) << i;
    EXPECT_NEAR(fits[i].normal_N, contact[0].normal_N, 1e-6) << i;
  }
}

TEST_P(FrameGroupFitTest, TheSameCallsGiveTheSameBits) {
  const Finger finger = PaperFinger();
  const Frames frames(finger, Sweep(150, 40, 100, 3));
  const auto once = FitInLanes(finger, {Scheme::kTaylor8, 12}, frames, 40);
  const auto again = FitInLanes(finger, {Scheme::kTaylor8, 12}, frames, 40);
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].arc_mm, again[i].arc_mm);
    EXPECT_EQ(once[i].normal_N, again[i].normal_N);
    EXPECT_EQ(once[i].chi2, again[i].chi2);
  }
}

// Dividing the frames into other calls gives the same results. Single frames
// are fitted alone until a call has more.
TEST_P(FrameGroupFitTest, CallsOfAnyLength) {
  const Finger finger = PaperFinger();
  const Discretization discretization{Scheme::kTaylor8, 12};
  const Frames frames(finger, Sweep(70, 40, 100, 3));
  for (const int block : {1, 3, 70}) {
    ExpectAsAlone(finger, discretization, frames,
                  FitInLanes(finger, discretization, frames, block));
  }
  const auto fit = FrameGroupFit::Make(finger, discretization, 0, GetParam());
  fit->set_tolerance(1e-13);
  EquilibriumSolver solver(finger, discretization);
  ASSERT_TRUE(solver.Solve({frames.truth[0]}));
  fit->Start(solver.state(), frames.truth[0]);
  std::vector<FrameFit> fits(70);
  int i = 0;
  for (const int count : {1, 1, 20, 1, 47}) {
    fit->Fit(frames.angles.middleCols(i, count),
             frames.weights.middleCols(i, count), &fits[i]);
    i += count;
  }
  EXPECT_FALSE(fits[0].in_lanes);
  EXPECT_FALSE(fits[1].in_lanes);
  EXPECT_TRUE(fits[2].in_lanes);
  EXPECT_TRUE(fits[22].in_lanes);
  ExpectAsAlone(finger, discretization, frames, fits);
}

TEST_P(FrameGroupFitTest, FollowsALogToTheLeastSquares) {
  const GaugeLog log(4160);
  const Discretization discretization{Scheme::kTaylor8, 12};
  const std::vector<PointContact> same = log.LeastSquares(discretization);
  const std::vector<PointContact> fine =
      log.LeastSquares({Scheme::kTaylor, 96});
  ASSERT_EQ(same.size(), log.truth.size());
  const auto fitting =
      FrameGroupFit::Make(PaperFinger(), discretization, 0, GetParam());
  FrameGroupFit& fit = *fitting;
  fit.set_tolerance(1e-5);
  fit.Start(log.StateAt(discretization, 0), log.truth[0]);
  std::vector<FrameFit> fits(same.size());
  fit.Fit(log.angles, log.weights, fits.data());
  double worst_same = 0, worst_fine = 0, worst_force = 0;
  int iterations = 0, alone = 0;
  for (std::size_t i = 0; i < same.size(); ++i) {
    ASSERT_TRUE(fits[i].converged);
    iterations += fits[i].iterations;
    alone += !fits[i].in_lanes;
    worst_same =
        std::max(worst_same, std::abs(fits[i].arc_mm - same[i].arc_mm));
    worst_fine =
        std::max(worst_fine, std::abs(fits[i].arc_mm - fine[i].arc_mm));
    worst_force = std::max(worst_force,
                           std::abs(fits[i].normal_N / fine[i].normal_N - 1));
  }
  std::printf("%.2f linearisations, %d alone, %.1e mm; %.1e mm and %.1e %%\n",
              static_cast<double>(iterations) / same.size(), alone, worst_same,
              worst_fine, 100 * worst_force);
  EXPECT_LT(worst_same, 1e-3);
  EXPECT_LT(worst_fine, 0.01);
  EXPECT_LT(worst_force, 1e-3);
  EXPECT_LT(alone, 20);
}

}  // namespace
}  // namespace finray

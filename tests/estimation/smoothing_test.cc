#include "finray/estimation/smoothing.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <random>

#include "finray/estimation/frame_estimator.h"
#include "studies/ramps.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise = 3e-4;

Scene SmoothScene(double contact_mm, double normal_N) {
  Scene scene;
  scene.contacts = 1;
  scene.smoothing = {contact_mm, normal_N};
  return scene;
}

// A contact that wanders as the scene's prior says.
struct Walk {
  Walk(int frames, double contact_mm, double normal_N, unsigned seed) {
    EquilibriumSolver solver(PaperFinger(), {});
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal(0, 1);
    Eigen::Vector2d x(70, 1.5);
    for (int i = 0; i < frames; ++i) {
      if (i > 0) {
        x[0] += contact_mm * normal(generator);
        x[1] = std::max(0.5, x[1] + normal_N * normal(generator));
      }
      EXPECT_TRUE(solver.Solve({{x[0], x[1], 0}}));
      truth.push_back(x);
      readings.emplace_back();
      for (int j = 0; j < 4; ++j) {
        readings.back().gauges_V.push_back(solver.gauge_angle(j) +
                                           kNoise * normal(generator));
      }
    }
  }
  std::vector<Eigen::Vector2d> truth;
  std::vector<Measurements> readings;
};

TEST(SmoothingTest, IsTheLeastOfTheWholeCost) {
  // A dense Gauss-Newton over all frames at once, from finite differences.
  constexpr int kFrames = 6;
  const Walk walk(kFrames, 0.4, 0.1, 1);
  const Scene scene = SmoothScene(0.4, 0.1);
  std::vector<FrameEstimate> estimates(kFrames);
  FrameEstimator estimator(PaperFinger(), scene, {});
  estimator.EstimateBlock(walk.readings.data(), kFrames, estimates.data());

  EquilibriumSolver solver(PaperFinger(), {});
  const auto residuals = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd r(4 * kFrames + 2 * (kFrames - 1));
    for (int t = 0; t < kFrames; ++t) {
      EXPECT_TRUE(solver.Solve({{x[2 * t], x[2 * t + 1], 0}}));
      for (int j = 0; j < 4; ++j) {
        r[4 * t + j] =
            (solver.gauge_angle(j) - walk.readings[t].gauges_V[j]) / kNoise;
      }
      if (t == 0) continue;
      const int row = 4 * kFrames + 2 * (t - 1);
      r[row] = (x[2 * t] - x[2 * t - 2]) / 0.4;
      r[row + 1] = (x[2 * t + 1] - x[2 * t - 1]) / 0.1;
    }
    return r;
  };
  Eigen::VectorXd x(2 * kFrames);
  for (int t = 0; t < kFrames; ++t) x.segment<2>(2 * t) = walk.truth[t];
  Eigen::MatrixXd information;
  for (int i = 0; i < 8; ++i) {
    const Eigen::VectorXd r = residuals(x);
    Eigen::MatrixXd slope(r.size(), x.size());
    for (int k = 0; k < x.size(); ++k) {
      Eigen::VectorXd up = x, down = x;
      up[k] += 1e-5;
      down[k] -= 1e-5;
      slope.col(k) = (residuals(up) - residuals(down)) / 2e-5;
    }
    information = slope.transpose() * slope;
    x -= information.inverse() * (slope.transpose() * r);
  }
  const Eigen::MatrixXd covariance = information.inverse();
  for (int t = 0; t < kFrames; ++t) {
    const ContactEstimate& contact = estimates[t].contact[0];
    const double arc_std = std::sqrt(covariance(2 * t, 2 * t));
    const double normal_std = std::sqrt(covariance(2 * t + 1, 2 * t + 1));
    EXPECT_NEAR(contact.arc_mm, x[2 * t], 2e-3 * arc_std);
    EXPECT_NEAR(contact.normal_N, x[2 * t + 1], 2e-3 * normal_std);
    EXPECT_NEAR(contact.arc_std_mm / arc_std, 1, 1e-3);
    EXPECT_NEAR(contact.normal_std_N / normal_std, 1, 1e-3);
  }
}

TEST(SmoothingTest, AnotherLogBeginsAfresh) {
  const Walk walk(20, 0.2, 0.03, 3);
  const Scene scene = SmoothScene(0.2, 0.03);
  FrameEstimator used(PaperFinger(), scene), fresh(PaperFinger(), scene),
      going_on(PaperFinger(), scene);
  for (const Measurements& readings : walk.readings) {
    used.Next(readings);
    going_on.Next(readings);
  }
  used.Restart();
  const Measurements& first = walk.readings[0];
  const double arc_mm = fresh.Next(first).contact[0].arc_mm;
  EXPECT_NEAR(used.Next(first).contact[0].arc_mm, arc_mm, 1e-9);
  EXPECT_GT(std::abs(going_on.Next(first).contact[0].arc_mm - arc_mm), 1e-3);
}

TEST(SmoothingTest, ChangesTellWhetherTheirStdIsTrue) {
  constexpr int kFrames = 256;
  const Walk walk(kFrames, 0.8, 0.12, 4);
  // The mean of the squared changes over what is expected of them, in a batch
  // and live.
  const auto scale = [&](double tighter, bool live) {
    FrameEstimator estimator(PaperFinger(),
                             SmoothScene(0.8 / tighter, 0.12 / tighter));
    std::vector<FrameEstimate> estimates(kFrames);
    for (int i = 0; i < kFrames; i += 64) {
      if (!live) {
        estimator.EstimateBlock(&walk.readings[i], 64, &estimates[i]);
      }
    }
    double chi2 = 0, dof = 0;
    for (int i = 0; i < kFrames; ++i) {
      if (live) estimates[i] = estimator.Next(walk.readings[i]);
      chi2 += estimates[i].change_chi2;
      dof += estimates[i].change_dof;
    }
    EXPECT_GT(dof, 20);
    return chi2 / dof;
  };
  for (const bool live : {false, true}) {
    EXPECT_NEAR(scale(1, live), 1, 0.25) << live;
    EXPECT_GT(scale(4, live), 4) << live;
  }
}

TEST(SmoothingTest, HelpsAsMuchAsItsStdSays) {
  constexpr int kFrames = 256;
  const Walk walk(kFrames, 0.2, 0.03, 2);
  FrameEstimator estimator(PaperFinger(), SmoothScene(0.2, 0.03), {});
  Scene alone;
  alone.contacts = 1;
  FrameEstimator each(PaperFinger(), alone, {});
  std::vector<FrameEstimate> estimates(kFrames);
  double square = 0, single = 0, follow = 0, chi2 = 0, follow_chi2 = 0;
  for (int begin = 0; begin < kFrames; begin += 64) {
    estimator.EstimateBlock(&walk.readings[begin], 64, &estimates[begin]);
  }
  for (int t = 0; t < kFrames; ++t) {
    const auto error = [&](const FrameEstimate& e) {
      return e.contact[0].arc_mm - walk.truth[t][0];
    };
    const FrameEstimate followed = estimator.Next(walk.readings[t]);
    square += std::pow(error(estimates[t]), 2);
    single += std::pow(error(each.Estimate(walk.readings[t])), 2);
    follow += std::pow(error(followed), 2);
    chi2 +=
        std::pow(error(estimates[t]) / estimates[t].contact[0].arc_std_mm, 2);
    follow_chi2 +=
        std::pow(error(followed) / followed.contact[0].arc_std_mm, 2);
  }
  std::printf("rms error of l_c: alone %.2f, followed %.2f, smoothed %.2f mm\n",
              std::sqrt(single / kFrames), std::sqrt(follow / kFrames),
              std::sqrt(square / kFrames));
  EXPECT_LT(square, 0.5 * single);
  EXPECT_LT(square, follow);
  EXPECT_LT(follow, single);
  // Neighbours err together: a few dozen independent errors.
  EXPECT_NEAR(chi2 / kFrames, 1, 0.4);
  EXPECT_NEAR(follow_chi2 / kFrames, 1, 0.4);
}

TEST(SmoothingTest, AnUnexplainedFrameCountsForLittle) {
  Walk walk(9, 0.01, 0.01, 5);
  walk.readings[4].gauges_V[1] += 0.02;
  FrameEstimator smooth(PaperFinger(), SmoothScene(0.5, 0.1), {});
  std::vector<FrameEstimate> estimates(9);
  smooth.EstimateBlock(walk.readings.data(), 9, estimates.data());
  const FrameEstimate alone = smooth.Estimate(walk.readings[4]);
  ASSERT_GT(alone.noise_scale(), 5);
  const auto off = [&](const FrameEstimate& e) {
    return std::abs(e.contact[0].arc_mm - walk.truth[4][0]);
  };
  EXPECT_LT(off(estimates[4]), 0.3 * off(alone));
  EXPECT_LT(off(estimates[4]), 4 * estimates[4].contact[0].arc_std_mm);
  EXPECT_LT(estimates[4].contact[0].arc_std_mm,
            0.5 * alone.contact[0].arc_std_mm);
  EXPECT_EQ(estimates[4].status, FrameStatus::kOk);
}

TEST(SmoothingTest, ARunEndsWhereTheContactDoes) {
  // Two contacts far apart with free frames between them: nothing drags one
  // towards the other.
  Walk walk(12, 0.01, 0.01, 3);
  EquilibriumSolver solver(PaperFinger(), {});
  for (int t = 4; t < 12; ++t) {
    if (t < 8) {
      ASSERT_TRUE(solver.Solve({}));
    } else {
      ASSERT_TRUE(solver.Solve({{95, 4, 0}}));
    }
    for (int j = 0; j < 4; ++j) {
      walk.readings[t].gauges_V[j] = solver.gauge_angle(j);
    }
  }
  Scene scene = SmoothScene(0.05, 0.01);
  scene.contacts.reset();
  FrameEstimator estimator(PaperFinger(), scene, {});
  std::vector<FrameEstimate> estimates(12);
  estimator.EstimateBlock(walk.readings.data(), 12, estimates.data());
  for (int t = 4; t < 8; ++t) {
    EXPECT_EQ(estimates[t].status, FrameStatus::kNoContact);
  }
  for (int t = 8; t < 12; ++t) {
    EXPECT_NEAR(estimates[t].contact[0].arc_mm, 95, 1e-3);
    EXPECT_NEAR(estimates[t].contact[0].normal_N, 4, 1e-3);
  }
}

// A light touch at mid-finger reads like a heavy one near the tip, and past the
// last rib chi2 is one long valley. Neighbours are ambiguous alike there. They
// must not make each other sure of a wrong place.
TEST(SmoothingTest, NeighboursMakeNoWrongPlaceSure) {
  struct Case {
    double peak_N, change_N;
    std::optional<double> most_N;
  };
  for (const Case& c : {Case{8, 0.3, {}}, {0.7, 0.1, {}}, {0.7, 0.1, 10}}) {
    SCOPED_TRACE(testing::Message() << c.peak_N << " N, " << bool(c.most_N));
    Scene scene;
    scene.force_max_N = c.most_N;
    const auto ramps = [&] {
      return RampStudy(PaperFinger(), scene, c.peak_N, 60, {0, 140}, 1)[0];
    };
    const RampTally alone = ramps();
    scene.smoothing = {0.2, c.change_N};
    const RampTally smoothed = ramps();
    EXPECT_EQ(smoothed.beyond_6, 0) << smoothed.worst;
    EXPECT_LT(smoothed.beyond_3, 0.003 * smoothed.ok);
    EXPECT_GE(smoothed.ok, alone.ok);
  }
}

}  // namespace
}  // namespace finray

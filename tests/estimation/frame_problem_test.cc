#include "finray/estimation/frame_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "estimation/uncertain_finger.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/fit/calibration_errors.h"
#include "finray/scene/clean_readings.h"
#include "finray/statics/shape.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_V = 3e-4;

struct Range {
  double low, high;
};

// Readings with noise of contacts in a range, and of none now and then.
std::vector<Measurements> NoisyRows(const Finger& finger, int rows,
                                    Range arc_mm, Range normal_N, bool free) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> place(arc_mm.low, arc_mm.high),
      log_force(std::log10(normal_N.low), std::log10(normal_N.high));
  std::normal_distribution<double> noise(0, kNoise_V);
  EquilibriumSolver solver(finger, {});
  std::vector<Measurements> all;
  for (int i = 0; i < rows; ++i) {
    std::vector<PointContact> contacts;
    if (!free || i % 10 != 0) {
      contacts.push_back(
          {place(generator), std::pow(10, log_force(generator)), 0});
    }
    EXPECT_TRUE(solver.Solve(contacts));
    all.push_back(CleanReadings(solver));
    for (double& volts : all.back().gauges_V) volts += noise(generator);
  }
  return all;
}

// Counts the solved frames in which the two methods differ in status. `in_std`
// holds the sorted differences of l_c and f_c, in std, over the frames that are
// ok.
struct Difference {
  int other_status = 0;
  std::vector<double> in_std;

  double Quantile(double share) const {
    return in_std[static_cast<std::size_t>(
        share * static_cast<double>(in_std.size() - 1))];
  }
};

Difference Compare(const Finger& finger, const Scene& scene, FrameMethod method,
                   const std::vector<Measurements>& rows) {
  std::vector<FrameEstimate> fast(rows.size());
  FrameEstimator(finger, scene, {})
      .EstimateBlock(rows.data(), rows.size(), fast.data());
  FrameEstimator ceres(finger, scene, {}, method);
  Difference difference;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FrameEstimate other = ceres.Estimate(rows[i]);
    const bool same =
        fast[i].status == other.status && fast[i].contacts == other.contacts;
    if (!same) {
      ++difference.other_status;
      std::printf(
          "frame %zu: %s at %.3f mm, %.3f N against %s at %.3f mm, %.3f N\n", i,
          StatusName(fast[i].status), fast[i].contact[0].arc_mm,
          fast[i].contact[0].normal_N, StatusName(other.status),
          other.contact[0].arc_mm, other.contact[0].normal_N);
    }
    if (fast[i].status != other.status || other.status != FrameStatus::kOk) {
      continue;
    }
    for (int c = 0; c < other.contacts; ++c) {
      const ContactEstimate &a = fast[i].contact[c], &b = other.contact[c];
      difference.in_std.push_back(
          std::max(std::abs(a.arc_mm - b.arc_mm) / b.arc_std_mm,
                   std::abs(a.normal_N - b.normal_N) / b.normal_std_N));
      EXPECT_NEAR(a.arc_std_mm / b.arc_std_mm, 1, 5e-3) << i;
    }
  }
  std::sort(difference.in_std.begin(), difference.in_std.end());
  return difference;
}

void ExpectEqual(const char* form, const Difference& difference) {
  std::printf(
      "fast against %s: %zu contacts, 99.5 %% within %.1e std, worst "
      "%.1e std\n",
      form, difference.in_std.size(), difference.Quantile(0.995),
      difference.in_std.back());
  EXPECT_EQ(difference.other_status, 0);
  EXPECT_LT(difference.Quantile(0.995), 1e-5);
  EXPECT_LT(difference.in_std.back(), 2e-4);
}

// The fast solver is the blocks' minimum, found in less time. With the number
// of contacts left open, light touches at any height are included.
TEST(FrameProblemTest, TheFastSolverEqualsTheReducedBlocks) {
  const Finger finger = PaperFinger();
  ExpectEqual("reduced, auto",
              Compare(finger, Scene(), FrameMethod::kCeresReduced,
                      NoisyRows(finger, 3000, {5, 135}, {0.05, 8}, true)));
  Scene scene;
  scene.contacts = 1;
  ExpectEqual("reduced, one contact",
              Compare(finger, scene, FrameMethod::kCeresReduced,
                      NoisyRows(finger, 2000, {20, 110}, {0.5, 8}, false)));
}

// If another solution explains a frame about as well, the weighted form may
// miss it from a far start. It misses none in these frames.
TEST(FrameProblemTest, TheFastSolverEqualsTheWeightedBlocks) {
  const Finger finger = PaperFinger();
  Scene scene;
  scene.contacts = 1;
  ExpectEqual("weighted",
              Compare(finger, scene, FrameMethod::kCeresWeighted,
                      NoisyRows(finger, 300, {30, 100}, {1, 6}, false)));
}

// They are those of the contacts that a method finds, and these are the same.
TEST(FrameProblemTest, EveryMethodHasTheErrorsOfTheCalibration) {
  Finger finger = PaperFinger();
  finger.gauges[1].curvature_per_rad = 0.8;
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->discrepancy = TypicalDiscrepancy(4);
  Scene scene;
  scene.contacts = 1;
  FrameEstimator fast(finger, scene, {});
  FrameEstimator reduced(finger, scene, {}, FrameMethod::kCeresReduced);
  FrameEstimator weighted(finger, scene, {}, FrameMethod::kCeresWeighted);
  CalibrationErrors errors(finger, scene, {},
                           CalibrationErrors::Surface::kNone);
  EquilibriumSolver solver(finger, {});
  for (const PointContact& contact :
       {PointContact{45, 2}, PointContact{70, 4}, PointContact{95, 1}}) {
    ASSERT_TRUE(solver.Solve({contact}));
    const Measurements row = CleanReadings(solver);
    const Eigen::Matrix2d exact = errors.Of({contact}, row);
    const ContactEstimate a = fast.Estimate(row).contact[0];
    for (FrameEstimator* method : {&fast, &reduced, &weighted}) {
      const FrameEstimate estimate = method->Estimate(row);
      ASSERT_EQ(estimate.calibration_covariance.rows(), 2);
      EXPECT_LT((estimate.calibration_covariance - exact).norm(),
                2e-3 * exact.norm());
      const ContactEstimate& b = estimate.contact[0];
      EXPECT_NEAR(b.arc_std_mm, a.arc_std_mm, 2e-3 * a.arc_std_mm);
      EXPECT_NEAR(b.normal_std_N, a.normal_std_N, 2e-3 * a.normal_std_N);
      // Without friction, the whole force is the normal one.
      EXPECT_NEAR(estimate.force_std_N, b.normal_std_N, 1e-6 * b.normal_std_N);
    }
  }
}

// The smoothing is too loose to change anything but the order of the work: all
// frames of a block are judged after the last search.
TEST(FrameProblemTest, SmoothedFramesHaveTheirOwnCalibrationErrors) {
  Finger finger = PaperFinger();
  finger.calibration = TypicalCovariance(finger);
  Scene scene;
  scene.contacts = 1;
  scene.smoothing = {1000, 1000};
  EquilibriumSolver solver(finger, {});
  std::vector<Measurements> rows;
  for (const PointContact& contact :
       {PointContact{45, 2}, PointContact{70, 4}, PointContact{95, 1}}) {
    ASSERT_TRUE(solver.Solve({contact}));
    rows.push_back(CleanReadings(solver));
  }
  std::vector<FrameEstimate> fast(rows.size()), reduced(rows.size());
  FrameEstimator(finger, scene, {})
      .EstimateBlock(rows.data(), rows.size(), fast.data());
  FrameEstimator(finger, scene, {}, FrameMethod::kCeresReduced)
      .EstimateBlock(rows.data(), rows.size(), reduced.data());
  scene.smoothing.reset();
  FrameEstimator unsmoothed(finger, scene, {});
  for (std::size_t t = 0; t < rows.size(); ++t) {
    const ContactEstimate alone = unsmoothed.Estimate(rows[t]).contact[0];
    for (const auto* block : {&fast, &reduced}) {
      const ContactEstimate& of_block = (*block)[t].contact[0];
      EXPECT_NEAR(of_block.arc_std_mm, alone.arc_std_mm,
                  5e-3 * alone.arc_std_mm);
      EXPECT_NEAR(of_block.normal_std_N, alone.normal_std_N,
                  5e-3 * alone.normal_std_N);
    }
  }
}

class CameraTest : public testing::TestWithParam<FrameMethod> {
 protected:
  // Returns the measurements of a camera that looks at the solver's finger,
  // with noise.
  Measurements See(double std_mm, std::mt19937_64* generator) {
    Measurements row = CleanReadings(solver_);
    std::normal_distribution<double> noise(0, 1);
    for (double& volts : row.gauges_V) volts += kNoise_V * noise(*generator);
    const Shape shape(solver_, {contact_});
    const auto seen = [&](Side side, double arc_mm) {
      const Section at = shape.At(side, arc_mm);
      return Eigen::Vector2d(at.x_mm + std_mm * noise(*generator),
                             at.y_mm + std_mm * noise(*generator));
    };
    for (int i = 0; i < static_cast<int>(finger_.ribs.size()); ++i) {
      const Rib& rib = finger_.ribs[i];
      row.pins.push_back({i, Side::kFront, seen(Side::kFront, rib.front_mm)});
      row.pins.push_back({i, Side::kBack, seen(Side::kBack, rib.back_mm)});
    }
    row.tip_mm = seen(Side::kFront, finger_.front_length_mm);
    return row;
  }

  Finger finger_ = PaperFinger();
  PointContact contact_{72, 3};
  EquilibriumSolver solver_{finger_, {}};
};

// Pins and tip narrow the estimate, and the std says by how much.
TEST_P(CameraTest, PinsAndTipAreMeasurements) {
  constexpr double kStd_mm = 0.01;
  Scene scene;
  scene.contacts = 1;
  FrameEstimator gauges(finger_, scene, {}, GetParam());
  scene.pin_std_mm = scene.tip_std_mm = kStd_mm;
  FrameEstimator camera(finger_, scene, {}, GetParam());
  FrameEstimator weighted(finger_, scene, {}, FrameMethod::kCeresWeighted);
  ASSERT_TRUE(solver_.Solve({contact_}));
  std::mt19937_64 generator(3);
  double squares = 0;
  constexpr int kFrames = 60;
  for (int i = 0; i < kFrames; ++i) {
    const Measurements row = See(kStd_mm, &generator);
    const FrameEstimate estimate = camera.Estimate(row);
    ASSERT_EQ(estimate.status, FrameStatus::kOk);
    EXPECT_EQ(estimate.dof, 4 + 2 * 10 + 2 - 2);
    const ContactEstimate& contact = estimate.contact[0];
    EXPECT_LT(contact.arc_std_mm,
              0.8 * gauges.Estimate(row).contact[0].arc_std_mm);
    const double arc = (contact.arc_mm - contact_.arc_mm) / contact.arc_std_mm;
    const double force =
        (contact.normal_N - contact_.normal_N) / contact.normal_std_N;
    squares += arc * arc + force * force;
    const ContactEstimate other = weighted.Estimate(row).contact[0];
    EXPECT_NEAR(other.arc_mm, contact.arc_mm, 1e-3 * contact.arc_std_mm);
  }
  // Squares of 120 standard normal numbers, within 4 std.
  EXPECT_NEAR(squares / (2 * kFrames), 1, 4 * std::sqrt(2.0 / (2 * kFrames)));
}

// Frames without any gauge: a camera alone.
TEST_P(CameraTest, ACameraAlone) {
  Scene scene;
  scene.pin_std_mm = 0.05;
  FrameEstimator camera(finger_, scene, {}, GetParam());
  std::mt19937_64 generator(4);
  ASSERT_TRUE(solver_.Solve({contact_}));
  Measurements row = See(0.05, &generator);
  row.gauges_V.assign(4, std::nan(""));
  const FrameEstimate estimate = camera.Estimate(row);
  ASSERT_EQ(estimate.contacts, 1);
  const ContactEstimate& contact = estimate.contact[0];
  EXPECT_LT(std::abs(contact.arc_mm - contact_.arc_mm), 4 * contact.arc_std_mm);
  EXPECT_LT(std::abs(contact.normal_N - contact_.normal_N),
            4 * contact.normal_std_N);
  ASSERT_TRUE(solver_.Solve({}));
  Measurements free = See(0.05, &generator);
  free.gauges_V = row.gauges_V;
  EXPECT_EQ(camera.Estimate(free).status, FrameStatus::kNoContact);
}

// The starts of two contacts have no gauge to go by.
TEST_P(CameraTest, ACameraAloneSeesTwoContacts) {
  Scene scene;
  scene.contacts = 2;
  scene.pin_std_mm = 0.01;
  FrameEstimator camera(finger_, scene, {}, GetParam());
  const std::vector<PointContact> contacts = {{35, 3}, {95, 2}};
  ASSERT_TRUE(solver_.Solve(contacts));
  Measurements row = CleanReadings(solver_);
  const Shape shape(solver_, contacts);
  for (int i = 0; i < static_cast<int>(finger_.ribs.size()); ++i) {
    const Section front = shape.At(Side::kFront, finger_.ribs[i].front_mm);
    const Section back = shape.At(Side::kBack, finger_.ribs[i].back_mm);
    row.pins.push_back({i, Side::kFront, {front.x_mm, front.y_mm}});
    row.pins.push_back({i, Side::kBack, {back.x_mm, back.y_mm}});
  }
  row.gauges_V.assign(4, std::nan(""));
  const FrameEstimate estimate = camera.Estimate(row);
  ASSERT_EQ(estimate.contacts, 2);
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(estimate.contact[c].arc_mm, contacts[c].arc_mm, 1e-3);
    EXPECT_NEAR(estimate.contact[c].normal_N, contacts[c].normal_N, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, CameraTest,
                         testing::Values(FrameMethod::kFast,
                                         FrameMethod::kCeresReduced),
                         [](const auto& info) {
                           return info.param == FrameMethod::kFast ? "default"
                                                                   : "ceres";
                         });

}  // namespace
}  // namespace finray

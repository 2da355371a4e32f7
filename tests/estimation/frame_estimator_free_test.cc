// When a frame is no_contact, and when its readings are none.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "estimation/uncertain_finger.h"
#include "finray/estimation/chi_squared.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/log_estimator.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Scene WithContactsOf(std::optional<int> contacts) {
  Scene scene;
  scene.contacts = contacts;
  return scene;
}

std::vector<Measurements> PressedRows(const Finger& finger) {
  std::mt19937_64 generator(11);
  EquilibriumSolver solver(finger, {});
  std::vector<Measurements> rows;
  for (const double arc : {30.0, 50.0, 75.0, 100.0}) {
    for (const double force : {0.5, 1.0, 2.0, 5.0}) {
      EXPECT_TRUE(solver.Solve({{arc, force, 0}}));
      rows.push_back(WithNoise(CleanReadings(solver), finger, &generator));
      rows.back().time_s = static_cast<double>(rows.size());
    }
  }
  return rows;
}

// The estimates of a log by every way to estimate it.
void ForEachWay(const Finger& finger, const Scene& scene,
                const std::vector<Measurements>& rows,
                const std::function<void(const char* way, std::size_t row,
                                         const FrameEstimate&)>& check) {
  const std::size_t count = rows.size();
  for (const FrameMethod method :
       {FrameMethod::kFast, FrameMethod::kCeresReduced}) {
    FrameEstimator estimator(finger, scene, {}, method);
    const char* name = FrameMethodName(method);
    const std::size_t tried = method == FrameMethod::kFast ? count : 4;
    for (std::size_t i = 0; i < tried; ++i) {
      check(name, i, estimator.Estimate(rows[i]));
    }
    if (method != FrameMethod::kFast) continue;
    for (std::size_t i = 0; i < count; ++i) {
      check("live", i, estimator.Next(rows[i]));
    }
    std::vector<FrameEstimate> block(count);
    estimator.EstimateBlock(rows.data(), count, block.data());
    for (std::size_t i = 0; i < count; ++i) check("block", i, block[i]);
  }
  std::size_t next = 0;
  LogEstimator joint(finger, scene, {}, 1, [&](const FrameEstimate& estimate) {
    check("joint", next++, estimate);
  });
  for (const Measurements& row : rows) joint.Add(row);
  joint.Finish();
  EXPECT_EQ(next, count);
}

TEST(FrameEstimatorFreeTest, WhatNothingExplainsIsNotFree) {
  const Finger finger = PaperFinger();
  const std::function<double(double)> faults[] = {
      [](double) { return -3.3; }, [](double volts) { return -volts; },
      [](double volts) { return 1e3 * volts; },
      [](double volts) { return -0.02 - 0 * volts; }};
  int impossible = 0, unexplained = 0;
  for (const auto& fault : faults) {
    std::vector<Measurements> rows = PressedRows(finger);
    for (Measurements& row : rows) {
      for (double& volts : row.gauges_V) volts = fault(volts);
    }
    for (const std::optional<int> contacts :
         {std::optional<int>(), std::optional<int>(1), std::optional<int>(0)}) {
      ForEachWay(
          finger, WithContactsOf(contacts), rows,
          [&](const char* way, std::size_t row, const FrameEstimate& estimate) {
            EXPECT_NE(estimate.status, FrameStatus::kNoContact)
                << way << " " << row << " chi2 " << estimate.chi2;
            if (estimate.contacts > 0) return;
            EXPECT_TRUE(std::isnan(estimate.contact[0].normal_N));
            EXPECT_TRUE(std::isnan(EstimatedForce(estimate, 0)));
            impossible += estimate.status == FrameStatus::kBadInput;
            unexplained += estimate.status == FrameStatus::kUnobservable;
            EXPECT_EQ(estimate.rib_tension_N.size(), finger.ribs.size());
          });
    }
  }
  std::printf("%d frames unobservable without a contact, %d bad_input\n",
              unexplained, impossible);
  EXPECT_GT(unexplained, 300);
  EXPECT_GT(impossible, 50);
}

// The p-value of a frame that is no_contact is never below 0.001, and clean
// free frames stay so: of 20 000, 15 to 22 are not for the p-value alone.
TEST(FrameEstimatorFreeTest, CleanFramesAreFree) {
  Finger finger = PaperFinger();
  for (const int gauges : {4, 8}) {
    if (gauges == 8) {
      for (int j = 0; j < 4; ++j) {
        finger.gauges.push_back(finger.gauges[static_cast<std::size_t>(j)]);
        finger.gauges.back().beam = Side::kFront;
      }
    }
    FrameEstimator estimator(finger, {}, {});
    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.Solve({}));
    const Measurements clean = CleanReadings(solver);
    std::mt19937_64 generator(3);
    constexpr int kFrames = 20000;
    int free = 0, doubtful = 0;
    for (int i = 0; i < kFrames; ++i) {
      const FrameEstimate estimate =
          estimator.Estimate(WithNoise(clean, finger, &generator));
      free += estimate.status == FrameStatus::kNoContact;
      if (estimate.status == FrameStatus::kNoContact) {
        EXPECT_GE(estimate.p_value(), FrameEstimate::kUnexplained);
      }
      doubtful += estimate.status == FrameStatus::kUnobservable &&
                  estimate.contacts == 0;
    }
    std::printf(
        "%d gauges: %d of %d clean free frames no_contact, %d "
        "unexplained\n",
        gauges, free, kFrames, doubtful);
    EXPECT_GT(free, 0.99 * kFrames);
    EXPECT_LT(doubtful, 0.0015 * kFrames);
  }
}

// Offsets that are off as the calibration says move all free frames alike.
TEST(FrameEstimatorFreeTest, CalibrationsMayBeOff) {
  Finger finger = PaperFinger();
  finger.calibration = TypicalCovariance(finger);
  const auto& parameters = finger.calibration->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].kind != FingerParameterKind::kGaugeOffset) continue;
    finger.calibration->std[static_cast<Eigen::Index>(k)] = 9e-4;
  }
  const Eigen::MatrixXd factor = finger.calibration->Factor();
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  int free = 0, unobservable = 0, by_noise_alone = 0;
  constexpr int kDraws = 30, kFrames = 10;
  FrameEstimator estimator(finger, {}, {});
  for (int draw = 0; draw < kDraws; ++draw) {
    Finger real = finger;
    const Eigen::VectorXd off =
        factor * Eigen::VectorXd::NullaryExpr(
                     factor.cols(), [&] { return normal(generator); });
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      SetParameter(parameters[k],
                   ParameterValue(finger, parameters[k]) +
                       off[static_cast<Eigen::Index>(k)],
                   &real);
    }
    EquilibriumSolver solver(real, {});
    ASSERT_TRUE(solver.Solve({}));
    const Measurements clean = CleanReadings(solver);
    for (int i = 0; i < kFrames; ++i) {
      const FrameEstimate estimate =
          estimator.Estimate(WithNoise(clean, finger, &generator));
      free += estimate.status == FrameStatus::kNoContact;
      unobservable += estimate.status == FrameStatus::kUnobservable &&
                      estimate.contacts == 0;
      by_noise_alone +=
          estimate.contacts == 0 &&
          ChiSquaredTail(estimate.chi2, 4) < FrameEstimate::kUnexplained;
    }
  }
  std::printf(
      "%d of %d free frames of %d calibrations no_contact, %d "
      "unobservable; noise alone explains all but %d\n",
      free, kDraws * kFrames, kDraws, unobservable, by_noise_alone);
  EXPECT_GT(by_noise_alone, 25);
  EXPECT_LT(unobservable, 0.02 * kDraws * kFrames);
}

TEST(FrameEstimatorFreeTest, ReadingsThatNoGaugeGivesAreBadInput) {
  const Finger finger = PaperFinger();
  const std::vector<Measurements> rows = PressedRows(finger);
  for (const double reading :
       {kInfinity, -kInfinity, 9.9e37, -1e7, 50.0, -10.0}) {
    std::vector<Measurements> faulty = rows;
    for (std::size_t i = 0; i < rows.size(); i += 5) {
      faulty[i].gauges_V[i % 4] = reading;
    }
    std::vector<FrameStatus> before;
    FrameEstimator estimator(finger, {}, {});
    for (const Measurements& row : rows) {
      before.push_back(estimator.Estimate(row).status);
    }
    ForEachWay(
        finger, {}, faulty,
        [&](const char* way, std::size_t row, const FrameEstimate& estimate) {
          const FrameStatus expected =
              row % 5 == 0 ? FrameStatus::kBadInput : before[row];
          EXPECT_EQ(estimate.status, expected)
              << reading << " " << way << " " << row;
        });
  }
  // A missing and a saturated reading are only left out.
  Measurements row = rows[9];
  row.gauges_V[1] = std::nan("");
  EXPECT_EQ(FrameEstimator(finger, {}, {}).Estimate(row).status,
            FrameStatus::kOk);
  Finger narrow = finger;
  narrow.gauges[1].min_V = -10;
  row.gauges_V[1] = -10;
  EXPECT_EQ(FrameEstimator(narrow, {}, {}).Estimate(row).status,
            FrameStatus::kOk);
}

}  // namespace
}  // namespace finray

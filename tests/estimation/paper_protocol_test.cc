// The paper's experiments, simulated: the claims of docs/evidence/accuracy.md
// on fewer frames.

#include "studies/paper_protocol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace finray {
namespace {

TEST(PaperProtocolTest, GridOfCirclesWithCalibratedFingers) {
  const SimulatedLab lab;
  const auto frames =
      lab.Press({30, 45, 60, 75, 90, 105}, {1.5, 2.5, 3.5, 4.5});
  ASSERT_EQ(frames.size(), 24u);
  Scene one;
  one.contacts = 1;
  std::vector<ProtocolError> all, exact;
  for (const unsigned seed : {1u, 2u}) {
    const Finger calibrated = lab.Calibrated(seed, 2);
    FrameEstimator estimator(calibrated, one, {});
    std::mt19937_64 generator(seed);
    for (int repeat = 0; repeat < 20; ++repeat) {
      const auto errors =
          ProtocolErrors(frames, &lab.finger(), &estimator, &generator);
      all.insert(all.end(), errors.begin(), errors.end());
    }
    // Without noise, only the calibration's error remains.
    const auto errors = ProtocolErrors(frames, nullptr, &estimator, &generator);
    exact.insert(exact.end(), errors.begin(), errors.end());
  }
  // The paper's means over its grid.
  EXPECT_LT(MeanOf(all, &ProtocolError::place_mm), 0.58);
  EXPECT_LT(MeanOf(all, &ProtocolError::angle_deg), 1.24);
  EXPECT_LT(MeanOf(all, &ProtocolError::force_N), 0.15);
  EXPECT_LT(MeanOf(exact, &ProtocolError::place_mm), 0.15);
  EXPECT_GT(MeanOf(exact, &ProtocolError::place_mm), 0.01);
  EXPECT_LT(MeanOf(exact, &ProtocolError::force_N), 0.015);
}

// Pressed and let go four times in a minute, 0 to 8 N, 30 frames a second.
TEST(PaperProtocolTest, CyclesOfContactAndSeparation) {
  constexpr double kGaps_s[] = {0.26, 0.77, 0.14, 1.0};
  constexpr double kPress_s = (60 - 2 - 1.17) / 4;
  const SimulatedLab lab;
  FrameEstimator estimator(lab.finger(), Scene(), {});
  EquilibriumSolver solver(lab.finger(), {});
  std::mt19937_64 generator(3);
  double squares = 0, largest = 0;
  int used = 0, unused = 0, unused_heavy = 0, free = 0, false_contacts = 0;
  for (int i = 0; i < 1800; ++i) {
    double start = 1, force = 0;
    for (const double gap : kGaps_s) {
      const double share = (i / 30.0 - start) / kPress_s;
      if (share > 0 && share < 1) {
        force = 8 * std::pow(std::sin(M_PI * share), 2);
      }
      start += kPress_s + gap;
    }
    std::vector<PointContact> contacts;
    if (force > 0) contacts.push_back({70, force, 0});
    ASSERT_TRUE(solver.Solve(contacts));
    const FrameEstimate estimate = estimator.Estimate(
        WithNoise(CleanReadings(solver), lab.finger(), &generator));
    free += force == 0;
    false_contacts += force == 0 && estimate.status != FrameStatus::kNoContact;
    if (estimate.status != FrameStatus::kOk &&
        estimate.status != FrameStatus::kNoContact) {
      ++unused;
      unused_heavy += force > 1;
      continue;
    }
    double found = 0;
    for (int c = 0; c < estimate.contacts; ++c) {
      found += estimate.contact[c].normal_N;
    }
    ++used;
    squares += std::pow(found - force, 2);
    largest = std::max(largest, std::abs(found - force));
  }
  // The paper's errors, against its force sensor.
  EXPECT_LT(std::sqrt(squares / used), 0.18);
  EXPECT_LT(largest, 0.61);
  // The limit that gauges of 3e-4 rad allow at 70 mm.
  EXPECT_LT(std::sqrt(squares / used), 0.03);
  EXPECT_GT(free, 90);
  EXPECT_EQ(false_contacts, 0);
  // Light touches, and frames in which noise looks like a second contact.
  EXPECT_LT(unused, 0.05 * 1800);
  EXPECT_LE(unused_heavy, 6);
}

}  // namespace
}  // namespace finray

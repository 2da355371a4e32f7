#include "finray/batch/estimation_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/yaml_emitter.h"
#include "finray/io/yaml_map.h"
#include "test_finger.h"

namespace finray {
namespace {

TEST(EstimationSummaryTest, ReadsBackTheSame) {
  const Finger finger = PaperFinger();
  EstimationSummary summary;
  FrameEstimate estimate;
  Measurements readings;
  for (int i = 0; i < 100; ++i) {
    estimate.status = EstimationSummary::kStatuses[i % 5];
    estimate.contact[0].normal_N = 0.1 * i;
    estimate.dof = 2;
    estimate.chi2 = i;  // p = exp(-chi2 / 2) < 0.001 from 13.8 on
    estimate.contacts = 1;
    estimate.contact[0].normal_std_N = 0.01 * i;
    estimate.search_ended = i % 10 == 0;
    readings.gauges_V = {0.1 * i, 1};
    readings.force_N = i % 7 ? 0.05 * i : std::nan("");
    summary.Add(estimate, 0.3, readings, finger);
  }
  const auto back = SummaryFromText(SummaryToText(summary));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->frames, 100u);
  EXPECT_EQ(back->by_status, summary.by_status);
  // Three of five statuses are solved.
  EXPECT_EQ(summary.unexplained, 17u * 3);
  EXPECT_EQ(back->unexplained, summary.unexplained);
  EXPECT_EQ(summary.search_ended, 10u);
  EXPECT_EQ(back->search_ended, 10u);
  EXPECT_EQ(back->force_compared, summary.force_compared);
  EXPECT_EQ(back->force_squares_N2, summary.force_squares_N2);
  EXPECT_EQ(back->force_max_N, summary.force_max_N);
  EXPECT_GT(summary.force_judged, 10u);
  EXPECT_EQ(back->force_judged, summary.force_judged);
  EXPECT_EQ(back->force_far, summary.force_far);
  EXPECT_EQ(back->force_variances_N2, summary.force_variances_N2);
  EXPECT_EQ(summary.free_rows, 1u);  // i = 1
  EXPECT_EQ(back->free_rows, 1u);
  EXPECT_EQ(back->free_sums_V, (std::vector<double>{0.1, 1}));
  EXPECT_FALSE(SummaryFromText(""));
  EXPECT_FALSE(SummaryFromText("1 2 3"));
  EXPECT_FALSE(SummaryFromText(SummaryToText(summary) + " 1"));
}

// A log that is resumed after its end gets the warning that it had.
// From a chi2 of 70 on, one contact on four gauges may be two.
TEST(EstimationSummaryTest, WhatMayBeTwoContactsIsNotUnexplained) {
  FrameEstimate estimate;
  estimate.status = FrameStatus::kUnobservable;
  estimate.contacts = 1;
  estimate.dof = 2;
  estimate.may_be_two = true;
  Measurements readings;
  readings.gauges_V = {0, 0, 0, 0};
  EstimationSummary summary;
  for (const double chi2 : {40.0, 69.0, 71.0, 500.0}) {
    estimate.chi2 = chi2;
    summary.Add(estimate, 0, readings, PaperFinger());
  }
  EXPECT_EQ(summary.unexplained, 2u);
}

TEST(EstimationSummaryTest, ReadsBackTheWalk) {
  EstimationSummary summary;
  summary.walk.told_V_per_sqrt_s = 1e-3;
  for (std::size_t i = 0; i < WalkIncrements::kLags; ++i) {
    summary.walk.chi2[i] = 1000 + 10.0 * i;
    summary.walk.dof[i] = 110;
    summary.walk.weights[i] = 100;
    summary.walk.weighted[i] = 900;
  }
  summary.walk.moved_V = {0.25, -0.5};
  summary.walk.moved_s = 60;
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  EmitChanges(summary, &yaml);
  yaml << YAML::EndMap;
  EstimationSummary back;
  ReadChanges(YamlMap::FromText(yaml.c_str(), "summary"), &back);
  EXPECT_EQ(back.walk.Judge(), WalkIncrements::Verdict::kTooSmall);
  EXPECT_NEAR(back.walk.FittingWalk(), 3e-3, 1e-12);
  EXPECT_EQ(back.walk.moved_V, summary.walk.moved_V);
}

TEST(EstimationSummaryTest, AWideWalkIsSaidWhereFramesAreSolvedTogether) {
  EstimationSummary summary;
  summary.frames = 1000;
  summary.walk.told_V_per_sqrt_s = 1e-3;
  for (std::size_t i = 0; i < WalkIncrements::kLags; ++i) {
    summary.walk.chi2[i] = 5;
    summary.walk.dof[i] = 110;
  }
  ASSERT_EQ(summary.walk.Judge(), WalkIncrements::Verdict::kTooLarge);
  EXPECT_TRUE(summary.offsets_move_otherwise());
  summary.alone = 900;
  EXPECT_FALSE(summary.offsets_move_otherwise());
}

// A force sensor of two axes says of the estimates what one of its magnitude
// says.
TEST(EstimationSummaryTest, TwoAxesCountLikeTheirMagnitude) {
  const Finger finger = PaperFinger();
  EstimationSummary of_magnitude, of_axes;
  FrameEstimate estimate;
  estimate.status = FrameStatus::kOk;
  estimate.contacts = 1;
  estimate.contact[0].normal_std_N = 0.02;
  Measurements magnitude, axes;
  magnitude.gauges_V = axes.gauges_V = {0.1, 0.2};
  for (const double force : {0.03, 0.065, 1.0, 5.0}) {
    estimate.contact[0].normal_N = 0.8 * force;
    magnitude.force_N = force;
    axes.force_xy_N = {0.6 * force, -0.8 * force};
    of_magnitude.Add(estimate, 0, magnitude, finger);
    of_axes.Add(estimate, 0, axes, finger);
  }
  EXPECT_EQ(of_axes.force_judged, 4u);
  EXPECT_EQ(of_axes.force_far, 2u);
  EXPECT_EQ(of_axes.free_rows, 1u);
  EXPECT_NEAR(of_axes.force_rms_N(), of_magnitude.force_rms_N(), 1e-12);
  EXPECT_EQ(of_axes.force_far, of_magnitude.force_far);
  EXPECT_EQ(of_axes.free_rows, of_magnitude.free_rows);
}

TEST(EstimationSummaryTest, KeepsTheFirstReadingThatNoGaugeGives) {
  const Finger finger = PaperFinger();
  FrameEstimate bad;
  bad.status = FrameStatus::kBadInput;
  Measurements too_few, high, infinite;
  too_few.gauges_V = {0.1, std::nan(""), std::nan(""), std::nan("")};
  high.gauges_V = {0.1, std::nan(""), 9.9e37, 1e9};
  infinite.gauges_V = {-1 / 0.0, 0, 0, 0};
  EstimationSummary summary, first, second;
  first.Add(bad, 0, too_few, finger);
  EXPECT_FALSE(first.any_impossible());
  second.Add(bad, 0, too_few, finger);
  second.Add(bad, 0, high, finger);
  second.Add(bad, 0, infinite, finger);
  summary.Add(first);
  summary.Add(second);
  summary = *SummaryFromText(SummaryToText(summary));
  EXPECT_EQ(summary.count(FrameStatus::kBadInput), 4u);
  EXPECT_EQ(summary.impossible, 2u);
  EXPECT_EQ(summary.impossible_row, 3u);
  EXPECT_EQ(summary.impossible_gauge, 3u);
  EXPECT_EQ(summary.impossible_V, "9.9e+37");

  EstimationSummary other;
  other.Add(bad, 0, infinite, finger);
  other = *SummaryFromText(SummaryToText(other));
  EXPECT_EQ(other.impossible_V, "-inf");
}

TEST(EstimationSummaryTest, TooManyUnexplainedFramesAreNoChance) {
  EstimationSummary summary;
  summary.frames = 10;
  summary.unexplained = 2;
  EXPECT_FALSE(summary.unexplained_too_many());
  summary.unexplained = 3;
  EXPECT_TRUE(summary.unexplained_too_many());
  summary.frames = 60;
  EXPECT_FALSE(summary.unexplained_too_many());
  // Frames without a solution do not dilute the share.
  summary.by_status[static_cast<int>(FrameStatus::kBadInput)] = 1;
  EXPECT_TRUE(summary.unexplained_too_many());
}

}  // namespace
}  // namespace finray

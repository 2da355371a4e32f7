#include "finray/calib/analysis/error_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

FrameEstimate Estimate(FrameStatus status, double arc, double arc_std,
                       double force, double force_std) {
  FrameEstimate estimate;
  estimate.status = status;
  estimate.contacts = status == FrameStatus::kNoContact ? 0 : 1;
  estimate.contact[0].arc_mm = arc;
  estimate.contact[0].arc_std_mm = arc_std;
  estimate.contact[0].normal_N = force;
  estimate.contact[0].normal_std_N = force_std;
  return estimate;
}

TEST(ErrorTableTest, ByHand) {
  ErrorTable table;
  table.front_length_mm = 100;
  const FrameReference at30 = {true, 4, 0.3, 30, 0};
  const FrameReference at90 = {true, 3, 0, 90, 0};
  const auto add = [&](const FrameReference& reference,
                       const FrameEstimate& estimate) {
    table.Add(reference, estimate, reference.contact_mm, 0);
  };
  // Errors of 0.5 N at a std of sqrt(0.3^2 + 0.4^2), of 1 mm at 0.5.
  add(at30, Estimate(FrameStatus::kOk, 31, 0.5, 4.5, 0.4));
  // 1 N at 0.6, 3 mm at 4.
  add(at90, Estimate(FrameStatus::kOk, 87, 4, 2, 0.6));
  add(at90, Estimate(FrameStatus::kUnobservable, 20, 9, 50, 9));
  add(at90, Estimate(FrameStatus::kNoContact, NAN, NAN, 0, NAN));
  add({false, 0.01, 0.02, NAN, 0},
      Estimate(FrameStatus::kOk, 50, 1, 0.06, 0.01));

  EXPECT_EQ(table.contact.frames, 4u);
  EXPECT_EQ(table.contact.usable, 3u);
  EXPECT_EQ(table.contact.usable_percent(), 75);
  EXPECT_EQ(table.contact.missed, 1u);
  EXPECT_EQ(table.free.untrue, 1u);
  const ErrorStatistics& force = table.contact.force_N;
  EXPECT_EQ(force.frames, 3u);
  EXPECT_DOUBLE_EQ(force.rms(), std::sqrt((0.25 + 1 + 9) / 3));
  EXPECT_DOUBLE_EQ(force.percent(),
                   100 * std::sqrt((0.25 + 1 + 9) / (16 + 9 + 9)));
  EXPECT_DOUBLE_EQ(force.bias(), (0.5 - 1 - 3) / 3);
  EXPECT_EQ(force.largest, 3);
  // The missed one is outside.
  EXPECT_EQ(force.judged, 3u);
  EXPECT_DOUBLE_EQ(force.coverage_68_percent(), 100. / 3);
  EXPECT_DOUBLE_EQ(force.coverage_95_percent(), 200. / 3);
  const ErrorStatistics& contact = table.contact.contact_mm;
  EXPECT_DOUBLE_EQ(contact.rms(), std::sqrt(5));
  EXPECT_DOUBLE_EQ(contact.coverage_68_percent(), 100. / 3);
  EXPECT_DOUBLE_EQ(contact.coverage_95_percent(), 100. / 3);
  EXPECT_EQ(table.regions[1].frames, 1u);
  EXPECT_EQ(table.regions[4].frames, 3u);
  EXPECT_EQ(table.RegionOf(100), 4);
  EXPECT_EQ(table.RegionOf(NAN), -1);
}

// Also where nothing but misses is known, and only of what has a reference.
TEST(ErrorTableTest, MissesAloneAreNotCovered) {
  ErrorTable table;
  table.front_length_mm = 100;
  table.Add({true, 5, 0, NAN, 0},
            Estimate(FrameStatus::kNoContact, NAN, NAN, 0, NAN), NAN, 0);
  EXPECT_EQ(table.contact.force_N.coverage_95_percent(), 0);
  EXPECT_EQ(table.contact.contact_mm.judged, 0u);
}

TEST(ErrorTableTest, FrictionIsPartOfTheForce) {
  ErrorTable table;
  table.front_length_mm = 100;
  table.Add({true, 5, 0, 50, 0}, Estimate(FrameStatus::kOk, 50, 1, 4, 1), 50,
            0.75);
  EXPECT_DOUBLE_EQ(table.contact.force_N.largest, 0);
}

}  // namespace
}  // namespace finray

#include "finray/calib/solve/contact_guess.h"

#include <gtest/gtest.h>

#include "calib/standard_log.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr double kCircle_mm = 15;

// A log of the finger that the guesses know.
class ContactGuessTest : public testing::TestWithParam<bool> {
 protected:
  ContactGuessTest()
      : plan_(StandardPlan()),
        problem_(HiddenFinger(), plan_,
                 ReadCalibrationLogs({StandardLog(folder_, HiddenFinger(), 11)},
                                     HiddenFinger(), plan_),
                 {}, 1),
        guess_(&problem_, GetParam()),
        solver_(HiddenFinger(), {}) {}

  // How far the circle that touches there is from where the stage has it.
  double Gap_mm(const ContactGuess::Place& place,
                const CalibrationFrame& frame) {
    EXPECT_TRUE(solver_.Solve({{place.arc_mm, place.normal_N}}));
    return (CircleCentre(solver_.contact_pose(0), kCircle_mm) - frame.object_mm)
        .norm();
  }

  TempFolder folder_;
  Plan plan_;
  CalibrationProblem problem_;
  ContactGuess guess_;
  EquilibriumSolver solver_;
};

TEST_P(ContactGuessTest, TheFingerMeetsTheCircle) {
  int guessed = 0;
  for (CalibrationFrame frame : problem_.logs().frames) {
    if (!frame.contact) continue;
    frame.force_N = CalibrationFrame::kNotMeasured;
    const auto place = guess_.Of(frame, ContactGuess::From::kObjectFirst);
    EXPECT_TRUE(place.met) << frame.row;
    EXPECT_LT(Gap_mm(place, frame), 0.01) << frame.row;
    ++guessed;
  }
  EXPECT_GE(guessed, 150);
}

// A force that the log measures is taken as it is, and gauges beside the place
// of the object move the contact by no more than their noise.
TEST_P(ContactGuessTest, ForceAndGaugesCount) {
  for (const CalibrationFrame& frame : problem_.logs().frames) {
    if (!frame.contact || frame.row % 10 != 0) continue;
    const auto measured = guess_.Of(frame, ContactGuess::From::kObjectFirst);
    EXPECT_EQ(measured.normal_N, std::max(0.0, frame.force_N));
    const auto all = guess_.Of(frame, ContactGuess::From::kAll);
    EXPECT_TRUE(all.met);
    EXPECT_LT(Gap_mm(all, frame), 6 * plan_.object_std_mm);
  }
}

// Neither a circle behind the finger's reach nor one far away is met, and no
// force is larger than the table's.
TEST_P(ContactGuessTest, ACircleOutOfReachIsNotMet) {
  const ContactGuess copy(guess_);
  for (const double away_mm : {-40.0, 60.0}) {
    CalibrationFrame frame = problem_.logs().frames[1];
    ASSERT_TRUE(frame.contact);
    frame.force_N = CalibrationFrame::kNotMeasured;
    frame.object_mm.x() += away_mm;
    ContactGuess own(copy);
    const auto place = own.Of(frame, ContactGuess::From::kObjectFirst);
    EXPECT_FALSE(place.met) << away_mm;
    EXPECT_LE(place.normal_N, guess_.table().heaviest_N()) << away_mm;
  }
}

INSTANTIATE_TEST_SUITE_P(FewAndMany, ContactGuessTest, testing::Bool(),
                         [](const auto& info) {
                           return info.param ? "surface" : "equilibria";
                         });

}  // namespace
}  // namespace finray

#include "finray/estimation/found_solutions.h"

#include <gtest/gtest.h>

#include "test_finger.h"

namespace finray {
namespace {

// Two contacts known to 0.1 mm and 0.1 N.
void FillIn(double first_mm, double second_mm, double chi2,
            FoundSolutions* found) {
  ContactSolution& next = found->next();
  next.count = 2;
  next.contacts = {PointContact{first_mm, 2, 0}, PointContact{second_mm, 3, 0}};
  next.information = ContactMatrix::Identity(4, 4) * 100;
  next.chi2 = chi2;
  found->Keep();
}

TEST(FoundSolutionsTest, OfTwoFitsOfOneMinimumTheBetterOneStays) {
  FoundSolutions found(PaperFinger(), 25);
  FillIn(40, 90, 5, &found);
  FillIn(60, 100, 5.005, &found);
  // 0.05 std from the second one, and best after all.
  FillIn(60.005, 100, 4.996, &found);
  EXPECT_EQ(found.end() - found.begin(), 2);
  EXPECT_EQ(found.best().contacts[0].arc_mm, 60.005);
  ASSERT_NE(found.rival(), nullptr);
  EXPECT_EQ(found.rival()->contacts[0].arc_mm, 40);
  // A worse fit of it changes nothing.
  FillIn(60.004, 100, 5, &found);
  EXPECT_EQ(found.end() - found.begin(), 2);
  EXPECT_EQ(found.least_chi2(), 4.996);
}

TEST(FoundSolutionsTest, ContactsAreSortedBeforeTheyAreCompared) {
  FoundSolutions found(PaperFinger(), 25);
  FillIn(40, 90, 5, &found);
  ContactSolution& next = found.next();
  next = found.best();
  std::swap(next.contacts[0], next.contacts[1]);
  found.Keep();
  EXPECT_EQ(found.end() - found.begin(), 1);
}

}  // namespace
}  // namespace finray

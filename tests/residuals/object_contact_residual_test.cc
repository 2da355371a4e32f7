#include "finray/residuals/object_contact_residual.h"

#include <cmath>

#include "finray/objects/object_contact.h"
#include "residuals_fixture.h"

namespace finray {
namespace {

class ObjectContactResidualTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, ObjectContactResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(ObjectContactResidualTest, AnalyticalVersusFiniteDifferences) {
  double origin[2] = {0.3, -0.2};
  std::vector<double*> blocks = Blocks();
  blocks.push_back(origin);
  const std::unique_ptr<ceres::CostFunction> cost(
      new ObjectContactResidual(frame_, 0, {-11.5, 66}, 15, 0.05));
  CheckDerivatives(*cost, blocks, 1e-6);
  const std::unique_ptr<ceres::CostFunction> location(
      new ContactLocationResidual(frame_, 0, 66, 0.3));
  CheckDerivatives(*location, {unknowns_.data()}, 1e-7);
}

// Only the reduced form is in equilibrium without a solve.
class ObjectContactEquilibriumTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, ObjectContactEquilibriumTest,
                         testing::Values(EquilibriumForm::kReduced), FormName);

TEST_P(ObjectContactEquilibriumTest, VanishesWhereTheCircleTouches) {
  EquilibriumSolver solver(finger_, {});
  const ObjectContact found = SolveObjectContact(
      {Outline(CircleOutline{15}), {}}, {{-12, 66}}, kFriction, &solver);
  ASSERT_EQ(found.status, ObjectContactStatus::kContact);
  const PointContact& contact = found.contacts.front();
  unknowns_ = {contact.arc_mm, contact.normal_N};
  FrameSet frames(finger_, {}, GetParam(), &shared_, 1);
  FrameEvaluation& frame = frames.Add(1, kFriction, unknowns_.data());
  frames.PrepareForEvaluation(true, true);
  double origin[2] = {0, 0}, residuals[2];
  std::vector<double*> blocks = Blocks();
  blocks.push_back(origin);
  const std::unique_ptr<ceres::CostFunction> cost(
      new ObjectContactResidual(&frame, 0, {-12, 66}, 15, 1));
  ASSERT_TRUE(cost->Evaluate(blocks.data(), residuals, nullptr));
  EXPECT_LT(std::hypot(residuals[0], residuals[1]), 1e-9);
}

}  // namespace
}  // namespace finray

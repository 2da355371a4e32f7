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
  double rotation_deg = 1.5, ln_scale = 0.02, radius_mm = 14.8;
  std::vector<double*> blocks = Blocks();
  for (double* own : {origin, &rotation_deg, &ln_scale, &radius_mm}) {
    blocks.push_back(own);
  }
  const Eigen::Vector2d centre(-11.5, 66);
  const std::unique_ptr<ceres::CostFunction> cost(
      new ObjectContactResidual(frame_, 0, &centre, 0.05));
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
  // The stage counts from (2, 3) and is turned by 90 degrees.
  double origin[2] = {2, 3}, rotation_deg = 90, ln_scale = 0, radius_mm = 15;
  double residuals[2];
  std::vector<double*> blocks = Blocks();
  for (double* own : {origin, &rotation_deg, &ln_scale, &radius_mm}) {
    blocks.push_back(own);
  }
  const Eigen::Vector2d centre(63, 14);
  const std::unique_ptr<ceres::CostFunction> cost(
      new ObjectContactResidual(&frame, 0, &centre, 1));
  ASSERT_TRUE(cost->Evaluate(blocks.data(), residuals, nullptr));
  EXPECT_LT(std::hypot(residuals[0], residuals[1]), 1e-9);
  radius_mm = -1;
  EXPECT_FALSE(cost->Evaluate(blocks.data(), residuals, nullptr));
}

}  // namespace
}  // namespace finray

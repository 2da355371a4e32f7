#include "finray/fit/linearized_frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace finray {
namespace {

TEST(PseudoInverseTest, OfFullAndOfLowRank) {
  Eigen::Matrix2d a;
  a << 4, 1, 1, 3;
  EXPECT_LT((PseudoInverse(a) - a.inverse()).norm(), 1e-14);
  EXPECT_TRUE(PseudoInverse(Eigen::Matrix2d::Zero()).isZero(0));
  const Eigen::Vector2d v(3, -2);
  const Eigen::Matrix2d one = v * v.transpose();
  EXPECT_LT((PseudoInverse(one) - one / (13.0 * 13)).norm(), 1e-12);
}

// What is left of the parameters is orthogonal to the contact, and the move
// leaves the least squares.
TEST(LinearizedFrameTest, EliminatesTheContact) {
  LinearizedFrame frame;
  frame.residuals = Eigen::Vector4d(1, -2, 0.5, 3);
  frame.weights = Eigen::Vector4d(1, 0.5, 2, 1);
  frame.by_contact.resize(4, 2);
  frame.by_contact << 1, 2, 0, 1, -1, 3, 2, 0.5;
  frame.by_parameter.resize(4, 3);
  frame.by_parameter << 1, 0, 2, 3, 1, -1, 0.5, 2, 1, -2, 1, 0;
  frame.Eliminate();
  const auto& e = frame.by_contact;
  EXPECT_LT((e.transpose() * frame.reduced).norm(), 1e-12);
  // C - reduced lies in the columns of E.
  const Eigen::MatrixXd taken = frame.by_parameter - frame.reduced;
  const Eigen::MatrixXd in_e =
      e * (e.transpose() * e).inverse() * (e.transpose() * taken);
  EXPECT_LT((in_e - taken).norm(), 1e-12);
  const Eigen::VectorXd r = frame.WeightedResiduals();
  const Eigen::VectorXd left = r + e * frame.move.now;
  EXPECT_LT((e.transpose() * left).norm(), 1e-12);
  EXPECT_NEAR(frame.move.decrease, 0.5 * (r.squaredNorm() - left.squaredNorm()),
              1e-12);
}

TEST(LinearizedFrameTest, SomeRowsAreAFrameOfTheirOwn) {
  LinearizedFrame frame;
  frame.rows = {{ResidualFamily::kGauge, 0},
                {ResidualFamily::kForce, -1},
                {ResidualFamily::kGauge, 1}};
  frame.residuals = Eigen::Vector3d(1, -2, 0.5);
  frame.weights = Eigen::Vector3d(1, 0.5, 1);
  frame.by_contact.resize(3, 2);
  frame.by_contact << 1, 2, 0, 1, -1, 3;
  frame.by_parameter.resize(3, 1);
  frame.by_parameter << 4, 5, 6;
  const LinearizedFrame gauges = frame.WithRows({0, 2});
  ASSERT_EQ(gauges.rows.size(), 2u);
  EXPECT_EQ(gauges.rows[1].gauge, 1);
  EXPECT_EQ(gauges.residuals, Eigen::Vector2d(1, 0.5));
  EXPECT_EQ(gauges.by_contact(1, 1), 3);
  EXPECT_EQ(gauges.by_parameter(1, 0), 6);
}

}  // namespace
}  // namespace finray

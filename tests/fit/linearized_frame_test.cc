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
  EXPECT_LT((EliminateContact(frame.by_parameter, e) - frame.reduced).norm(),
            1e-12);
  const Eigen::VectorXd r = frame.WeightedResiduals();
  const Eigen::VectorXd left = r + e * frame.move.now;
  EXPECT_LT((e.transpose() * left).norm(), 1e-12);
  EXPECT_NEAR(frame.move.decrease, 0.5 * (r.squaredNorm() - left.squaredNorm()),
              1e-12);
}

}  // namespace
}  // namespace finray

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "finray/calib/solve/linearization.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

// A quadratic cost with a contact of its own in each frame, by dense algebra.
TEST(FrameSumResidualTest, ContactsAreEliminated) {
  const Eigen::MatrixXd c = Eigen::MatrixXd::Random(7, 3);
  const Eigen::MatrixXd e = Eigen::MatrixXd::Random(7, 2);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(7);
  LinearizedFrame frame;
  frame.rows.assign(7, {ResidualFamily::kGauge, 0});
  frame.residuals = r;
  frame.weights = Eigen::VectorXd::Ones(7);
  frame.by_parameter = c;
  frame.by_contact = e;
  frame.cost = r.squaredNorm() / 2;
  frame.Eliminate();
  Linearization sums(3, 1);
  sums.Add(0, 0, frame);
  sums.Finish();
  // The least over the contact of |r + C dx + E dc|^2 / 2.
  const auto least = [&](const Eigen::Vector3d& dx) {
    const Eigen::VectorXd at = r + c * dx;
    const Eigen::Vector2d dc = -e.colPivHouseholderQr().solve(at);
    return (at + e * dc).squaredNorm() / 2;
  };
  for (const Eigen::Vector3d& dx :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -2, 3)}) {
    EXPECT_NEAR(sums.cost + sums.gradient.dot(dx) +
                    0.5 * dx.dot(sums.Information() * dx),
                least(dx), 1e-10 * least(dx) + 1e-12);
  }
}

// Rows are summed many at a time; each must count once and for its own log and
// family.
TEST(FrameSumResidualTest, InformationIsTheSumOverAllRows) {
  constexpr int kFrames = 90, kLogs = 3;
  const ResidualFamily families[] = {ResidualFamily::kGauge,
                                     ResidualFamily::kForce};
  Linearization sums(4, kFrames);
  Eigen::MatrixXd of_log[kLogs], of_family[2];
  for (Eigen::MatrixXd& sum : of_log) sum.setZero(4, 4);
  for (Eigen::MatrixXd& sum : of_family) sum.setZero(4, 4);
  for (int i = 0; i < kFrames; ++i) {
    const int log = i < 60 ? 0 : i % kLogs;
    LinearizedFrame frame;
    frame.rows.assign(5, {families[0], 0});
    frame.rows.resize(8, {families[1], -1});
    frame.residuals = Eigen::VectorXd::Random(8);
    frame.weights = Eigen::VectorXd::Ones(8);
    frame.by_parameter = Eigen::MatrixXd::Random(8, 4);
    frame.by_contact.setZero(8, 2);
    frame.Eliminate();
    sums.Add(i, log, frame);
    const Eigen::MatrixXd& c = frame.by_parameter;
    of_log[log] += c.transpose() * c;
    of_family[0] += c.topRows(5).transpose() * c.topRows(5);
    of_family[1] += c.bottomRows(3).transpose() * c.bottomRows(3);
  }
  sums.Finish();
  for (int log = 0; log < kLogs; ++log) {
    EXPECT_LT((sums.InformationOfGroup(log) - of_log[log]).norm(), 1e-11)
        << log;
  }
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(
        (sums.InformationOfFamily(static_cast<int>(families[k])) - of_family[k])
            .norm(),
        1e-11)
        << k;
  }
}

// Ceres sees the cost, gradient and information through it, also where a
// combination is not determined.
TEST(FrameSumResidualTest, ResidualBlockHasTheirCostAndDerivatives) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Random(9, 4);
  j.col(3) = j.col(0) - 2 * j.col(1);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(9);
  const Eigen::VectorXd start = Eigen::VectorXd::Random(4);
  const Eigen::MatrixXd units = Eigen::Vector4d(1, 0.1, 10, 1).asDiagonal();
  const auto sums_at = [&](const Eigen::VectorXd& x, FrameSums* sums) {
    const Eigen::VectorXd at = r + j * (x - start);
    sums->information = j.transpose() * j;
    sums->gradient = j.transpose() * at;
    sums->cost = at.squaredNorm() / 2;
    return x[0] < 100;
  };
  const FrameSumResidual block(start, units, sums_at);
  for (const Eigen::VectorXd& z :
       {Eigen::VectorXd::Zero(4).eval(), Eigen::VectorXd::Ones(4).eval()}) {
    Eigen::VectorXd residuals(5);
    Eigen::Matrix<double, 5, 4, Eigen::RowMajor> jacobian;
    const double* parameters[] = {z.data()};
    double* jacobians[] = {jacobian.data()};
    ASSERT_TRUE(block.Evaluate(parameters, residuals.data(), jacobians));
    FrameSums expected;
    sums_at(start + units * z, &expected);
    EXPECT_NEAR(residuals.squaredNorm() / 2, expected.cost,
                1e-12 * expected.cost);
    EXPECT_LT(
        (jacobian.transpose() * residuals - units * expected.gradient).norm(),
        1e-9 * expected.gradient.norm());
    EXPECT_LT(
        (jacobian.transpose() * jacobian - units * expected.information * units)
            .norm(),
        1e-9 * expected.information.norm() * 100);
  }
  const Eigen::Vector4d far(1000, 0, 0, 0);
  const double* parameters[] = {far.data()};
  Eigen::VectorXd residuals(5);
  EXPECT_FALSE(block.Evaluate(parameters, residuals.data(), nullptr));
}

}  // namespace
}  // namespace finray

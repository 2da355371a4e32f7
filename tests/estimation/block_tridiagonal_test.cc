#include "finray/estimation/block_tridiagonal.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numeric>
#include <random>
#include <stdexcept>

namespace finray {
namespace {

// Rows within every block and between neighbours, some of the blocks empty.
class BlockTridiagonalTest : public testing::Test {
 protected:
  BlockTridiagonalTest() {
    const int columns = std::accumulate(sizes_.begin(), sizes_.end(), 0);
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal(0, 1);
    std::vector<int> first = {0};
    for (const int size : sizes_) first.push_back(first.back() + size);
    jacobian_.num_cols = columns;
    jacobian_.rows.push_back(0);
    for (std::size_t t = 0; t < sizes_.size(); ++t) {
      for (int i = 0; i < 12; ++i) {
        const std::size_t end = std::min(sizes_.size(), t + 1 + i % 2);
        for (int column = first[t]; column < first[end]; ++column) {
          jacobian_.cols.push_back(column);
          // Volts beside millimetres.
          jacobian_.values.push_back(normal(generator) *
                                     (column % 3 == 0 ? 1e4 : 1));
        }
        jacobian_.rows.push_back(static_cast<int>(jacobian_.cols.size()));
        residuals_.push_back(normal(generator));
      }
    }
    rows_ = static_cast<int>(residuals_.size());
    jacobian_.num_rows = rows_;
    dense_ = Eigen::MatrixXd::Zero(rows_, columns);
    for (int row = 0; row < rows_; ++row) {
      for (int i = jacobian_.rows[row]; i < jacobian_.rows[row + 1]; ++i) {
        dense_(row, jacobian_.cols[i]) = jacobian_.values[i];
      }
    }
  }

  std::vector<int> sizes_ = {4, 6, 0, 4, 6, 6, 4};
  ceres::CRSMatrix jacobian_;
  std::vector<double> residuals_;
  int rows_;
  Eigen::MatrixXd dense_;
};

TEST_F(BlockTridiagonalTest, IsTheInverseOfTheDenseMatrix) {
  BlockTridiagonal chain(sizes_);
  chain.Add(jacobian_, residuals_, 0, rows_ / 3);
  chain.Add(jacobian_, residuals_, rows_ / 3, rows_);
  const std::vector<Eigen::MatrixXd> blocks = chain.Marginals();
  const Eigen::MatrixXd inverse = (dense_.transpose() * dense_).inverse();
  int at = 0;
  for (std::size_t t = 0; t < sizes_.size(); ++t) {
    const Eigen::MatrixXd block = InverseInformation(blocks[t]);
    for (int i = 0; i < sizes_[t]; ++i) {
      for (int k = 0; k < sizes_[t]; ++k) {
        const double expected = inverse(at + i, at + k);
        const double unit =
            std::sqrt(inverse(at + i, at + i) * inverse(at + k, at + k));
        EXPECT_NEAR(block(i, k), expected, 1e-9 * unit);
      }
    }
    at += sizes_[t];
  }
}

TEST_F(BlockTridiagonalTest, LastIsTheMarginalOfTheLastBlock) {
  BlockTridiagonal chain(sizes_);
  chain.Add(jacobian_, residuals_, 0, rows_);
  const BlockTridiagonal::Marginal last = chain.Last();
  const Eigen::MatrixXd inverse = (dense_.transpose() * dense_).inverse();
  const Eigen::VectorXd right =
      dense_.transpose() *
      Eigen::Map<const Eigen::VectorXd>(residuals_.data(), rows_);
  const Eigen::MatrixXd covariance = inverse.bottomRightCorner(4, 4);
  const Eigen::MatrixXd unit = last.information * covariance;
  EXPECT_LT((unit - Eigen::MatrixXd::Identity(4, 4)).norm(), 1e-6);
  // The minimum of the marginal is that of all.
  const Eigen::VectorXd step = (inverse * right).tail(4);
  EXPECT_LT((last.information * step - last.gradient).norm(),
            1e-8 * last.gradient.norm());
}

TEST_F(BlockTridiagonalTest, AnOpenDirectionHasALargeVariance) {
  for (int i = 0; i < static_cast<int>(jacobian_.cols.size()); ++i) {
    if (jacobian_.cols[i] == 5) jacobian_.values[i] = 0;
  }
  BlockTridiagonal chain(sizes_);
  chain.Add(jacobian_, residuals_, 0, rows_);
  const Eigen::MatrixXd covariance = InverseInformation(chain.Marginals()[1]);
  EXPECT_GT(covariance(1, 1), 1e11);
  EXPECT_LT(covariance(0, 0), 1e3);
}

TEST_F(BlockTridiagonalTest, RefusesARowOverThreeBlocks) {
  BlockTridiagonal chain({1, 1, 1});
  ceres::CRSMatrix row;
  row.rows = {0, 2};
  row.cols = {0, 2};
  row.values = {1, 1};
  EXPECT_THROW(chain.Add(row, {0}, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace finray

#include "finray/finger/correlations_yaml.h"

#include <Eigen/Eigenvalues>
#include <vector>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {

Eigen::VectorXd ReadStd(const YamlMap& yaml, const std::string& key,
                        std::size_t count, const std::string& what) {
  const std::vector<double> std = yaml.Numbers(key);
  if (std.size() != count) {
    yaml.Fail(key, key + ": expected " + std::to_string(count) +
                       " numbers, one " + what + ", found " +
                       std::to_string(std.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (std[i] < 0) {
      yaml.FailIn(
          key, {i},
          "expected a number of at least 0, found " + NumberText(std[i]));
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(std.data(),
                                           static_cast<Eigen::Index>(count));
}

Eigen::MatrixXd ReadCorrelations(const YamlMap& yaml, std::size_t count,
                                 const std::string& what) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  if (!yaml.Has("correlations")) return matrix;
  const auto rows = yaml.NumberRows("correlations");
  if (rows.size() != count) {
    yaml.Fail("correlations", "correlations: expected " +
                                  std::to_string(count) + " rows, one " + what +
                                  ", found " + std::to_string(rows.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (rows[i].size() != i + 1) {
      yaml.FailIn("correlations", {i},
                  "expected " + std::to_string(i + 1) +
                      " numbers, the lower triangle up to its 1, found " +
                      std::to_string(rows[i].size()));
    }
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = rows[i][j];
      if (i == j && value != 1) {
        yaml.FailIn("correlations", {i, j},
                    "expected 1 on the diagonal, found " + NumberText(value));
      }
      if (!(value >= -1 && value <= 1)) {
        yaml.FailIn(
            "correlations", {i, j},
            "expected a number from -1 to 1, found " + NumberText(value));
      }
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          matrix(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) =
              value;
    }
  }
  const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                              matrix, Eigen::EigenvaluesOnly)
                              .eigenvalues()[0];
  if (smallest < -kCorrelationRounding) {
    yaml.Fail("correlations",
              "correlations: contradict each other: expected no eigenvalue "
              "below 0, found " +
                  NumberText(smallest));
  }
  return matrix;
}

std::string NumberList(const Eigen::VectorXd& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(NumberText(number));
  return "[" + Joined(texts) + "]";
}

std::string CorrelationRows(const Eigen::MatrixXd& correlations,
                            const std::string& indent) {
  std::string rows;
  for (Eigen::Index i = 0; i < correlations.rows(); ++i) {
    rows += indent + "- " + NumberList(correlations.row(i).head(i + 1)) + "\n";
  }
  return rows;
}

}  // namespace finray

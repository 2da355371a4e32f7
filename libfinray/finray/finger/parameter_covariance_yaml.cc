#include "finray/finger/parameter_covariance_yaml.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "finray/io/message_text.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

std::vector<FingerParameter> ReadParameters(const YamlMap& yaml,
                                            const Finger& finger) {
  const std::vector<FingerParameter> known = AllParametersOf(finger);
  std::vector<std::string> names;
  for (const FingerParameter& one : known) names.push_back(ParameterName(one));
  std::vector<FingerParameter> parameters;
  for (const std::string& word : yaml.Choices("parameters", names)) {
    const auto at = std::find(names.begin(), names.end(), word);
    parameters.push_back(known[at - names.begin()]);
    const auto same =
        std::find(parameters.begin(), parameters.end() - 1, parameters.back());
    if (same != parameters.end() - 1) {
      yaml.FailIn("parameters", {parameters.size() - 1},
                  "'" + word + "' appears twice");
    }
  }
  if (parameters.empty()) {
    yaml.Fail("parameters", "parameters: expected at least one");
  }
  return parameters;
}

Eigen::VectorXd ReadStd(const YamlMap& yaml, std::size_t count) {
  const std::vector<double> std = yaml.Numbers("std");
  if (std.size() != count) {
    yaml.Fail("std", "std: expected " + std::to_string(count) +
                         " numbers, one a parameter, found " +
                         std::to_string(std.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (std[i] < 0) {
      yaml.FailIn(
          "std", {i},
          "expected a number of at least 0, found " + NumberText(std[i]));
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(std.data(),
                                           static_cast<Eigen::Index>(count));
}

// The lower triangle, diagonal included.
Eigen::MatrixXd ReadCorrelations(const YamlMap& yaml, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  if (!yaml.Has("correlations")) return matrix;
  const auto rows = yaml.NumberRows("correlations");
  if (rows.size() != count) {
    yaml.Fail("correlations", "correlations: expected " +
                                  std::to_string(count) +
                                  " rows, one a parameter, found " +
                                  std::to_string(rows.size()));
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
  return matrix;
}

// [a, b, ...]
std::string List(const std::vector<std::string>& items) {
  return "[" + Joined(items) + "]";
}

template <class Numbers>
std::string NumberList(const Numbers& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(NumberText(number));
  return List(texts);
}

}  // namespace

ParameterCovariance ReadParameterCovariance(const YamlMap& yaml,
                                            const Finger& finger) {
  yaml.AllowOnly({"parameters", "std", "correlations"});
  ParameterCovariance covariance;
  covariance.parameters = ReadParameters(yaml, finger);
  covariance.std = ReadStd(yaml, covariance.parameters.size());
  covariance.correlations =
      ReadCorrelations(yaml, covariance.parameters.size());
  const double smallest = covariance.SmallestEigenvalue();
  if (smallest < -ParameterCovariance::kRounding) {
    yaml.Fail("correlations",
              "correlations: contradict each other: expected no eigenvalue "
              "below 0, found " +
                  NumberText(smallest));
  }
  return covariance;
}

std::string ParameterCovarianceToYaml(const ParameterCovariance& covariance) {
  std::vector<std::string> names;
  for (const FingerParameter& one : covariance.parameters) {
    names.push_back(ParameterName(one));
  }
  std::ostringstream yaml;
  yaml << "calibration:\n"
       << "  parameters: " << List(names) << "\n"
       << "  std: " << NumberList(covariance.std) << "\n"
       << "  correlations:\n";
  for (Eigen::Index i = 0; i < covariance.std.size(); ++i) {
    yaml << "    - " << NumberList(covariance.correlations.row(i).head(i + 1))
         << "\n";
  }
  return yaml.str();
}

}  // namespace finray

#include "finray/calib/analysis/calibration_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "finray/finger/finger_yaml.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

// Reads a std, which is .inf if nothing determines the parameter.
double StdOf(const YamlMap& yaml) {
  const std::string text = yaml.Text("std");
  if (text == ".inf") return std::numeric_limits<double>::infinity();
  return yaml.NonNegativeNumber("std");
}

}  // namespace

const CalibrationFile::Parameter* CalibrationFile::Find(
    const std::string& name) const {
  for (const Parameter& parameter : parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

Eigen::MatrixXd CalibrationFile::Covariance(
    const std::vector<std::string>& names) const {
  const auto n = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::Index> at(names.size(), -1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found =
        std::find(correlated_.begin(), correlated_.end(), names[i]);
    if (found != correlated_.end()) at[i] = found - correlated_.begin();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (at[i] < 0 || at[j] < 0) continue;
      covariance(i, j) = Find(names[i])->std * Find(names[j])->std *
                         correlations_(at[i], at[j]);
    }
  }
  return covariance;
}

CalibrationFile ReadCalibration(const std::string& path) {
  namespace fs = std::filesystem;
  CalibrationFile file;
  file.path = fs::is_directory(path)
                  ? (fs::path(path) / "calibration.yaml").string()
                  : path;
  const YamlMap yaml = YamlMap::FromFile(file.path);
  if (yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  std::vector<std::string> names;
  for (const YamlMap& map : yaml.Maps("parameters")) {
    map.Choice("status",
               {"estimated", "prior_dominated", "unidentifiable", "fixed"});
    const std::string name = map.RawText("name");
    if (file.Find(name) != nullptr) {
      map.Fail("name", "'" + name + "' is there twice");
    }
    file.parameters.push_back(
        {name, map.Text("unit"), map.Number("value"), StdOf(map)});
    names.push_back(file.parameters.back().name);
  }
  if (names.empty()) {
    yaml.Fail("parameters", "expected the parameters of a calibration");
  }
  const YamlMap correlations = yaml.Map("correlations");
  file.correlated_ = correlations.Choices("names", names);
  const auto rows = correlations.NumberRows("matrix");
  const auto n = static_cast<Eigen::Index>(file.correlated_.size());
  file.correlations_.resize(n, n);
  if (static_cast<Eigen::Index>(rows.size()) != n) {
    correlations.Fail("matrix", "expected " + std::to_string(n) + " rows");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != rows.size()) {
      correlations.FailIn("matrix", {i},
                          "expected " + std::to_string(n) + " numbers");
    }
    for (std::size_t j = 0; j < rows.size(); ++j) {
      file.correlations_(i, j) = rows[i][j];
    }
  }
  for (const YamlMap& log : yaml.Map("inputs").Maps("logs")) {
    file.logs.push_back({log.RawText("path"), log.Text("sha256")});
  }
  file.finger =
      ReadFinger((fs::path(file.path).parent_path() / "finger.yaml").string());
  return file;
}

}  // namespace finray

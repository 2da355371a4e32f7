#include "finray/finger/parameter_covariance_yaml.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "finray/finger/correlations_yaml.h"
#include "finray/io/message_text.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

constexpr const char* kFriction = "friction_coefficient";

std::vector<FingerParameter> ReadParameters(const YamlMap& yaml,
                                            const Finger& finger) {
  std::vector<FingerParameter> known = AllParametersOf(finger);
  known.push_back({FingerParameterKind::kFriction});
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

// Reads the discrepancy for a finger with so many gauges.
GaugeDiscrepancy ReadDiscrepancy(const YamlMap& yaml, std::size_t gauges) {
  yaml.AllowOnly({"load_N", "places"});
  GaugeDiscrepancy discrepancy;
  discrepancy.load_N = yaml.PositiveNumber("load_N");
  for (const YamlMap& place : yaml.Maps("places")) {
    place.AllowOnly({"place_mm", "std_rad", "correlations"});
    const double at = place.Number("place_mm");
    if (!discrepancy.places.empty() &&
        !(at > discrepancy.places.back().place_mm)) {
      place.Fail("place_mm", "place_mm: expected places from base to tip");
    }
    const Eigen::VectorXd std = ReadStd(place, "std_rad", gauges, "a gauge");
    discrepancy.places.push_back(
        {at, std.asDiagonal() * ReadCorrelations(place, gauges, "a gauge") *
                 std.asDiagonal()});
  }
  if (discrepancy.places.empty()) {
    yaml.Fail("places", "places: expected at least one");
  }
  return discrepancy;
}

std::string DiscrepancyToYaml(const GaugeDiscrepancy& discrepancy) {
  std::string yaml =
      "  discrepancy:\n    load_N: " + NumberText(discrepancy.load_N) +
      "\n    places:\n";
  for (const GaugeDiscrepancy::Place& place : discrepancy.places) {
    const Eigen::VectorXd std =
        place.covariance_rad2.diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::VectorXd scale =
        (std.array() > 0).select(std.cwiseInverse(), 0.0);
    Eigen::MatrixXd correlations =
        scale.asDiagonal() * place.covariance_rad2 * scale.asDiagonal();
    correlations = correlations.cwiseMax(-1).cwiseMin(1);
    correlations.diagonal().setOnes();
    yaml += "      - place_mm: " + NumberText(place.place_mm) +
            "\n        std_rad: " + NumberList(std) +
            "\n        correlations:\n" +
            CorrelationRows(correlations, "          ");
  }
  return yaml;
}

}  // namespace

ParameterCovariance ReadParameterCovariance(const YamlMap& yaml,
                                            const Finger& finger) {
  yaml.AllowOnly(
      {"parameters", "std", "correlations", "discrepancy", kFriction});
  ParameterCovariance covariance;
  covariance.parameters = ReadParameters(yaml, finger);
  const std::size_t count = covariance.parameters.size();
  covariance.std = ReadStd(yaml, "std", count, "a parameter");
  covariance.correlations = ReadCorrelations(yaml, count, "a parameter");
  covariance = InOrderOf(finger, covariance);
  covariance.friction = covariance.HasFriction() || yaml.Has(kFriction)
                            ? yaml.Number(kFriction)
                            : kNaN;
  if (yaml.Has("discrepancy")) {
    covariance.discrepancy =
        ReadDiscrepancy(yaml.Map("discrepancy"), finger.gauges.size());
  }
  return covariance;
}

std::string ParameterCovarianceToYaml(const ParameterCovariance& covariance) {
  std::vector<std::string> names;
  for (const FingerParameter& one : covariance.parameters) {
    names.push_back(ParameterName(one));
  }
  std::string yaml = "calibration:\n  parameters: [" + Joined(names) +
                     "]\n  std: " + NumberList(covariance.std) +
                     "\n  correlations:\n" +
                     CorrelationRows(covariance.correlations, "    ");
  if (!std::isnan(covariance.friction)) {
    yaml += std::string("  ") + kFriction + ": " +
            NumberText(covariance.friction) + "\n";
  }
  if (covariance.discrepancy) {
    yaml += DiscrepancyToYaml(*covariance.discrepancy);
  }
  return yaml;
}

}  // namespace finray

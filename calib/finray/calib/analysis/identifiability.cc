#include "finray/calib/analysis/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/calib/solve/information_spectrum.h"
#include "finray/io/number_text.h"

namespace finray {

const char* ParameterStatusName(ParameterStatus status) {
  constexpr const char* kNames[] = {"estimated", "prior_dominated",
                                    "unidentifiable", "fixed"};
  return kNames[static_cast<int>(status)];
}

static_assert(Identifiability::kNull * Identifiability::kNull ==
              kLeastInformation);

Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information) {
  const InformationSpectrum spectrum(information);
  const Eigen::MatrixXd root =
      spectrum.vectors * spectrum.values.cwiseMax(kLeastInformation)
                             .cwiseSqrt()
                             .cwiseInverse()
                             .asDiagonal();
  return root * root.transpose();
}

namespace {

// Says in words which parameters move together along a weak direction.
void DescribeInWords(CalibrationProblem& problem, WeakDirection* direction) {
  double by_family[kParameterFamilies] = {};  // sums of squared shares
  double sign[kParameterFamilies] = {};
  bool one_sign[kParameterFamilies];
  std::fill(std::begin(one_sign), std::end(one_sign), true);
  const auto& all = problem.parameters().all();
  for (const auto& component : direction->components) {
    const int family = static_cast<int>(all[component.parameter].family);
    by_family[family] += component.share * component.share;
    if (sign[family] * component.share < 0) one_sign[family] = false;
    sign[family] = component.share;
  }
  const auto share = [&](ParameterFamily family) {
    return by_family[static_cast<int>(family)];
  };
  const auto same_sign = [&](ParameterFamily family) {
    return one_sign[static_cast<int>(family)];
  };
  const bool both_beams = share(ParameterFamily::kFrontStiffness) > 0.1 &&
                          share(ParameterFamily::kBackStiffness) > 0.1 &&
                          sign[0] * sign[1] > 0;
  const double beams = share(ParameterFamily::kFrontStiffness) +
                       share(ParameterFamily::kBackStiffness);
  const double gains = share(ParameterFamily::kGaugeGain);
  std::string words;
  if (both_beams && beams > 0.9) {
    words = "front and back stiffness and all forces scale together";
  } else if (both_beams && gains > 0.1 && beams + gains > 0.8 &&
             same_sign(ParameterFamily::kGaugeGain)) {
    words = kGainsAgainstStiffness;
  } else {
    for (const auto& component : direction->components) {
      words +=
          FormatText("%s%s (%+.2f)", words.empty() ? "" : ", ",
                     all[component.parameter].name.c_str(), component.share);
    }
    words =
        (direction->components.size() == 1 ? "alone: " : "together: ") + words;
  }
  direction->words = words;
  direction->how_far =
      direction->null
          ? "the data do not say how far"
          : FormatText("the data leave a std of %.3g times the prior's",
                       direction->std_over_prior);
}

WeakDirection Describe(CalibrationProblem* problem,
                       const Eigen::VectorXd& vector, double std_over_prior) {
  WeakDirection direction;
  direction.direction = vector;
  direction.null = std::isinf(std_over_prior);
  direction.std_over_prior = std_over_prior;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    if (std::abs(vector[i]) > 0.15) {
      direction.components.push_back(
          {problem->parameters().free()[static_cast<std::size_t>(i)],
           vector[i]});
    }
  }
  std::sort(direction.components.begin(), direction.components.end(),
            [](const auto& a, const auto& b) {
              return std::abs(a.share) > std::abs(b.share);
            });
  DescribeInWords(*problem, &direction);
  return direction;
}

// The least correlation of gains and stiffness.
constexpr double kRides = 0.9;
// The least std of all gains over that of their ratios.
constexpr double kTogether = 3;

// Adds the weak direction of the common gain. With a force sensor alone, gauges
// tell how the finger bends, but not how far: a stiffer finger with higher
// gains reads the same.
void AddCommonGain(CalibrationProblem* problem, Identifiability* found) {
  const Eigen::MatrixXd& covariance = found->covariance;
  const CalibrationParameters& parameters = problem->parameters();
  const auto n = covariance.rows();
  std::vector<Eigen::VectorXd>
      gains;  // relative change by the scaled variables
  Eigen::VectorXd beams = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (p.family == ParameterFamily::kGaugeGain && *p.variable != 0 &&
        found->status[k] != ParameterStatus::kUnidentifiable) {
      gains.push_back(Eigen::VectorXd::Unit(n, i) * found->unit[i] /
                      *p.variable);
    } else if (p.family == ParameterFamily::kFrontStiffness ||
               p.family == ParameterFamily::kBackStiffness) {
      beams[i] = 0.5 * found->unit[i];
    }
  }
  if (gains.size() < 2 || beams.isZero(0)) return;
  Eigen::VectorXd together = Eigen::VectorXd::Zero(n);
  for (const Eigen::VectorXd& gain : gains) together += gain;
  together /= static_cast<double>(gains.size());
  const auto variance = [&](const Eigen::VectorXd& a) {
    return a.dot(covariance * a);
  };
  double apart = 0;
  for (const Eigen::VectorXd& gain : gains) apart += variance(gain - together);
  apart = std::sqrt(apart / static_cast<double>(gains.size()));
  const double all = std::sqrt(variance(together));
  const double correlation =
      together.dot(covariance * beams) / (all * std::sqrt(variance(beams)));
  if (!(all > kTogether * apart) || !(std::abs(correlation) > kRides)) return;
  const Eigen::VectorXd vector = (covariance * together).normalized();
  WeakDirection direction = Describe(
      problem, vector, 1 / std::sqrt(vector.dot(found->information * vector)));
  direction.words = kGainsAgainstStiffness;
  for (const WeakDirection& known : found->weak) {
    if (known.words == direction.words) return;
  }
  direction.how_far = FormatText(
      "the data leave a std of %.2g %% to all gains together, of "
      "%.2g %% to their ratios",
      100 * all, 100 * apart);
  found->weak.push_back(std::move(direction));
}

}  // namespace

Identifiability AnalyzeIdentifiability(CalibrationProblem* problem,
                                       const Linearization& at) {
  const CalibrationParameters& parameters = problem->parameters();
  const int n = static_cast<int>(parameters.free().size());

  const Eigen::VectorXd unit = parameters.Units();
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(n, n);  // in those units
  for (int i = 0; i < n; ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    if (p.prior_std) prior(i, i) = 1;
  }
  const auto scaled = [&](const Eigen::MatrixXd& of_variables) {
    return Eigen::MatrixXd(unit.asDiagonal() * of_variables *
                           unit.asDiagonal());
  };
  const Eigen::MatrixXd information = scaled(at.Information());

  Identifiability result;
  result.unit = unit;
  result.information = information;
  result.prior = prior;
  const InformationSpectrum spectrum(information);
  const Eigen::VectorXd& value = spectrum.values;
  const Eigen::MatrixXd& vector = spectrum.vectors;

  result.covariance = BoundedCovariance(information + prior);
  const Eigen::MatrixXd& covariance = result.covariance;
  result.correlation.resize(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      result.correlation(i, j) =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
    }
  }
  for (int i = 0; i < n; ++i) {
    // This is the variance from the data alone. It is infinite if the parameter
    // has a share of more than 1 % in a null direction.
    double variance = 0;
    bool null = false, held_by_prior = prior(i, i) > 0;
    for (int k = 0; k < n; ++k) {
      const double share = vector(i, k) * vector(i, k);
      if (value[k] < Identifiability::kNull) {
        null |= share > 0.01;
      } else {
        variance += share / value[k];
      }
    }
    const CalibrationParameter& p = parameters.FreeParameter(i);
    const bool by_prior = held_by_prior && variance > 1;
    result.status.push_back(null || (by_prior && unit[i] > p.vague_std)
                                ? ParameterStatus::kUnidentifiable
                            : by_prior ? ParameterStatus::kPriorDominated
                                       : ParameterStatus::kEstimated);
    result.bounded_std.push_back(unit[i] * std::sqrt(covariance(i, i)));
    result.std.push_back(null && !held_by_prior
                             ? std::numeric_limits<double>::infinity()
                             : result.bounded_std.back());
  }
  for (int k = 0; k < n && value[k] < 1; ++k) {
    const bool null = value[k] < Identifiability::kNull;
    // The std is infinite if the data say nothing along the direction.
    result.weak.push_back(Describe(problem, vector.col(k),
                                   null
                                       ? std::numeric_limits<double>::infinity()
                                       : 1 / std::sqrt(value[k])));
  }
  AddCommonGain(problem, &result);

  // The degrees of freedom of a family: each residual counts 1 less its
  // leverage, which is c cov c' by the parameters plus the leverage of its
  // contact.
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    Identifiability::Noise& noise =
        result.noise[static_cast<int>(at.rows[i].family)];
    ++noise.residuals;
    noise.chi2 += at.weighted_residuals[i] * at.weighted_residuals[i];
  }
  for (int f = 0; f < kResidualFamilies; ++f) {
    result.noise[f].dof =
        result.noise[f].residuals - at.contact_leverage[f] -
        covariance.cwiseProduct(scaled(at.InformationOfFamily(f))).sum();
  }
  return result;
}

void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger) {
  ParameterCovariance covariance;
  std::vector<int> kept;  // indices into parameters.free()
  std::vector<double> std;
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    if (!p.of_finger) continue;
    kept.push_back(static_cast<int>(i));
    covariance.parameters.push_back(*p.of_finger);
    std.push_back(p.ValueStd(*p.variable, found.bounded_std[i]));
  }
  if (kept.empty()) return;
  const auto n = static_cast<Eigen::Index>(kept.size());
  covariance.std = Eigen::Map<const Eigen::VectorXd>(std.data(), n);
  covariance.correlations = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      // Rounding may give a correlation above 1.
      covariance.correlations(i, j) = covariance.correlations(j, i) =
          std::clamp(found.correlation(kept[i], kept[j]), -1.0, 1.0);
    }
  }
  finger->calibration = std::move(covariance);
}

}  // namespace finray

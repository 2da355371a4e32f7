#include "finray/calib/analysis/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/calib/solve/information_spectrum.h"
#include "finray/finger/known_friction.h"
#include "finray/io/number_text.h"

namespace finray {

namespace {

// The least share of a component of a weak direction.
constexpr double kLeastShare = 0.15;

}  // namespace

const char* ParameterStatusName(ParameterStatus status) {
  constexpr const char* kNames[] = {"estimated", "prior_dominated",
                                    "unidentifiable", "fixed"};
  return kNames[static_cast<int>(status)];
}

bool IsHeld(const WeakDirection& direction,
            const std::vector<ParameterStatus>& status) {
  for (Eigen::Index i = 0; i < direction.direction.size(); ++i) {
    if (std::abs(direction.direction[i]) > kLeastShare &&
        status[static_cast<std::size_t>(i)] ==
            ParameterStatus::kUnidentifiable) {
      return false;
    }
  }
  return true;
}

namespace {

// Says in words which parameters move together along a weak direction.
void DescribeInWords(CalibrationProblem& problem,
                     const std::vector<ParameterStatus>& status,
                     WeakDirection* direction) {
  double front = 0, back = 0;  // the shares of the beams' stiffness
  double gains = 0;            // the sum of the squared shares of the gains
  bool raised = false, lowered = false;  // whether some gain is
  const auto& all = problem.parameters().all();
  for (const auto& [parameter, share] : direction->components) {
    const ParameterFamily family = all[parameter].family;
    if (family == ParameterFamily::kFrontStiffness) front = share;
    if (family == ParameterFamily::kBackStiffness) back = share;
    if (family != ParameterFamily::kGaugeGain) continue;
    gains += share * share;
    (share > 0 ? raised : lowered) = true;
  }
  const double beams = front * front + back * back;
  const bool both_beams =
      front * front > 0.1 && back * back > 0.1 && front * back > 0;
  std::string words;
  if (both_beams && beams > 0.9) {
    words = "front and back stiffness and all forces scale together";
  } else if (both_beams && gains > 0.1 && beams + gains > 0.8 &&
             !(raised && lowered)) {
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
      std::isinf(direction->std_over_prior)
          ? IsHeld(*direction, status)
                ? "the data do not say how far, the priors do"
                : "the data do not say how far"
          : FormatText("the data leave a std of %.3g times the prior's",
                       direction->std_over_prior);
}

// The variance that an information leaves to a parameter, in the square of its
// unit.
struct Variance {
  /// Infinite with a share of more than 1 % in a null direction; smaller shares
  /// do not count.
  double value = 0;
  double with_small_shares = 0;
};

std::vector<Variance> Variances(const InformationSpectrum& spectrum) {
  const Eigen::Index n = spectrum.values.size();
  std::vector<Variance> variances(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    Variance& of = variances[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < n; ++k) {
      const double share = spectrum.vectors(i, k) * spectrum.vectors(i, k);
      const double value = spectrum.values[k];
      of.with_small_shares += share / std::max(value, kLeastInformation);
      if (!(value < Identifiability::kNull)) {
        of.value += share / value;
      } else if (share > 0.01) {
        of.value = std::numeric_limits<double>::infinity();
      }
    }
  }
  return variances;
}

// By the data alone, and with all priors that are knowledge.
ParameterStatus StatusOf(const CalibrationParameter& parameter,
                         const Variance& by_data, const Variance& known) {
  const double most = parameter.prior_std ? 1 : 1 / Identifiability::kNull;
  if (std::isfinite(by_data.value) &&
      !(parameter.prior_std && by_data.value > 1)) {
    // Its unit may be so large that its share of what only another's prior
    // determines is small.
    return by_data.with_small_shares > most && known.with_small_shares <= most
               ? ParameterStatus::kPriorDominated
               : ParameterStatus::kEstimated;
  }
  const bool guessed =
      parameter.prior_std && *parameter.prior_std > parameter.vague_std;
  return std::isinf(known.value) || (guessed && known.value > 1)
             ? ParameterStatus::kUnidentifiable
             : ParameterStatus::kPriorDominated;
}

WeakDirection Describe(CalibrationProblem* problem,
                       const std::vector<ParameterStatus>& status,
                       const Eigen::VectorXd& vector, double std_over_prior) {
  WeakDirection direction;
  direction.direction = vector;
  direction.std_over_prior = std_over_prior;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    if (std::abs(vector[i]) > kLeastShare) {
      const auto k = static_cast<std::size_t>(i);
      direction.components.push_back(
          {problem->parameters().free()[k], vector[i]});
    }
  }
  std::sort(direction.components.begin(), direction.components.end(),
            [](const auto& a, const auto& b) {
              return std::abs(a.share) > std::abs(b.share);
            });
  DescribeInWords(*problem, status, &direction);
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
  WeakDirection direction =
      Describe(problem, found->status, vector,
               1 / std::sqrt(vector.dot(found->information * vector)));
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

  Identifiability result;
  result.unit = parameters.Units();
  const Eigen::VectorXd& unit = result.unit;
  result.prior = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd knowledge = result.prior;
  for (int i = 0; i < n; ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    if (!p.prior_std) continue;
    result.prior(i, i) = 1;
    if (*p.prior_std <= p.vague_std) knowledge(i, i) = 1;
  }
  result.information = InUnits(at.Information(), unit);
  const InformationSpectrum spectrum(result.information);
  const Eigen::VectorXd& value = spectrum.values;
  const Eigen::MatrixXd& vector = spectrum.vectors;
  result.weakest = vector.col(0);

  result.covariance = BoundedCovariance(result.information + result.prior);
  const Eigen::MatrixXd& covariance = result.covariance;
  const Eigen::VectorXd std = covariance.diagonal().cwiseSqrt();
  result.correlation = covariance.cwiseQuotient(std * std.transpose());
  const std::vector<Variance> by_data = Variances(spectrum);
  const std::vector<Variance> known =
      Variances(InformationSpectrum(result.information + knowledge));
  for (int i = 0; i < n; ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    result.status.push_back(StatusOf(p, by_data[i], known[i]));
    result.bounded_std.push_back(unit[i] * std[i]);
    result.std.push_back(std::isinf(known[i].value) && !p.prior_std
                             ? std::numeric_limits<double>::infinity()
                             : result.bounded_std.back());
  }
  for (int k = 0; k < n && value[k] < 1; ++k) {
    const bool null = value[k] < Identifiability::kNull;
    // The std is infinite if the data say nothing along the direction.
    result.weak.push_back(Describe(problem, result.status, vector.col(k),
                                   null
                                       ? std::numeric_limits<double>::infinity()
                                       : 1 / std::sqrt(value[k])));
  }
  AddCommonGain(problem, &result);

  // The degrees of freedom of a family: each residual counts 1 less its
  // leverage, which is c cov c' by the parameters plus the leverage of its
  // contact. A row that repeats others has less chi2 than 1 by as much as its
  // std counts more often.
  std::array<double, kResidualFamilies> told = {};
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const ResidualFamily family = at.rows[i].family;
    const CalibrationFrame& frame = problem->frame(at.rows[i].frame);
    Identifiability::Noise& noise = result.noise[static_cast<int>(family)];
    result.touches |= frame.contact;
    ++noise.residuals;
    told[static_cast<int>(family)] += std::pow(frame.StdTimes(family), -2);
    noise.chi2 += at.weighted_residuals[i] * at.weighted_residuals[i];
  }
  for (int f = 0; f < kResidualFamilies; ++f) {
    Identifiability::Noise& noise = result.noise[f];
    if (noise.residuals == 0) continue;
    const double leverage =
        at.contact_leverage[f] +
        covariance.cwiseProduct(InUnits(at.InformationOfFamily(f), unit)).sum();
    noise.dof = told[f] * (1 - leverage / noise.residuals);
  }
  return result;
}

bool Identifiability::Noise::IsTooQuiet() const {
  if (dof < kEnoughDof || !(chi2 < kTooQuiet * dof)) return false;
  const double variance = 2 / (9 * dof);
  return std::cbrt(chi2 / dof) < 1 - variance - kSurely * std::sqrt(variance);
}

TotalChi2 TotalChi2::Of(const Identifiability& found) {
  TotalChi2 total;
  for (const Identifiability::Noise& noise : found.noise) {
    if (noise.residuals == 0) continue;
    total.chi2 += noise.chi2;
    total.dof += noise.dof;
  }
  return total;
}

void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger) {
  ParameterCovariance covariance;
  std::vector<int> kept;  // indices into parameters.free()
  std::vector<double> std;
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    std::optional<FingerParameter> its = p.of_finger;
    if (p.family == ParameterFamily::kFriction) {
      its = FingerParameter{FingerParameterKind::kFriction};
      covariance.friction = *p.variable;
    }
    if (!its) continue;
    kept.push_back(static_cast<int>(i));
    covariance.parameters.push_back(*its);
    std.push_back(p.ValueStd(*p.variable, found.bounded_std[i]));
  }
  if (kept.empty()) return;
  const auto n = static_cast<Eigen::Index>(kept.size());
  // What was fixed is as uncertain as it was.
  std::optional<ParameterCovariance> before = finger->calibration;
  if (found.touches) {
    covariance.friction = parameters.friction();
    before = ForFriction(*finger, covariance.friction).calibration;
  } else if (before && std::isnan(covariance.friction)) {
    covariance.friction = before->friction;
  }
  std::vector<Eigen::Index> fixed;
  for (std::size_t k = 0; before && k < before->parameters.size(); ++k) {
    const FingerParameter& p = before->parameters[k];
    const auto& found_ones = covariance.parameters;
    if (std::find(found_ones.begin(), found_ones.end(), p) ==
        found_ones.end()) {
      fixed.push_back(static_cast<Eigen::Index>(k));
    }
  }
  for (const Eigen::Index k : fixed) {
    const FingerParameter& p = before->parameters[k];
    covariance.parameters.push_back(p);
    std.push_back(before->std[k]);
  }
  const auto all = static_cast<Eigen::Index>(std.size());
  covariance.std = Eigen::Map<const Eigen::VectorXd>(std.data(), all);
  covariance.correlations = Eigen::MatrixXd::Identity(all, all);
  if (!fixed.empty()) {
    covariance.correlations.bottomRightCorner(all - n, all - n) =
        before->correlations(fixed, fixed);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      // Rounding may give a correlation above 1.
      covariance.correlations(i, j) = covariance.correlations(j, i) =
          std::clamp(found.correlation(kept[i], kept[j]), -1.0, 1.0);
    }
  }
  finger->calibration = InOrderOf(*finger, covariance);
}

}  // namespace finray

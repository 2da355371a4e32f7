#include "finray/estimation/zeroed_finger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "finray/estimation/chi_squared.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/possible_reading.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/scene.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

struct Mean {
  double mean = 0, scatter = 0;
  std::size_t count = 0;
};

Mean MeanOf(const std::vector<Measurements>& rows, int gauge,
            const Gauge& its) {
  Mean of;
  double squares = 0;
  for (const Measurements& row : rows) {
    const double volts = row.gauges_V[gauge];
    if (!its.IsMeasured(volts) || std::abs(volts) > kLargestReading_V) continue;
    const double off = volts - of.mean;
    of.mean += off / static_cast<double>(++of.count);
    squares += off * (volts - of.mean);
  }
  if (of.count > 1) {
    of.scatter = std::sqrt(squares / static_cast<double>(of.count - 1));
  }
  return of;
}

// Returns true if a gauge varies by more than noise.
bool Moves(const std::vector<Measurements>& rows, std::size_t gauge,
           const Gauge& its) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Measurements& row : rows) {
    const double volts = row.gauges_V[gauge];
    if (!its.IsMeasured(volts)) continue;
    low = std::min(low, volts);
    high = std::max(high, volts);
  }
  return high - low > GaugeStandstill::kNoiseRange * its.noise_V;
}

// Returns dg/dx by central differences of a tenth of a std.
Eigen::MatrixXd SlopesOf(const Finger& finger,
                         const Discretization& discretization,
                         const std::vector<FingerParameter>& parameters,
                         const Eigen::VectorXd& std) {
  Eigen::MatrixXd slopes(finger.gauges.size(), parameters.size());
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    if (parameters[k].kind == FingerParameterKind::kFriction) {
      slopes.col(k).setZero();  // nothing touches
      continue;
    }
    const double value = ParameterValue(finger, parameters[k]);
    const double step =
        std::max(0.1 * std[k], 1e-6 * std::max(1.0, std::abs(value)));
    Finger more = finger, less = finger;
    SetParameter(parameters[k], value + step, &more);
    SetParameter(parameters[k], value - step, &less);
    slopes.col(k) =
        (FreeVolts(more, discretization) - FreeVolts(less, discretization)) /
        (2 * step);
  }
  return slopes;
}

// Replaces the part of the covariance that belongs to the offsets.
void RenewCovariance(const Discretization& discretization,
                     const std::vector<double>& noise_std_V, Finger* finger) {
  const ParameterCovariance& old = *finger->calibration;
  std::vector<FingerParameter> others;
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < old.parameters.size(); ++k) {
    if (old.parameters[k].kind == FingerParameterKind::kGaugeOffset) continue;
    others.push_back(old.parameters[k]);
    kept.push_back(static_cast<Eigen::Index>(k));
  }
  const auto n = static_cast<Eigen::Index>(kept.size());
  const auto gauges = static_cast<Eigen::Index>(noise_std_V.size());
  Eigen::VectorXd std(n);
  for (Eigen::Index k = 0; k < n; ++k) std[k] = old.std[kept[k]];
  Eigen::MatrixXd covariance(n + gauges, n + gauges);
  covariance.topLeftCorner(n, n) =
      std.asDiagonal() * old.correlations(kept, kept) * std.asDiagonal();
  const Eigen::MatrixXd slopes = SlopesOf(*finger, discretization, others, std);
  covariance.bottomLeftCorner(gauges, n) =
      -slopes * covariance.topLeftCorner(n, n);
  covariance.topRightCorner(n, gauges) =
      covariance.bottomLeftCorner(gauges, n).transpose();
  covariance.bottomRightCorner(gauges, gauges) =
      -covariance.bottomLeftCorner(gauges, n) * slopes.transpose();
  for (Eigen::Index j = 0; j < gauges; ++j) {
    covariance(n + j, n + j) += noise_std_V[j] * noise_std_V[j];
    others.push_back({FingerParameterKind::kGaugeOffset, static_cast<int>(j)});
  }

  ParameterCovariance renewed;
  renewed.parameters = others;
  renewed.std = covariance.diagonal().cwiseSqrt();
  // A parameter may be known exactly.
  const Eigen::VectorXd scale =
      (renewed.std.array() > 0).select(renewed.std.cwiseInverse(), 0.0);
  renewed.correlations = scale.asDiagonal() * covariance * scale.asDiagonal();
  renewed.correlations.diagonal().setOnes();
  renewed.friction = old.friction;
  renewed.discrepancy = old.discrepancy;
  finger->calibration = InOrderOf(*finger, renewed);
}

// Throws if gauges do not move.
void RefuseStill(const Finger& finger, const ZeroedFinger& zeroed,
                 const std::string& source, const ZeroCheck& check) {
  if (zeroed.fewest < kFewZeroRows) return;
  std::string gauges;
  int count = 0;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double near_V = kNear * gauge.noise_V;
    const bool is_expected = std::abs(gauge.offset_V) > near_V &&
                             std::abs(zeroed.change_V[j]) < near_V;
    if (zeroed.scatter_V[j] > kStill * gauge.noise_V || is_expected ||
        (check.log && Moves(*check.log, j, gauge))) {
      continue;
    }
    gauges += (count++ > 0 ? ", " : "") + std::to_string(j + 1);
  }
  if (gauges.empty()) return;
  throw InputError(
      source + (count > 1 ? ": gauges " : ": gauge ") + gauges +
      (count > 1 ? " do" : " does") + " not move in " +
      std::to_string(zeroed.rows) +
      " rows, not even by noise: " + GaugeStandstill::kCauses +
      "; mend that, or state --allow_touch if its converter has steps "
      "above its noise, or its noise_V is too large");
}

// Throws if one contact explains the mean readings by the old offsets.
void RefuseTouch(const Finger& finger, const Discretization& discretization,
                 const Eigen::VectorXd& free_V, const Measurements& means,
                 const ZeroedFinger& zeroed, const std::string& source,
                 const ZeroCheck& check) {
  if (finger.gauges.size() < FrameEstimator::kUnknowns) return;
  Finger tried = finger;
  double free_chi2 = 0;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    tried.gauges[j].noise_V = zeroed.std_V[j];
    const double off = means.gauges_V[j] - finger.gauges[j].offset_V -
                       free_V[static_cast<Eigen::Index>(j)];
    free_chi2 += off * off / (zeroed.std_V[j] * zeroed.std_V[j]);
  }
  const bool known =
      finger.calibration && !std::isnan(finger.calibration->friction);
  const double coefficient = check.friction == 0 && known
                                 ? finger.calibration->friction
                                 : check.friction;
  const auto readings = static_cast<double>(zeroed.fewest);
  // Errors of the offsets that the calibration left explain no touch: they are
  // what is asked for here.
  const bool discrepant = finger.calibration && finger.calibration->discrepancy;
  for (const double friction : {coefficient, -coefficient}) {
    Scene scene;
    scene.contacts = 1;
    scene.friction_coefficient = friction;
    const FrameEstimate touch =
        FrameEstimator(tried, scene, discretization).Estimate(means);
    const double chi2 = discrepant ? touch.explained_chi2() : touch.chi2;
    const bool explains =
        ChiSquaredTail(chi2, touch.dof) >= FrameEstimate::kUnexplained ||
        touch.chi2 < kTouchLeaves * kTouchLeaves * free_chi2;
    const bool lowers =
        free_chi2 - touch.chi2 >= FrameEstimator::kSignificance * readings;
    const ContactEstimate& at = touch.contact[0];
    if (explains && lowers &&
        at.normal_N >= FrameEstimator::LeastForce_N(finger)) {
      throw InputError(
          source +
          FormatText(": a contact of %.3g N at %.3g mm explains the readings, "
                     "the free finger with its old offsets does not; choose "
                     "rows in which nothing touches it with --zero_rows, or "
                     "state --allow_touch if nothing does",
                     at.normal_N, at.arc_mm));
    }
    if (coefficient == 0) return;
  }
}

}  // namespace

Eigen::VectorXd FreeVolts(const Finger& finger,
                          const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  if (!solver.Solve({})) {
    throw InputError("the free finger has no equilibrium: " + solver.Why());
  }
  Eigen::VectorXd volts(static_cast<Eigen::Index>(finger.gauges.size()));
  for (Eigen::Index j = 0; j < volts.size(); ++j) {
    volts[j] =
        finger.gauges[j].BendingVolts(solver.gauge_angle(static_cast<int>(j)));
  }
  return volts;
}

ZeroedFinger ZeroGauges(const Finger& finger,
                        const Discretization& discretization,
                        const std::vector<Measurements>& free_rows,
                        const std::string& source, const ZeroCheck& check) {
  ZeroedFinger zeroed{finger, free_rows.size(), {}, {}, {}, free_rows.size()};
  Measurements means;
  const Eigen::VectorXd free_V = FreeVolts(finger, discretization);
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    Gauge& gauge = zeroed.finger.gauges[j];
    const Mean of = MeanOf(free_rows, j, gauge);
    if (of.count < kLeastZeroRows) {
      throw InputError(source + ": " + GaugeVolts(j) + " has " +
                       std::to_string(of.count) +
                       " readings in the free rows, expected at least " +
                       std::to_string(kLeastZeroRows));
    }
    const double loop_V = gauge.HysteresisV();
    if (of.scatter > kSteady * std::hypot(gauge.noise_V, loop_V)) {
      throw InputError(
          source + ": " + GaugeVolts(j) +
          FormatText(" varies by %.2g mV in the free rows, its noise_V is "
                     "%.2g mV: the finger moves or touches there; choose rows "
                     "of the resting finger with --zero_rows",
                     1e3 * of.scatter, 1e3 * gauge.noise_V));
    }
    means.gauges_V.push_back(of.mean);
    zeroed.scatter_V.push_back(of.scatter);
    zeroed.fewest = std::min(zeroed.fewest, of.count);
    const double offset = of.mean - free_V[j];
    zeroed.change_V.push_back(offset - gauge.offset_V);
    // Where in its loop the gauge has come to rest is not known.
    zeroed.std_V.push_back(
        std::hypot(std::max(of.scatter, gauge.noise_V) /
                       std::sqrt(static_cast<double>(of.count)),
                   loop_V / std::sqrt(3.0)));
    gauge.offset_V = offset;
  }
  if (!check.touch_allowed) {
    RefuseStill(finger, zeroed, source, check);
    RefuseTouch(finger, discretization, free_V, means, zeroed, source, check);
  }
  if (finger.calibration) {
    RenewCovariance(discretization, zeroed.std_V, &zeroed.finger);
  }
  return zeroed;
}

}  // namespace finray

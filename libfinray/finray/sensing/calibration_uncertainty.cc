#include "finray/sensing/calibration_uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "finray/io/nan.h"

namespace finray {
namespace {

// dr_j/dp of a parameter of gauge j's reading. The gauge may have none.
double ByReading(FingerParameterKind kind, const Gauge& gauge, double volts,
                 bool read) {
  if (kind == FingerParameterKind::kGaugeOffset && !gauge.IsCurved()) {
    return 1 / gauge.gain_V_per_rad;
  }
  if (!read) return 0;
  const double angle = gauge.Angle(volts), slope = gauge.Slope(angle);
  const double linear = gauge.Signal(angle);
  switch (kind) {
    case FingerParameterKind::kGaugeOffset:
      return 1 / slope;
    case FingerParameterKind::kGaugeGain:
      return linear / slope;
    case FingerParameterKind::kGaugeCurvature:
      return gauge.gain_V_per_rad * angle * angle / slope;
    case FingerParameterKind::kGaugeCreepShare:
      return gauge.gain_V_per_rad * linear / (1 + gauge.creep_share) / slope;
    case FingerParameterKind::kGaugeFlatShare:
      return gauge.gain_V_per_rad * gauge.SignalByFlatShare(angle) / slope;
    case FingerParameterKind::kGaugeFlatWidth:
      return gauge.gain_V_per_rad * gauge.SignalByFlatWidth(angle) / slope;
    default:
      return 0;  // kGaugeCreepTime, kGaugeHysteresis
  }
}

}  // namespace

CalibrationUncertainty::Model::Model(const Finger& finger,
                                     const KnownFriction& friction,
                                     std::optional<double> circle_radius_mm,
                                     EquilibriumSolver* solver,
                                     Table with_table)
    : finger(finger),
      friction(friction),
      circle_radius_mm(circle_radius_mm),
      solver(*solver),
      gauge_places(finger.calibration->HasGaugePlaces()),
      factor(finger.calibration->Factor()),
      by_parameter(2, factor.rows()),
      by_factor(2, factor.cols()),
      discrepancy(finger.gauges.size(), finger.gauges.size()),
      by_discrepancy(2, finger.gauges.size()) {
  if (with_table == Table::kNone) return;
  table.emplace(friction.coefficient, circle_radius_mm, solver, gauge_places);
  derivatives.resize(table->rows(), table->columns());
  slope.resize(table->rows(), 2);
  by_measured.resize(2, table->rows());
}

CalibrationUncertainty::CalibrationUncertainty(
    const Finger& any, const KnownFriction& friction, EquilibriumSolver* solver,
    std::optional<double> circle_radius_mm, Table table) {
  const Finger finger = ForFriction(any, friction);
  if (!finger.calibration) return;
  solver->model().set_effects(finger.calibration->StaticsEffects(),
                              finger.calibration->HasFriction());
  model_.emplace(finger, friction, circle_radius_mm, solver, table);
  model_->of_calibration =
      any.calibration && IsFrictionOf(*any.calibration, friction.coefficient);
  solver->model().set_effects({});
}

void CalibrationUncertainty::SetErrors(const ParameterCovariance& calibration) {
  Model& m = *model_;
  m.finger.calibration = calibration;
  // Whether the friction counts as the calibration's is settled: the table has
  // its parameters.
  m.finger.calibration->friction =
      m.of_calibration ? m.friction.coefficient : kNaN;
  m.finger = ForFriction(m.finger, m.friction);
  m.factor = m.finger.calibration->Factor();
}

ContactMatrix CalibrationUncertainty::Of(
    const std::vector<PointContact>& contacts,
    const std::vector<double>& readings_V, const Eigen::VectorXd& weights) {
  Model& m = *model_;
  const int unknowns = 2 * static_cast<int>(contacts.size());
  ContactMatrix covariance(unknowns, unknowns);
  if (!FindDerivatives(contacts)) {
    covariance.setZero();
    covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return covariance;
  }
  m.slope = weights.asDiagonal() * m.derivatives.leftCols(unknowns);
  covariance.noalias() = m.slope.transpose().lazyProduct(m.slope);
  const ContactMatrix noise = CovarianceOf(covariance);
  if (std::isinf(noise(0, 0))) return noise;
  m.by_measured.noalias() = noise.lazyProduct(m.slope.transpose());
  m.by_measured.array().rowwise() *= weights.transpose().array();
  FillByParameter(unknowns, readings_V, weights);
  m.by_factor.noalias() = m.by_parameter.lazyProduct(m.factor);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    // Converts the row from ln f_c to f_c.
    m.by_factor.row(2 * static_cast<int>(c) + 1) *= contacts[c].normal_N;
    m.by_measured.row(2 * static_cast<int>(c) + 1) *= contacts[c].normal_N;
  }
  covariance.noalias() = m.by_factor.lazyProduct(m.by_factor.transpose());
  if (contacts.size() == 1) FindWholeForce(contacts[0]);
  if (has_discrepancy()) {
    FindDiscrepancy(contacts);
    const auto by_angle = m.by_measured.leftCols(m.discrepancy.rows());
    m.by_discrepancy.noalias() = by_angle.lazyProduct(m.discrepancy);
    const ContactMatrix missed =
        m.by_discrepancy.lazyProduct(by_angle.transpose());
    covariance += missed;
    if (contacts.size() == 1) {
      const double friction = contacts[0].friction;
      whole_force_variance_N2_ += (1 + friction * friction) * missed(1, 1);
    }
  }
  return covariance;
}

// dF = c df_c + f_c mu / c dmu with c = sqrt(1 + mu^2).
void CalibrationUncertainty::FindWholeForce(const PointContact& contact) {
  const Model& m = *model_;
  const double mu = contact.friction, per_normal = std::hypot(1, mu);
  const bool varies = m.finger.calibration->HasFriction();
  whole_force_variance_N2_ = 0;
  for (Eigen::Index k = 0; k < m.by_factor.cols(); ++k) {
    double error = per_normal * m.by_factor(1, k);
    if (varies) {  // the last parameter
      error +=
          contact.normal_N * mu / per_normal * m.factor(m.factor.rows() - 1, k);
    }
    whole_force_variance_N2_ += error * error;
  }
}

double CalibrationUncertainty::Chi2(const std::vector<PointContact>& contacts,
                                    const std::vector<double>& readings_V,
                                    const Eigen::VectorXd& weights) {
  const auto at = ErrorsAt(contacts, readings_V, weights);
  if (!at) return std::numeric_limits<double>::infinity();
  const Eigen::Index gauges = at->error.size();
  const auto w = weights.head(gauges).asDiagonal();
  const Eigen::MatrixXd error = w * at->by_factor;
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(gauges, gauges) + error * error.transpose();
  if (has_discrepancy()) {
    FindDiscrepancy(contacts);
    covariance += w * model_->discrepancy * w;
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd whitened =
      root.matrixL().solve(Eigen::VectorXd(w * at->error));
  if (contacts.empty()) return whitened.squaredNorm();
  const Eigen::MatrixXd slope =
      root.matrixL().solve(Eigen::MatrixXd(w * at->by_contact));
  return (whitened - slope * slope.colPivHouseholderQr().solve(whitened))
      .squaredNorm();
}

std::optional<CalibrationUncertainty::GaugeErrors>
CalibrationUncertainty::ErrorsAt(const std::vector<PointContact>& contacts,
                                 const std::vector<double>& readings_V,
                                 const Eigen::VectorXd& weights) {
  Model& m = *model_;
  const auto unknowns = 2 * static_cast<Eigen::Index>(contacts.size());
  m.solver.Reset();
  if (!m.solver.SolveWithSensitivities(contacts)) return {};
  ReadSensitivities(m.solver, contacts, std::nullopt, m.gauge_places,
                    &m.derivatives);
  const Eigen::Index gauges = m.derivatives.rows();
  GaugeErrors at;
  at.error = Eigen::VectorXd::Zero(gauges);
  Eigen::MatrixXd by_parameter = Eigen::MatrixXd::Zero(gauges, m.factor.rows());
  ForEachParameter(
      readings_V, weights,
      [&](Eigen::Index k, Eigen::Index which) {
        by_parameter.col(k) = m.derivatives.col(unknowns + which);
      },
      [&](Eigen::Index k, int gauge, double slope) {
        by_parameter(gauge, k) = slope;
      });
  for (Eigen::Index j = 0; j < gauges; ++j) {
    if (weights[j] == 0) continue;
    const auto i = static_cast<std::size_t>(j);
    at.error[j] =
        m.solver.outputs()[j] - m.finger.gauges[i].Angle(readings_V[i]);
  }
  at.by_contact = m.derivatives.leftCols(unknowns);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    // Converts the column from ln f_c to f_c.
    if (contacts[c].normal_N == 0) continue;
    at.by_contact.col(2 * static_cast<int>(c) + 1) /= contacts[c].normal_N;
  }
  at.by_factor = by_parameter * m.factor;
  return at;
}

void CalibrationUncertainty::FindDiscrepancy(
    const std::vector<PointContact>& contacts) {
  Model& m = *model_;
  m.discrepancy.setZero();
  for (const PointContact& contact : contacts) {
    m.finger.calibration->discrepancy->AddTo(contact.arc_mm, contact.normal_N,
                                             &m.discrepancy);
  }
}

bool CalibrationUncertainty::FindDerivatives(
    const std::vector<PointContact>& contacts) {
  Model& m = *model_;
  if (contacts.size() == 1 && m.table &&
      m.table->Interpolate(contacts[0].arc_mm, contacts[0].normal_N,
                           &m.derivatives)) {
    return true;
  }
  // A cold start, so that the result does not depend on the frame before.
  m.solver.Reset();
  if (!m.solver.SolveWithSensitivities(contacts)) return false;
  ReadSensitivities(m.solver, contacts, m.circle_radius_mm, m.gauge_places,
                    &m.derivatives);
  return true;
}

void CalibrationUncertainty::FillByParameter(
    int unknowns, const std::vector<double>& readings_V,
    const Eigen::VectorXd& weights) {
  Model& m = *model_;
  m.by_parameter.resize(unknowns, m.factor.rows());
  ForEachParameter(
      readings_V, weights,
      [&](Eigen::Index k, Eigen::Index which) {
        m.by_parameter.col(k).noalias() =
            -m.by_measured.lazyProduct(m.derivatives.col(unknowns + which));
      },
      [&](Eigen::Index k, int gauge, double slope) {
        m.by_parameter.col(k) = -slope * m.by_measured.col(gauge);
      });
}

template <class ByStatics, class ByGauge>
void CalibrationUncertainty::ForEachParameter(
    const std::vector<double>& readings_V, const Eigen::VectorXd& weights,
    const ByStatics& by_statics, const ByGauge& by_gauge) const {
  const Model& m = *model_;
  const std::vector<FingerParameter>& parameters =
      m.finger.calibration->parameters;
  int effect = 2 + m.solver.model().ribs();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const int index = parameters[i].index;
    switch (parameters[i].kind) {
      case FingerParameterKind::kFrontStiffness:
        by_statics(k, 0);
        break;
      case FingerParameterKind::kBackStiffness:
        by_statics(k, 1);
        break;
      case FingerParameterKind::kRibLength:
        by_statics(k, 2 + index);
        break;
      case FingerParameterKind::kHingeStiffness:
      case FingerParameterKind::kRibBending:
      case FingerParameterKind::kFrontPiece:
      case FingerParameterKind::kBackPiece:
      case FingerParameterKind::kFrontHinge:
      case FingerParameterKind::kBackHinge:
      case FingerParameterKind::kFrontClamp:
      case FingerParameterKind::kBackClamp:
      case FingerParameterKind::kBackAngle:
      case FingerParameterKind::kSurfaceOffset:
      case FingerParameterKind::kFriction:
        by_statics(k, effect++);
        break;
      case FingerParameterKind::kGaugeStart:
        by_gauge(k, index, m.derivatives.rightCols<2>()(index, 0));
        break;
      case FingerParameterKind::kGaugeLength:
        by_gauge(k, index, m.derivatives.rightCols<2>()(index, 1));
        break;
      case FingerParameterKind::kGaugeGain:
      case FingerParameterKind::kGaugeOffset:
      case FingerParameterKind::kGaugeCurvature:
      case FingerParameterKind::kGaugeCreepShare:
      case FingerParameterKind::kGaugeCreepTime:
      case FingerParameterKind::kGaugeFlatShare:
      case FingerParameterKind::kGaugeFlatWidth:
      case FingerParameterKind::kGaugeHysteresis:
        by_gauge(k, index,
                 ByReading(parameters[i].kind, m.finger.gauges[index],
                           readings_V[index], weights[index] != 0));
    }
  }
}

}  // namespace finray

#include "finray/sensing/calibration_uncertainty.h"

#include <Eigen/Cholesky>
#include <limits>

namespace finray {
namespace {

// Below this share of independence the slopes tell no contact.
constexpr double kSingular = 1e-14;

}  // namespace

CalibrationUncertainty::Model::Model(const Finger& finger, double friction,
                                     EquilibriumSolver* solver)
    : finger(finger),
      solver(*solver),
      table(friction, solver),
      factor(finger.calibration->Factor()),
      derivatives(solver->model().gauges(), table.columns()),
      slope(solver->model().gauges(), 2),
      by_angle(2, slope.rows()),
      by_parameter(2, factor.rows()),
      by_factor(2, factor.cols()) {}

CalibrationUncertainty::CalibrationUncertainty(const Finger& finger,
                                               double friction,
                                               EquilibriumSolver* solver) {
  if (finger.calibration) model_.emplace(finger, friction, solver);
}

CalibrationUncertainty::Covariance CalibrationUncertainty::Of(
    const std::vector<PointContact>& contacts,
    const std::vector<double>& readings_V,
    const Eigen::VectorXd& weight_per_rad) {
  Model& m = *model_;
  const int unknowns = 2 * static_cast<int>(contacts.size());
  Covariance covariance(unknowns, unknowns);
  if (!FindDerivatives(contacts) || !InvertSlope(unknowns, weight_per_rad)) {
    covariance.setZero();
    covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return covariance;
  }
  FillByParameter(unknowns, readings_V, weight_per_rad);
  m.by_factor.noalias() = m.by_parameter.lazyProduct(m.factor);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    // From ln f_c to f_c.
    m.by_factor.row(2 * static_cast<int>(c) + 1) *= contacts[c].normal_N;
  }
  covariance.noalias() = m.by_factor.lazyProduct(m.by_factor.transpose());
  return covariance;
}

bool CalibrationUncertainty::FindDerivatives(
    const std::vector<PointContact>& contacts) {
  Model& m = *model_;
  if (contacts.size() == 1 &&
      m.table.Interpolate(contacts[0].arc_mm, contacts[0].normal_N,
                          &m.derivatives)) {
    return true;
  }
  // A cold solve: the result must not depend on the frame before.
  m.solver.Reset();
  if (!m.solver.SolveWithSensitivities(contacts)) return false;
  m.derivatives = m.solver.d_outputs().topRows(m.slope.rows());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    m.derivatives.col(2 * static_cast<int>(c) + 1) *= contacts[c].normal_N;
  }
  return true;
}

// by_angle = (J'WJ)^-1 J'W, by the normal equations scaled to a diagonal of 1.
bool CalibrationUncertainty::InvertSlope(
    int unknowns, const Eigen::VectorXd& weight_per_rad) {
  Model& m = *model_;
  m.slope = weight_per_rad.asDiagonal() * m.derivatives.leftCols(unknowns);
  Covariance normal(unknowns, unknowns);
  normal.noalias() = m.slope.transpose().lazyProduct(m.slope);
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>
      unit = normal.diagonal().cwiseSqrt().cwiseInverse();
  if (!unit.allFinite()) return false;
  normal = unit.asDiagonal() * normal * unit.asDiagonal();
  const Eigen::LDLT<Covariance> factored(normal);
  if (!(factored.vectorD().minCoeff() > kSingular)) return false;
  m.by_angle = unit.asDiagonal() * m.slope.transpose();
  m.by_angle = m.by_angle * weight_per_rad.asDiagonal();
  factored.solveInPlace(m.by_angle);
  m.by_angle = unit.asDiagonal() * m.by_angle;
  return true;
}

void CalibrationUncertainty::FillByParameter(
    int unknowns, const std::vector<double>& readings_V,
    const Eigen::VectorXd& weight_per_rad) {
  Model& m = *model_;
  const std::vector<FingerParameter>& parameters =
      m.finger.calibration->parameters;
  m.by_parameter.resize(unknowns, static_cast<int>(parameters.size()));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const int index = parameters[k].index;
    auto column = m.by_parameter.col(static_cast<int>(k));
    const auto by_reading = [&](double slope) {
      column = -slope * m.by_angle.col(index);
    };
    const auto by_statics = [&](int which) {
      column.noalias() =
          -m.by_angle.lazyProduct(m.derivatives.col(unknowns + which));
    };
    switch (parameters[k].kind) {
      case FingerParameterKind::kFrontStiffness:
        by_statics(0);
        break;
      case FingerParameterKind::kBackStiffness:
        by_statics(1);
        break;
      case FingerParameterKind::kRibLength:
        by_statics(2 + index);
        break;
      case FingerParameterKind::kGaugeGain: {
        const Gauge& gauge = m.finger.gauges[index];
        // An unused gauge may have no reading.
        by_reading(weight_per_rad[index] == 0
                       ? 0
                       : (readings_V[index] - gauge.offset_V) /
                             (gauge.gain_V_per_rad * gauge.gain_V_per_rad));
        break;
      }
      case FingerParameterKind::kGaugeOffset:
        by_reading(1 / m.finger.gauges[index].gain_V_per_rad);
        break;
    }
  }
}

}  // namespace finray

#include "finray/sensing/contact_descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/sensing/circle_centre.h"

namespace finray {
namespace {

constexpr int kMostSteps = 60;
constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;
// A step that lowers chi2 by less than this share of it, and of 1, is the last.
constexpr double kLeastDecrease = 1e-6;

}  // namespace

bool ContactDescent::Evaluate(const Eigen::VectorXd& measured,
                              const Eigen::VectorXd& weights,
                              const std::vector<PointContact>& contacts) {
  ++iterations_;
  if (!solver_->SolveWithSensitivities(contacts)) return false;
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  const Eigen::Index gauges = solver_->model().gauges();
  residual_ = -measured;
  slope_.resize(measured.size(), unknowns);
  residual_.head(gauges) += solver_->outputs().head(gauges);
  slope_.topRows(gauges) = solver_->d_outputs().topLeftCorner(gauges, unknowns);
  if (circle_radius_mm_) {
    const Eigen::Vector3d pose = solver_->contact_pose(0);
    residual_.tail<2>() += CircleCentre(pose, *circle_radius_mm_);
    slope_.bottomRows<2>() =
        solver_->d_outputs().block(gauges, 0, 2, unknowns) +
        CircleCentreByAngle(pose[2], *circle_radius_mm_) *
            solver_->d_outputs().block(gauges + 2, 0, 1, unknowns);
  }
  residual_.array() *= weights.array();
  slope_.array().colwise() *= weights.array();
  chi2_ = residual_.squaredNorm();
  return std::isfinite(chi2_);
}

bool ContactDescent::Descend(const LadderState& state,
                             const Eigen::VectorXd& measured,
                             const Eigen::VectorXd& weights,
                             std::vector<PointContact>* contacts) {
  iterations_ = 0;
  solver_->set_state(state);
  if (!Evaluate(measured, weights, *contacts)) return false;
  const double length = solver_->model().finger().front_length_mm;
  const double force = ForceUnit(solver_->model().finger());
  double damping = 1e-3, growth = 2;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    const Eigen::MatrixXd normal = slope_.transpose() * slope_;
    const Eigen::VectorXd gradient = slope_.transpose() * residual_;
    Eigen::MatrixXd damped = normal;
    for (Eigen::Index k = 0; k < normal.rows(); ++k) {
      const double unit = k % 2 == 0 ? length : force;
      damped(k, k) += damping * normal(k, k) + kLeastDamping / (unit * unit);
    }
    const Eigen::VectorXd change = damped.ldlt().solve(-gradient);
    std::vector<PointContact> trial = *contacts;
    for (std::size_t c = 0; c < trial.size(); ++c) {
      const auto k = static_cast<Eigen::Index>(2 * c);
      trial[c].arc_mm = std::clamp(
          trial[c].arc_mm + std::clamp(change[k], -0.1 * length, 0.1 * length),
          0.0, length);
      trial[c].normal_N = std::clamp(trial[c].normal_N + change[k + 1],
                                     0.3 * trial[c].normal_N, most_force_N_);
    }
    const double before = chi2_;
    const Eigen::VectorXd residual = residual_;
    const Eigen::MatrixXd slope = slope_;
    const LadderState at = solver_->state();
    if (Evaluate(measured, weights, trial) && chi2_ < before) {
      *contacts = trial;
      damping = std::max(kLeastDamping, damping / 5);
      growth = 2;
      if (before - chi2_ < kLeastDecrease * std::min(1.0, before)) break;
      continue;
    }
    solver_->set_state(at);
    residual_ = residual;
    slope_ = slope;
    chi2_ = before;
    damping *= growth;
    growth *= 2;
  }
  // The last trial may have been in vain.
  return Evaluate(measured, weights, *contacts);
}

}  // namespace finray

#include "finray/sensing/contact_descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

constexpr int kMostSteps = 60;
constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;
// A step that lowers chi2 by less than this share of it, and of 1, is the last.
constexpr double kLeastDecrease = 1e-6;
// A step at most: of l_0, and down to this share of a force.
constexpr double kLongestMove = 0.1, kLeastShare = 0.3;

}  // namespace

std::vector<PointContact> ContactDescent::Trial(
    const std::vector<PointContact>& contacts, double damping) const {
  const double length = solver_->model().finger().front_length_mm;
  const double force = ForceUnit(solver_->model().finger());
  ContactMatrix damped = at_.information();
  for (Eigen::Index k = 0; k < damped.rows(); ++k) {
    const double unit = k % 2 == 0 ? length : force;
    damped(k, k) += damping * damped(k, k) + kLeastDamping / (unit * unit);
  }
  const Eigen::VectorXd change =
      damped.ldlt().solve(-at_.slope.transpose() * at_.residual);
  std::vector<PointContact> trial = contacts;
  for (std::size_t c = 0; c < trial.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(2 * c);
    const double most = kLongestMove * length;
    trial[c].arc_mm = std::clamp(
        trial[c].arc_mm + std::clamp(change[k], -most, most), 0.0, length);
    trial[c].normal_N =
        std::clamp(trial[c].normal_N + change[k + 1],
                   kLeastShare * trial[c].normal_N, most_force_N_);
  }
  return trial;
}

bool ContactDescent::Descend(const LadderState& state,
                             const PackedReadings& measurement,
                             std::vector<PointContact>* contacts) {
  const auto linearize = [&](const std::vector<PointContact>& at) {
    ++iterations_;
    return at_.At(at, measurement, circle_radius_mm_, solver_);
  };
  iterations_ = 0;
  solver_->set_state(state);
  if (!linearize(*contacts)) return false;
  double damping = 1e-3, growth = 2;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    const std::vector<PointContact> trial = Trial(*contacts, damping);
    const ContactLinearization before = at_;
    const LadderState state_before = solver_->state();
    const double chi2 = before.chi2();
    if (linearize(trial) && at_.chi2() < chi2) {
      *contacts = trial;
      damping = std::max(kLeastDamping, damping / 5);
      growth = 2;
      if (chi2 - at_.chi2() < kLeastDecrease * std::min(1.0, chi2)) break;
      continue;
    }
    solver_->set_state(state_before);
    at_ = before;
    damping *= growth;
    growth *= 2;
  }
  // The last trial may have been in vain, and the solver's results its own.
  return linearize(*contacts);
}

}  // namespace finray

#include "finray/sensing/frame_estimator.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "finray/io/error.h"

namespace finray {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// A second start is only worth its time while the best leaves more than this
// many standard deviations per gauge unexplained.
constexpr double kWellExplained = 4;
constexpr int kMostStarts = 3;

}  // namespace

FrameEstimator::FrameEstimator(const Finger& finger, const Scene& scene,
                               const Discretization& discretization)
    : finger_(finger),
      scene_(scene),
      solver_(finger, discretization),
      table_(&solver_),
      fit_(finger, discretization),
      contacts_(1) {
  RefuseBackContacts(scene);
  if (scene.contacts.value_or(1) > 1) {
    throw InputError("scene: " + std::to_string(*scene.contacts) +
                     " contacts cannot be estimated; 0, 1 and auto can");
  }
  if (finger.gauges.empty()) {
    throw InputError("finger '" + finger.name +
                     "' has no gauges to estimate from");
  }
  free_.status = FrameStatus::kNoContact;
  fit_.set_most_force(kMostForce * table_.heaviest_N());
  solver_.Solve({});
  free_.contact[0].normal_N = 0;
  free_.tip_pose = solver_.tip_pose();
  for (int i = 0; i < solver_.model().ribs(); ++i) {
    free_.rib_tension_N.push_back(solver_.rib_tension(i));
  }
}

FrameEstimate FrameEstimator::Estimate(const FrameReadings& readings) {
  const std::vector<double>& readings_V = readings.gauges_V;
  const int gauges = static_cast<int>(finger_.gauges.size());
  Eigen::VectorXd angles(gauges), weights(gauges);
  int measured = 0;
  for (int j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger_.gauges[j];
    const bool has = std::isfinite(readings_V[j]);
    measured += has;
    angles[j] =
        has ? (readings_V[j] - gauge.offset_V) / gauge.gain_V_per_rad : 0;
    weights[j] = has ? std::abs(gauge.gain_V_per_rad) / gauge.noise_V : 0;
  }
  const double free_chi2 =
      (angles - table_.free_angles()).cwiseProduct(weights).squaredNorm();
  const int unknowns = scene_.contacts == 0 ? 0 : 2;
  if (measured < std::max(unknowns, 1)) {
    FrameEstimate estimate = FreeEstimate(kNaN, 0);
    estimate.status = FrameStatus::kBadInput;
    estimate.contact[0].normal_N = kNaN;
    estimate.tip_pose.setConstant(kNaN);
    estimate.rib_tension_N.assign(free_.rib_tension_N.size(), kNaN);
    return estimate;
  }
  if (scene_.contacts == 0) return FreeEstimate(free_chi2, measured);

  table_.FindStarts(angles, weights, &starts_);
  FrameEstimate best = FreeEstimate(kNaN, 0);
  best.status = FrameStatus::kNotConverged;
  best.contact[0].normal_N = kNaN;
  int iterations = 0;
  if (starts_.size() > kMostStarts) starts_.resize(kMostStarts);
  for (const GaugeTable::Start& start : starts_) {
    const FrameEstimate estimate = FitFrom(start, angles, weights);
    iterations += estimate.iterations;
    if (estimate.status == FrameStatus::kNotConverged) continue;
    if (std::isnan(best.chi2) || estimate.chi2 < best.chi2) best = estimate;
    if (best.chi2 < kWellExplained * measured) break;
  }
  best.iterations = iterations;
  best.dof = measured - unknowns;
  const bool free =
      scene_.contacts ? best.contact[0].normal_N < kLeastForce_N
                      : free_chi2 - best.chi2 < kSignificance;  // false for NaN
  return free ? FreeEstimate(free_chi2, measured) : best;
}

FrameEstimate FrameEstimator::FreeEstimate(double chi2, int dof) const {
  FrameEstimate estimate = free_;
  estimate.chi2 = chi2;
  estimate.dof = dof;
  return estimate;
}

FrameEstimate FrameEstimator::FitFrom(const GaugeTable::Start& start,
                                      const Eigen::VectorXd& angles_rad,
                                      const Eigen::VectorXd& weight_per_rad) {
  PointContact& contact = contacts_[0];
  contact = {start.arc_mm, start.normal_N, scene_.friction_coefficient};
  fit_.set_state(*start.state);
  FrameEstimate estimate = free_;
  const bool converged = fit_.Fit(angles_rad, weight_per_rad, &contacts_);
  estimate.iterations = fit_.iterations();
  estimate.status = FrameStatus::kNotConverged;
  if (!converged) return estimate;

  ContactEstimate& found = estimate.contact[0];
  estimate.contacts = 1;
  found.arc_mm = contact.arc_mm;
  found.normal_N = contact.normal_N;
  found.pose = fit_.contact_pose(0);
  estimate.tip_pose = fit_.tip_pose();
  for (std::size_t i = 0; i < estimate.rib_tension_N.size(); ++i) {
    estimate.rib_tension_N[i] = fit_.rib_tension(static_cast<int>(i));
  }
  estimate.chi2 = fit_.chi2();
  Eigen::Matrix2d information = fit_.information();
  const double length = finger_.front_length_mm;
  // In units of l_0 and f_c, so that "singular" has a meaning.
  const Eigen::Vector2d unit(length, std::max(contact.normal_N, kLeastForce_N));
  information = (unit.asDiagonal() * information * unit.asDiagonal()).eval();
  const double determinant = information.determinant();
  const bool singular =
      !(determinant > 1e-14 * information(0, 0) * information(1, 1));
  const double infinity = std::numeric_limits<double>::infinity();
  found.arc_std_mm =
      singular ? infinity : length * std::sqrt(information(1, 1) / determinant);
  found.normal_std_N =
      singular ? infinity
               : unit[1] * std::sqrt(information(0, 0) / determinant);
  const bool on_bound = contact.arc_mm <= 0 || contact.arc_mm >= length ||
                        contact.normal_N >= kMostForce * table_.heaviest_N();
  const bool determined =
      found.arc_std_mm <= kLargestArcStd * length &&
      found.normal_std_N <= kLargestForceStd * contact.normal_N && !on_bound;
  estimate.status = determined ? FrameStatus::kOk : FrameStatus::kUnobservable;
  return estimate;
}

}  // namespace finray

#include "finray/sensing/frame_estimator.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "finray/io/error.h"
#include "finray/residuals/gauge_reading_residual.h"

namespace finray {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// A second start is only worth its time while the best leaves more than this
// many standard deviations per gauge unexplained.
constexpr double kWellExplained = 4;
constexpr int kMostStarts = 3;

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 30;
  // Whitened gauges leave the trust region nothing to guess: begin with
  // Gauss-Newton. The tolerances are those of noise-free data.
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-12;
  return options;
}

}  // namespace

const char* StatusName(FrameStatus status) {
  switch (status) {
    case FrameStatus::kOk:
      return "ok";
    case FrameStatus::kNoContact:
      return "no_contact";
    case FrameStatus::kUnobservable:
      return "unobservable";
    case FrameStatus::kNotConverged:
      return "not_converged";
    case FrameStatus::kBadInput:
      return "bad_input";
  }
  return "";
}

FrameEstimator::FrameEstimator(const Finger& finger, const Scene& scene,
                               const Discretization& discretization)
    : finger_(finger),
      scene_(scene),
      solver_(finger, discretization),
      table_(&solver_),
      shared_(SharedParameters::Of(finger)) {
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
  solver_.Solve({});
  free_.contact_mm = free_.contact_std_mm = kNaN;
  free_.normal_N = 0;
  free_.normal_std_N = kNaN;
  free_.contact_pose.setConstant(kNaN);
  free_.tip_pose = solver_.tip_pose();
  for (int i = 0; i < solver_.model().ribs(); ++i) {
    free_.rib_tension_N.push_back(solver_.rib_tension(i));
  }

  const std::size_t gauges = finger.gauges.size();
  readings_V_.assign(gauges, kNaN);
  for (const Gauge& gauge : finger.gauges) {
    gains_.push_back(gauge.gain_V_per_rad);
    offsets_.push_back(gauge.offset_V);
  }
  frames_ = std::make_unique<FrameSet>(finger, discretization,
                                       EquilibriumForm::kReduced, &shared_, 1);
  FrameEvaluation& frame =
      frames_->Add(1, scene.friction_coefficient, contact_);
  ceres::Problem::Options options;
  options.evaluation_callback = frames_.get();
  problem_ = std::make_unique<ceres::Problem>(options);
  for (std::size_t j = 0; j < gauges; ++j) {
    std::vector<double*> blocks = FrameParameterBlocks(
        frame, contact_, &shared_.ln_front_stiffness,
        &shared_.ln_back_stiffness, shared_.rib_lengths_mm.data());
    blocks.push_back(&gains_[j]);
    blocks.push_back(&offsets_[j]);
    problem_->AddResidualBlock(
        GaugeReadingResidual::Create(&frame, static_cast<int>(j),
                                     &readings_V_[j], finger.gauges[j].noise_V),
        nullptr, blocks);
  }
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) {
    if (block != contact_) problem_->SetParameterBlockConstant(block);
  }
  problem_->SetParameterLowerBound(contact_, 0, 0);
  problem_->SetParameterUpperBound(contact_, 0, finger.front_length_mm);
  problem_->SetParameterLowerBound(contact_, 1, 0);
  problem_->SetParameterUpperBound(contact_, 1,
                                   kMostForce * table_.heaviest_N());
}

FrameEstimate FrameEstimator::Estimate(const std::vector<double>& readings_V) {
  readings_V_ = readings_V;
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
    FrameEstimate estimate = FreeEstimate(kNaN);
    estimate.status = FrameStatus::kBadInput;
    estimate.normal_N = kNaN;
    estimate.tip_pose.setConstant(kNaN);
    estimate.rib_tension_N.assign(free_.rib_tension_N.size(), kNaN);
    return estimate;
  }
  if (scene_.contacts == 0) return FreeEstimate(free_chi2);

  table_.FindStarts(angles, weights, &starts_);
  FrameEstimate best = FreeEstimate(kNaN);
  best.status = FrameStatus::kNotConverged;
  best.normal_N = kNaN;
  int iterations = 0;
  if (starts_.size() > kMostStarts) starts_.resize(kMostStarts);
  for (const GaugeTable::Start& start : starts_) {
    const FrameEstimate estimate = ContactEstimate(start);
    iterations += estimate.iterations;
    if (estimate.status == FrameStatus::kNotConverged) continue;
    if (std::isnan(best.chi2) || estimate.chi2 < best.chi2) best = estimate;
    if (best.chi2 < kWellExplained * measured) break;
  }
  best.iterations = iterations;
  const bool free =
      scene_.contacts ? best.normal_N < kLeastForce_N
                      : free_chi2 - best.chi2 < kSignificance;  // false for NaN
  return free ? FreeEstimate(free_chi2) : best;
}

FrameEstimate FrameEstimator::FreeEstimate(double chi2) const {
  FrameEstimate estimate = free_;
  estimate.chi2 = chi2;
  return estimate;
}

FrameEstimate FrameEstimator::ContactEstimate(const GaugeTable::Start& start) {
  contact_[0] = start.arc_mm;
  contact_[1] = start.normal_N;
  FrameEvaluation& frame = (*frames_)[0];
  frame.set_state(*start.state);
  static const ceres::Solver::Options options = SolverOptions();
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);

  FrameEstimate estimate = free_;
  estimate.iterations = static_cast<int>(summary.iterations.size());
  estimate.status = FrameStatus::kNotConverged;
  if (!summary.IsSolutionUsable()) return estimate;
  frames_->PrepareForEvaluation(true, true);
  if (!frame.valid()) return estimate;

  estimate.contact_mm = contact_[0];
  estimate.normal_N = contact_[1];
  const int row = frame.contact_row(0);
  estimate.contact_pose = frame.outputs().segment<3>(row);
  estimate.tip_pose = frame.outputs().tail<3>();
  for (int i = 0; i < frame.ribs(); ++i) {
    estimate.rib_tension_N[i] = frame.state().q[6 + i];
  }
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  estimate.chi2 = 0;
  for (int j = 0; j < frame.gauges(); ++j) {
    if (!std::isfinite(readings_V_[j])) continue;
    const double weight = 1 / finger_.gauges[j].noise_V;
    const double residual = weight * (gains_[j] * frame.outputs()[j] +
                                      offsets_[j] - readings_V_[j]);
    const Eigen::RowVector2d slope =
        weight * gains_[j] * frame.d_outputs().row(j).head<2>();
    information += slope.transpose() * slope;
    estimate.chi2 += residual * residual;
  }
  const double length = finger_.front_length_mm;
  // In units of l_0 and f_c, so that "singular" has a meaning.
  const Eigen::Vector2d unit(length, std::max(contact_[1], kLeastForce_N));
  information = (unit.asDiagonal() * information * unit.asDiagonal()).eval();
  const double determinant = information.determinant();
  const bool singular =
      !(determinant > 1e-14 * information(0, 0) * information(1, 1));
  const double infinity = std::numeric_limits<double>::infinity();
  estimate.contact_std_mm =
      singular ? infinity : length * std::sqrt(information(1, 1) / determinant);
  estimate.normal_std_N =
      singular ? infinity
               : unit[1] * std::sqrt(information(0, 0) / determinant);
  const bool on_bound = contact_[0] <= 0 || contact_[0] >= length ||
                        contact_[1] >= kMostForce * table_.heaviest_N();
  const bool determined =
      estimate.contact_std_mm <= kLargestArcStd * length &&
      estimate.normal_std_N <= kLargestForceStd * contact_[1] && !on_bound;
  estimate.status = determined ? FrameStatus::kOk : FrameStatus::kUnobservable;
  return estimate;
}

}  // namespace finray

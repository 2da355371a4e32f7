#include "finray/perception/outline_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "finray/perception/beam_bounds.h"
#include "finray/perception/outline_cost.h"

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kClosureStd_mm = 1e-4;
constexpr double kHuberScale = 3;
// Rounds in which weights, bounds and lambda follow the outline.
constexpr int kRounds = 3;
// log10 of lambda: the first round's grid, then steps about the best.
constexpr double kLeastPower = -7, kMostPower = 6;
constexpr double kFirstStep = 1, kLaterStep = 0.25;
// Touches do not agree better than this share of what they claim.
constexpr double kLeastScale = 1e-3;
constexpr double kSmallestRadius_mm = 1e-6, kLargestRadius_mm = 1e6;

// Circle through the tangents: h_i = centre . n_i + radius.
ConvexCurve Circle(const std::vector<Touch>& touches, Index cells) {
  MatrixXd rows(static_cast<Index>(touches.size()), 3);
  VectorXd support(rows.rows());
  for (Index i = 0; i < rows.rows(); ++i) {
    const Vector2d normal = touches[i].Normal();
    rows.row(i) << normal.x(), normal.y(), 1;
    support[i] = normal.dot(touches[i].point_mm);
  }
  const Eigen::Vector3d found =
      (rows.transpose() * rows).ldlt().solve(rows.transpose() * support);
  const double radius = std::max(found[2], 1e-3);
  return {found.head<2>() + Vector2d(radius, 0),
          VectorXd::Constant(cells, radius)};
}

// Whitening of point - r(normal angle), the point's error and what the angle's
// moves r by.
Matrix2d Whitening(const Touch& touch, const ConvexCurve& curve,
                   double stage_std_mm) {
  const double cell = 2 * M_PI / static_cast<double>(curve.cells());
  const double reach = std::max(2 * std::sqrt(touch.covariance(2, 2)), cell);
  const Vector2d normal = touch.Normal();
  Eigen::Matrix<double, 2, 3> slope;
  slope.leftCols<2>().setIdentity();
  slope.col(2) = -curve.MeanRadius(touch.normal_angle_rad, reach) *
                 Vector2d(-normal.y(), normal.x());
  Matrix2d covariance = slope * touch.covariance * slope.transpose();
  covariance.diagonal().array() += stage_std_mm * stage_std_mm;
  return covariance.llt().matrixL().solve(Matrix2d::Identity());
}

// The problem at given weights and bounds.
class Fit {
 public:
  Fit(const std::vector<Touch>& touches, const ConvexCurve& about,
      const OutlineFitSettings& settings)
      : cells_(about.cells()) {
    for (const Touch& touch : touches) {
      costs_.push_back(std::make_unique<OutlinePointCost>(
          touch.point_mm, touch.normal_angle_rad,
          Whitening(touch, about, settings.stage_std_mm), false, cells_));
    }
    touches_ = costs_.size();
    for (const BeamBound& bound :
         FindBeamBounds(touches, about, settings.stage_std_mm,
                        settings.beam_reach_mm)) {
      costs_.push_back(std::make_unique<OutlinePointCost>(
          bound.beam_point_mm, bound.normal_angle_rad,
          bound.beam_normal.transpose() / bound.std_mm, true, cells_));
    }
    Take(about);
  }

  void Take(const ConvexCurve& curve) {
    u_ = curve.radii_mm().array().log();
    start_ = curve.start_mm();
  }
  ConvexCurve curve() const { return {start_, u_.array().exp()}; }

  // False if Ceres finds no minimum.
  bool Solve(double lambda) {
    ceres::Problem problem = MakeProblem(lambda);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-9;
    options.parameter_tolerance = 1e-9;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    cost_ = 2 * summary.final_cost;
    return summary.IsSolutionUsable();
  }

  // The criterion that lambda minimises, at the last solution.
  double Improbability(double lambda) const {
    const double n = 2 * static_cast<double>(touches_);
    const MatrixXd information = Information(lambda);
    const Eigen::LLT<MatrixXd> factor(information);
    const double log_det =
        2 * factor.matrixLLT().diagonal().array().log().sum();
    if (factor.info() != Eigen::Success || !std::isfinite(log_det)) {
      return std::numeric_limits<double>::infinity();
    }
    return n * std::log(noise_scale() * noise_scale()) + log_det -
           static_cast<double>(cells_ - 1) * std::log(lambda);
  }

  double noise_scale() const {
    return std::max(kLeastScale,
                    std::sqrt(cost_ / (2 * static_cast<double>(touches_))));
  }

  // Of u and the start: J'J of everything, touches weighted by their loss.
  MatrixXd Information(double lambda) const {
    MatrixXd information = MatrixXd::Zero(cells_ + 2, cells_ + 2);
    for (const auto& cost : costs_) {
      const Linear linear = Linearize(*cost);
      const double squared = linear.residual.squaredNorm();
      const double weight = squared > kHuberScale * kHuberScale
                                ? kHuberScale / std::sqrt(squared)
                                : 1;
      information.noalias() +=
          weight * linear.slope.transpose() * linear.slope;
    }
    const double cell = 2 * M_PI / static_cast<double>(cells_);
    for (Index j = 0; j < cells_; ++j) {
      const Index next = (j + 1) % cells_;
      information(j, j) += lambda / cell;
      information(next, next) += lambda / cell;
      information(j, next) -= lambda / cell;
      information(next, j) -= lambda / cell;
    }
    const ConvexCurve::PointSlope closure =
        ConvexCurve::SlopeAt(std::nextafter(2 * M_PI, 0), cells_) *
        u_.array().exp().matrix().asDiagonal() / kClosureStd_mm;
    information.topLeftCorner(cells_, cells_) += closure.transpose() * closure;
    return information;
  }

  std::vector<double> Distances() const {
    std::vector<double> distances;
    for (std::size_t i = 0; i < touches_; ++i) {
      distances.push_back(Linearize(*costs_[i]).residual.norm());
    }
    return distances;
  }

  int ActiveBounds() const {
    int active = 0;
    for (std::size_t i = touches_; i < costs_.size(); ++i) {
      active += Linearize(*costs_[i]).residual[0] != 0;
    }
    return active;
  }

 private:
  struct Linear {
    VectorXd residual;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
        slope;
  };

  ceres::Problem MakeProblem(double lambda) {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(options);
    problem.AddParameterBlock(u_.data(), static_cast<int>(cells_));
    problem.AddParameterBlock(start_.data(), 2);
    for (const auto& cost : costs_) {
      problem.AddResidualBlock(cost.get(), new ceres::HuberLoss(kHuberScale),
                               u_.data(), start_.data());
    }
    roughness_ = std::make_unique<OutlineRoughnessCost>(cells_);
    closure_ = std::make_unique<OutlineClosureCost>(cells_, kClosureStd_mm);
    problem.AddResidualBlock(
        roughness_.get(),
        new ceres::ScaledLoss(nullptr, lambda, ceres::TAKE_OWNERSHIP),
        u_.data());
    problem.AddResidualBlock(closure_.get(), nullptr, u_.data());
    for (int j = 0; j < cells_; ++j) {
      problem.SetParameterLowerBound(u_.data(), j,
                                     std::log(kSmallestRadius_mm));
      problem.SetParameterUpperBound(u_.data(), j,
                                     std::log(kLargestRadius_mm));
    }
    return problem;
  }

  Linear Linearize(const OutlinePointCost& cost) const {
    const Index rows = cost.num_residuals();
    Linear linear{VectorXd(rows), {}};
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_u(
        rows, cells_),
        by_start(rows, 2);
    const double* parameters[] = {u_.data(), start_.data()};
    double* jacobians[] = {by_u.data(), by_start.data()};
    cost.Evaluate(parameters, linear.residual.data(), jacobians);
    linear.slope.resize(rows, cells_ + 2);
    linear.slope << by_u, by_start;
    return linear;
  }

  Index cells_;
  std::size_t touches_ = 0;
  std::vector<std::unique_ptr<OutlinePointCost>> costs_;  // touches, bounds
  std::unique_ptr<OutlineRoughnessCost> roughness_;
  std::unique_ptr<OutlineClosureCost> closure_;
  VectorXd u_;
  Vector2d start_;
  double cost_ = 0;
};

// Goes through lambda from smooth to rough and leaves the fit at the best.
double BestLambda(double from_power, double to_power, double step, Fit* fit) {
  const ConvexCurve start = fit->curve();
  double best = std::numeric_limits<double>::infinity(), best_lambda = 0;
  ConvexCurve best_curve = start;
  for (double power = to_power; power >= from_power - 1e-9; power -= step) {
    const double lambda = std::pow(10, power);
    if (!fit->Solve(lambda)) {
      fit->Take(start);
      continue;
    }
    const double improbability = fit->Improbability(lambda);
    if (improbability < best) {
      best = improbability;
      best_lambda = lambda;
      best_curve = fit->curve();
    }
  }
  if (best_lambda == 0) {
    throw std::runtime_error("no outline fits the touches");
  }
  fit->Take(best_curve);
  fit->Solve(best_lambda);
  return best_lambda;
}

}  // namespace

double OutlineFit::NormalStd(double normal_angle_rad) const {
  const Index cells = curve.cells();
  const Vector2d normal(std::cos(normal_angle_rad),
                        std::sin(normal_angle_rad));
  VectorXd slope(cells + 2);
  slope.head(cells) =
      (normal.transpose() * ConvexCurve::SlopeAt(normal_angle_rad, cells) *
       curve.radii_mm().asDiagonal())
          .transpose();
  slope.tail<2>() = normal;
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
}

OutlineFit FitOutline(const std::vector<Touch>& touches,
                      const OutlineFitSettings& settings) {
  if (touches.size() < 3) {
    throw std::invalid_argument("an outline needs three touches");
  }
  OutlineFit result;
  result.curve = Circle(touches, settings.cells);
  for (int round = 0; round < kRounds; ++round) {
    Fit fit(touches, result.curve, settings);
    if (round == 0) {
      result.smoothing = BestLambda(kLeastPower, kMostPower, kFirstStep, &fit);
    } else {
      const double power = std::log10(result.smoothing);
      const double reach = round == 1 ? kFirstStep : 2 * kLaterStep;
      result.smoothing =
          BestLambda(power - reach, power + reach, kLaterStep, &fit);
    }
    result.curve = fit.curve();
    if (round + 1 < kRounds) continue;
    result.noise_scale = fit.noise_scale();
    result.distances = fit.Distances();
    result.beam_bounds = fit.ActiveBounds();
    const double scale = std::max(1.0, result.noise_scale);
    const MatrixXd information = fit.Information(result.smoothing);
    result.covariance =
        scale * scale *
        information.llt().solve(
            MatrixXd::Identity(information.rows(), information.cols()));
  }
  return result;
}

OutlineFit RefitOutline(const std::vector<Touch>& touches,
                        const OutlineFit& start,
                        const OutlineFitSettings& settings) {
  Fit fit(touches, start.curve, settings);
  if (!fit.Solve(start.smoothing)) {
    throw std::runtime_error("no outline fits the touches of a varied finger");
  }
  OutlineFit result;
  result.curve = fit.curve();
  result.smoothing = start.smoothing;
  result.noise_scale = fit.noise_scale();
  result.distances = fit.Distances();
  return result;
}

}  // namespace finray

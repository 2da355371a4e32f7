#include "finray/perception/outline_fit.h"

#include <ceres/normal_prior.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// A beam bounds the outline within this distance of its contact.
constexpr double kBeamReach_mm = 140;
// Far smaller than the error of a touch.
constexpr double kClosureStd_mm = 5e-3;
constexpr double kHuberScale = 3;
constexpr double kEdgeLengthStd = 3;  // of its logarithm
// The radius of curvature is averaged over this angle at least.
constexpr double kLeastReach_rad = 0.026;
// Rounds in which weights, bounds and lambda follow the outline.
constexpr int kSmoothRounds = 2, kLastRounds = 2;
// log10 of lambda: the grid of the first rounds, then steps about the best.
constexpr double kLeastPower = -4, kMostPower = 5;
constexpr double kFirstStep = 1, kLaterStep = 0.25;
// Lower limit of the noise scale.
constexpr double kLeastScale = 0.1;

// The circle that fits the tangents best: h_i = centre . n_i + radius.
ConvexCurve Circle(const std::vector<Touch>& touches, const NormalGrid& grid) {
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
  return {grid, found.head<2>() + Vector2d(radius, 0),  // at the normal angle 0
          VectorXd::Constant(grid.cells(), radius)};
}

// Whitening of point - r(normal angle). The error of the angle counts by how
// far it moves r.
Matrix2d Whitening(const Touch& touch, const ConvexCurve& curve,
                   double stage_std_mm) {
  const double reach =
      std::max(2 * std::sqrt(touch.covariance(2, 2)), kLeastReach_rad);
  const Vector2d normal = touch.Normal();
  Eigen::Matrix<double, 2, 3> slope;
  slope.leftCols<2>().setIdentity();
  slope.col(2) = -curve.MeanRadius(touch.normal_angle_rad, reach) *
                 Vector2d(-normal.y(), normal.x());
  Matrix2d covariance = slope * touch.covariance * slope.transpose();
  covariance.diagonal().array() += stage_std_mm * stage_std_mm;
  return covariance.llt().matrixL().solve(Matrix2d::Identity());
}

// The fit with fixed weights and bounds.
class Fit {
 public:
  // Leaves out each touch i with along[i], which lies along an edge. Beams
  // bound the points of `bounded`, or none if it is null.
  Fit(const std::vector<Touch>& touches, const std::vector<bool>& along,
      const ConvexCurve& about, const ConvexCurve* bounded, double stage_std_mm)
      : grid_(about.grid()),
        cells_(grid_.cells()),
        along_(along),
        roughness_(RoughnessMatrix(grid_)),
        closure_(grid_, kClosureStd_mm) {
    for (std::size_t i = 0; i < touches.size(); ++i) {
      if (along[i]) continue;
      costs_.emplace_back(touches[i].point_mm, touches[i].normal_angle_rad,
                          Whitening(touches[i], about, stage_std_mm), false,
                          grid_);
    }
    touches_ = costs_.size();
    Take(about);
    if (bounded == nullptr) return;
    for (const BeamBound& bound :
         FindBeamBounds(touches, *bounded, stage_std_mm, kBeamReach_mm)) {
      costs_.emplace_back(bound.beam_point_mm, bound.normal_angle_rad,
                          bound.beam_normal.transpose() / bound.std_mm, true,
                          grid_);
    }
  }

  void Take(const ConvexCurve& curve) {
    x_.resize(cells_ + 2);
    x_ << curve.radii_mm().array().log().matrix(), curve.start_mm();
  }
  ConvexCurve curve() const {
    return {grid_, x_.tail<2>(), x_.head(cells_).array().exp()};
  }

  // Returns false if Ceres finds no minimum.
  bool Solve(double lambda) {
    MatrixXd by_x = MatrixXd::Zero(roughness_.rows(), cells_ + 2);
    by_x.leftCols(cells_) = roughness_;
    ceres::NormalPrior roughness(by_x, VectorXd::Zero(cells_ + 2));
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    for (OutlineCost& cost : costs_) {
      problem.AddResidualBlock(&cost, new ceres::HuberLoss(kHuberScale),
                               x_.data());
    }
    problem.AddResidualBlock(
        &roughness,
        new ceres::ScaledLoss(nullptr, lambda, ceres::TAKE_OWNERSHIP),
        x_.data());
    problem.AddResidualBlock(&closure_, nullptr, x_.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 40;
    options.function_tolerance = 1e-5;
    options.parameter_tolerance = 1e-8;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    cost_ = 2 * summary.final_cost;
    return summary.IsSolutionUsable();
  }

  // The criterion that chooses lambda, at the last solution.
  double Improbability(double lambda) const {
    const double n = 2 * static_cast<double>(touches_);
    const Eigen::LLT<MatrixXd> factor(Information(lambda));
    const double log_det =
        2 * factor.matrixLLT().diagonal().array().log().sum();
    if (factor.info() != Eigen::Success || !std::isfinite(log_det)) {
      return std::numeric_limits<double>::infinity();
    }
    return n * std::log(noise_scale() * noise_scale()) + log_det -
           LogDeterminantOfRoughness(lambda) +
           2 * edges() * std::log(kEdgeLengthStd);
  }

  // The null space, which has no part in it, is the level of the outline and
  // that of each edge.
  double LogDeterminantOfRoughness(double lambda) const {
    MatrixXd roughness = roughness_.transpose() * roughness_;
    VectorXd level = VectorXd::Zero(cells_);
    for (Index j = 0; j < cells_; ++j) {
      if (!grid_.IsEdge(j)) {
        level[j] = 1;
      } else if (!grid_.IsEdge(j - 1)) {
        roughness.block<NormalGrid::kEdgeCells, NormalGrid::kEdgeCells>(j, j)
            .array() += 1.0 / NormalGrid::kEdgeCells;
      }
    }
    roughness += level * level.transpose() / level.squaredNorm();
    const double rank = static_cast<double>(cells_) - 1 - edges();
    return rank * std::log(lambda) +
           2 * roughness.llt().matrixLLT().diagonal().array().log().sum();
  }

  int edges() const {
    int cells = 0;
    for (Index j = 0; j < cells_; ++j) cells += grid_.IsEdge(j);
    return cells / NormalGrid::kEdgeCells;
  }

  double noise_scale() const {
    return std::max(kLeastScale,
                    std::sqrt(cost_ / (2 * static_cast<double>(touches_))));
  }

  // J'J for u and start. Huber's loss weighs the touches.
  MatrixXd Information(double lambda) const {
    MatrixXd information = MatrixXd::Zero(cells_ + 2, cells_ + 2);
    information.topLeftCorner(cells_, cells_) =
        lambda * roughness_.transpose() * roughness_;
    Slope slope;
    Linearize(closure_, &slope);
    information += slope.transpose() * slope;
    for (const OutlineCost& cost : costs_) {
      const double distance = Linearize(cost, &slope);
      const double weight = kHuberScale / std::max(kHuberScale, distance);
      information.noalias() += weight * slope.transpose() * slope;
    }
    return information;
  }

  std::vector<double> Distances() const {
    std::vector<double> distances;
    auto next = costs_.begin();
    for (const bool along : along_) {
      distances.push_back(along ? std::nan("") : Linearize(*next++));
    }
    return distances;
  }

  int ActiveBounds() const {
    return static_cast<int>(std::count_if(
        costs_.begin() + static_cast<std::ptrdiff_t>(touches_), costs_.end(),
        [this](const OutlineCost& cost) { return Linearize(cost) != 0; }));
  }

 private:
  using Slope =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // Returns the length of the residual.
  double Linearize(const OutlineCost& cost, Slope* slope = nullptr) const {
    VectorXd residual(cost.num_residuals());
    const double* parameters[] = {x_.data()};
    double* jacobians[] = {nullptr};
    if (slope != nullptr) {
      slope->resize(residual.size(), x_.size());
      jacobians[0] = slope->data();
    }
    cost.Evaluate(parameters, residual.data(), jacobians);
    return residual.norm();
  }

  NormalGrid grid_;
  Index cells_;
  std::vector<bool> along_;
  std::size_t touches_ = 0;
  std::deque<OutlineCost> costs_;  // touches, then bounds
  MatrixXd roughness_;
  OutlineCost closure_;
  VectorXd x_;  // u and start
  double cost_ = 0;
};

// Tries values of lambda, from smooth to rough, and leaves the fit at the best.
struct Best {
  double lambda, improbability;
};
Best BestLambda(double from_power, double to_power, double step, Fit* fit) {
  const ConvexCurve start = fit->curve();
  Best best{0, std::numeric_limits<double>::infinity()};
  ConvexCurve best_curve = start;
  for (double power = to_power; power >= from_power - 1e-9; power -= step) {
    const double lambda = std::pow(10, power);
    if (!fit->Solve(lambda)) {
      fit->Take(start);
      continue;
    }
    const double improbability = fit->Improbability(lambda);
    if (improbability < best.improbability) {
      best = {lambda, improbability};
      best_curve = fit->curve();
    }
  }
  if (best.lambda == 0) {
    throw std::runtime_error("no outline fits the touches");
  }
  fit->Take(best_curve);
  fit->Solve(best.lambda);
  return best;
}

// Turns flat stretches into straight edges if the touches away from them are
// then more probable than with a smooth outline.
void TakeEdges(const std::vector<Touch>& touches, double stage_std_mm,
               OutlineFit* result, std::vector<bool>* along) {
  const auto edges = FindStraightEdges(result->curve, touches);
  if (edges.empty()) return;
  const std::vector<bool> apart = Along(touches, edges, result->curve);
  if (std::count(apart.begin(), apart.end(), false) < 3) return;
  Fit smooth(touches, apart, result->curve, &result->curve, stage_std_mm);
  Fit straight(touches, apart, WithEdges(result->curve, edges), &result->curve,
               stage_std_mm);
  const Best of_smooth =
      BestLambda(kLeastPower, kMostPower, kFirstStep, &smooth);
  const Best of_straight =
      BestLambda(kLeastPower, kMostPower, kFirstStep, &straight);
  if (of_straight.improbability >= of_smooth.improbability) return;
  result->edges = edges;
  result->smoothing = of_straight.lambda;
  result->curve = straight.curve();
  Settle(result->curve, &result->edges);
  *along = apart;
}

}  // namespace

double OutlineFit::NormalStd(double normal_angle_rad) const {
  const Index cells = curve.grid().cells();
  const Vector2d normal(std::cos(normal_angle_rad), std::sin(normal_angle_rad));
  VectorXd slope(cells + 2);
  slope.head(cells) = (normal.transpose() *
                       ConvexCurve::SlopeAt(normal_angle_rad, curve.grid()) *
                       curve.radii_mm().asDiagonal())
                          .transpose();
  slope.tail<2>() = normal;
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
}

OutlineFit FitOutline(const std::vector<Touch>& touches, double stage_std_mm) {
  if (touches.size() < 3) {
    throw std::invalid_argument("an outline needs three touches");
  }
  OutlineFit result;
  result.curve = Circle(touches, NormalGrid(kOutlineCells));
  std::vector<bool> along(touches.size(), false);
  // Smooth first; the first round has the weights of a circle.
  for (int round = 0; round < kSmoothRounds; ++round) {
    Fit fit(touches, along, result.curve, round > 0 ? &result.curve : nullptr,
            stage_std_mm);
    result.smoothing =
        BestLambda(kLeastPower, kMostPower, kFirstStep, &fit).lambda;
    result.curve = fit.curve();
  }
  TakeEdges(touches, stage_std_mm, &result, &along);
  for (int round = 0; round < kLastRounds; ++round) {
    result.curve = WithEdges(result.curve, result.edges);
    Fit fit(touches, along, result.curve, &result.curve, stage_std_mm);
    const double power = std::log10(result.smoothing);
    result.smoothing =
        BestLambda(power - kFirstStep, power + kFirstStep, kLaterStep, &fit)
            .lambda;
    result.curve = fit.curve();
    Settle(result.curve, &result.edges);
    if (round + 1 < kLastRounds) continue;
    result.noise_scale = fit.noise_scale();
    result.distances = fit.Distances();
    result.beam_bounds = fit.ActiveBounds();
    const double scale = std::max(1.0, result.noise_scale);
    const MatrixXd information = fit.Information(result.smoothing);
    result.covariance = scale * scale *
                        information.llt().solve(MatrixXd::Identity(
                            information.rows(), information.cols()));
  }
  return result;
}

ConvexCurve RefitOutline(const std::vector<Touch>& touches,
                         const OutlineFit& start, double stage_std_mm) {
  Fit fit(touches, Along(touches, start.edges, start.curve), start.curve,
          &start.curve, stage_std_mm);
  if (!fit.Solve(start.smoothing)) {
    throw std::runtime_error("no outline fits the touches of a varied finger");
  }
  return fit.curve();
}

}  // namespace finray

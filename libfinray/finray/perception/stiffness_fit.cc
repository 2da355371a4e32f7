#include "finray/perception/stiffness_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "finray/io/error.h"
#include "finray/perception/contradicting_points.h"
#include "finray/perception/force_law.h"
#include "finray/sensing/chi_squared.h"

namespace finray {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kUnexplained = 0.001;

// Whitened (u_i - v, F_i - F(v)); blocks: the law's parameters, v.
class PointCost : public ceres::CostFunction {
 public:
  PointCost(const ForcePoint& point, int degree, bool friction)
      : point_(point),
        degree_(degree),
        friction_(friction),
        whitening_(point.covariance.llt().matrixL().solve(
            Eigen::Matrix2d::Identity())) {
    set_num_residuals(2);
    mutable_parameter_block_sizes()->assign({degree + 1 + friction, 1});
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const int size = degree_ + 1 + friction_;
    const VectorXd a = Eigen::Map<const VectorXd>(parameters[0], size);
    const double v = *parameters[1];
    const double friction = friction_ ? point_.direction * a[degree_ + 1] : 0;
    Eigen::Map<Vector2d> residual(residuals);
    residual = whitening_ *
               Vector2d(point_.displacement_mm - v,
                        point_.force_N - ForceOf(a, degree_, v) - friction);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::RowVectorXd by_law(size);
      double power = 1;
      for (int m = 0; m <= degree_; ++m, power *= v) by_law[m] = -power;
      if (friction_) by_law[degree_ + 1] = -point_.direction;
      Eigen::Map<Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], 2, size) = whitening_.col(1) * by_law;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Vector2d>{jacobians[1]} =
          whitening_ * Vector2d(-1, -SlopeOf(a, degree_, v));
    }
    return true;
  }

 private:
  ForcePoint point_;
  int degree_;
  bool friction_;
  Eigen::Matrix2d whitening_;
};

// Of the law's parameters, each v eliminated: the error across the law.
MatrixXd Information(const std::vector<ForcePoint>& points, int degree,
                     bool friction, const VectorXd& a,
                     const std::vector<double>& v) {
  MatrixXd information = MatrixXd::Zero(a.size(), a.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    VectorXd row(a.size());
    for (int m = 0; m <= degree; ++m) row[m] = std::pow(v[i], m);
    if (friction) row[degree + 1] = points[i].direction;
    const Vector2d across(-SlopeOf(a, degree, v[i]), 1);
    information +=
        row * row.transpose() / across.dot(points[i].covariance * across);
  }
  return information;
}

// One spare point more than the law has parameters, and one for chi2.
int LeastPoints(int degree, bool friction) { return degree + 3 + friction; }

StiffnessFit FitDegree(const std::vector<ForcePoint>& points, int degree,
                       bool friction) {
  StiffnessFit fit;
  fit.degree = degree;
  fit.has_friction = friction;
  // Least squares of F on u to start from.
  const LawRows rows = LawRowsOf(points, degree, friction);
  VectorXd a = rows.left.colPivHouseholderQr().solve(rows.right);
  std::vector<double> v;
  for (const ForcePoint& point : points) v.push_back(point.displacement_mm);
  ceres::Problem problem;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (std::size_t i = 0; i < points.size(); ++i) {
    problem.AddResidualBlock(new PointCost(points[i], degree, friction),
                             nullptr, a.data(), &v[i]);
    ordering->AddElementToGroup(&v[i], 0);
  }
  ordering->AddElementToGroup(a.data(), 1);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering.reset(ordering);
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::runtime_error("no force law fits the points");
  }
  fit.coefficients = a;
  fit.chi2 = 2 * summary.final_cost;
  fit.dof = static_cast<int>(points.size()) - static_cast<int>(a.size());
  const double scale = fit.noise_scale();
  fit.covariance = scale * scale *
                   Information(points, degree, friction, a, v)
                       .completeOrthogonalDecomposition()
                       .pseudoInverse();
  const auto by_force = [](const ForcePoint& x, const ForcePoint& y) {
    return x.force_N < y.force_N;
  };
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), by_force);
  fit.least_force_N = low->force_N;
  fit.largest_force_N = high->force_N;
  const auto [near, far] = std::minmax_element(v.begin(), v.end());
  fit.least_mm = *near;
  fit.largest_mm = *far;
  fit.points = points.size();
  return fit;
}

}  // namespace

double StiffnessFit::friction_N() const {
  return has_friction ? coefficients[degree + 1] : std::nan("");
}

double StiffnessFit::friction_std_N() const {
  return has_friction ? std::sqrt(covariance(degree + 1, degree + 1))
                      : std::nan("");
}

double StiffnessFit::ForceAt(double displacement_mm) const {
  return ForceOf(coefficients, degree, displacement_mm);
}

double StiffnessFit::DisplacementAt(double force_N) const {
  if (degree == 1) return (force_N - coefficients[0]) / coefficients[1];
  // Little beyond the points, where the law still rises.
  const double beyond = 0.05 * (largest_mm - least_mm);
  double low = least_mm - beyond, high = largest_mm + beyond;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (ForceAt(middle) < force_N ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double StiffnessFit::noise_scale() const {
  return dof > 0 && ChiSquaredTail(chi2, dof) < kUnexplained
             ? std::sqrt(chi2 / dof)
             : 1;
}

StiffnessFit FitStiffness(const std::vector<ForcePoint>& points,
                          int most_degree) {
  std::vector<ForcePoint> sliding;
  std::copy_if(points.begin(), points.end(), std::back_inserter(sliding),
               [](const ForcePoint& point) { return point.slides; });
  if (sliding.size() < kLeastPoints) {
    throw InputError(
        "too few force-displacement points: " + std::to_string(sliding.size()) +
        " with one contact and a slider that moves; expected at "
        "least " +
        std::to_string(kLeastPoints));
  }
  const auto both_ways = [](const std::vector<ForcePoint>& some) {
    const auto forward =
        std::count_if(some.begin(), some.end(),
                      [](const ForcePoint& p) { return p.direction > 0; });
    return forward >= 2 &&
           static_cast<std::ptrdiff_t>(some.size()) - forward >= 2;
  };
  const std::size_t standing = points.size() - sliding.size();
  // Judged by the law that can follow most.
  const int judge =
      std::min(most_degree, static_cast<int>(sliding.size()) -
                                LeastPoints(0, both_ways(sliding)));
  const std::vector<std::size_t> left_out = TakeOutContradicting(
      std::max(1, judge), both_ways(sliding), kLeastPoints + 1, &sliding);
  const bool friction = both_ways(sliding);
  std::optional<StiffnessFit> best;
  double least = 0;
  for (int degree = 1; degree <= most_degree; ++degree) {
    if (degree > 1 &&
        static_cast<int>(sliding.size()) < LeastPoints(degree, friction)) {
      break;
    }
    StiffnessFit fit = FitDegree(sliding, degree, friction);
    const double price = static_cast<double>(fit.coefficients.size()) *
                         std::log(static_cast<double>(sliding.size()));
    // A law that turns back is none.
    bool rises = true;
    for (int k = 0; k <= 20; ++k) {
      const double u = fit.least_mm + (fit.largest_mm - fit.least_mm) * k / 20;
      rises = rises && SlopeOf(fit.coefficients, degree, u) > 0;
    }
    if (best && (!rises || fit.chi2 + price >= least)) continue;
    least = fit.chi2 + price;
    best = fit;
  }
  if (!(best->coefficients[1] > 0) && best->degree == 1) {
    throw InputError("the force does not grow with the displacement");
  }
  best->standing = standing;
  best->left_out = left_out;
  return *best;
}

Stiffness StiffnessBetween(const StiffnessFit& fit, double from_N,
                           double to_N) {
  const auto stiffness = [&](const StiffnessFit& law) {
    return (to_N - from_N) /
           (law.DisplacementAt(to_N) - law.DisplacementAt(from_N));
  };
  const double value = stiffness(fit);
  VectorXd slope(fit.coefficients.size());
  for (Index m = 0; m < slope.size(); ++m) {
    const double step = 1e-3 * std::sqrt(fit.covariance(m, m)) + 1e-12;
    StiffnessFit varied = fit;
    varied.coefficients[m] += step;
    slope[m] = (stiffness(varied) - value) / step;
  }
  return {value, std::sqrt(std::max(0.0, slope.dot(fit.covariance * slope)))};
}

}  // namespace finray

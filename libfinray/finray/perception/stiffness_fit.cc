#include "finray/perception/stiffness_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "finray/estimation/chi_squared.h"
#include "finray/io/error.h"

namespace finray {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kUnexplained = 0.001;
// Expected number of good points that are left out of a trial.
constexpr double kFalseAlarms = 0.01;
// With a larger share of contradicting points, the law or the std is wrong.
constexpr double kMostLeftOut = 0.25;
constexpr double kMedianOfChi2 = 0.4549;  // with one degree of freedom
constexpr int kAnnealingSteps = 20;
constexpr int kSparePoints = 2;  // of a fit, beyond its parameters

// W (u_i - v, F_i - F(v, s_i)), W whitening C_i. Parameter blocks: the law's
// parameters a, and v.
struct ForcePointCost {
  template <typename T>
  bool operator()(T const* const* parameters, T* residuals) const {
    const T& v = *parameters[1];
    const Eigen::Matrix<T, 2, 1> off(
        point.displacement_mm - v,
        point.force_N - law.Force(parameters[0], v, point.direction));
    Eigen::Map<Eigen::Matrix<T, 2, 1>>{residuals} = whitening.cast<T>() * off;
    return true;
  }

  ForcePoint point;
  ForceLaw law;
  Eigen::Matrix2d whitening;
};

// Squared distances of points across the law that most points follow, over the
// scale s^2. The law is fitted with Cauchy weights whose scale shrinks with the
// distances, as F on u: a line with errors in both might rise steeply through
// wild points.
VectorXd DistancesFromMost(const ForceLaw& law,
                           const std::vector<ForcePoint>& points) {
  const auto count = static_cast<Index>(points.size());
  VectorXd weights = VectorXd::Ones(count), variance(count), chi2(count);
  for (int step = 0; step <= kAnnealingSteps; ++step) {
    const VectorXd a = law.Fit(points, weights);
    for (Index i = 0; i < count; ++i) {
      const ForcePoint& point = points[static_cast<std::size_t>(i)];
      const double u = point.displacement_mm;
      const double off = point.force_N - law.Row(u, point.direction).dot(a);
      variance[i] = law.VarianceAcross(a, point, u);
      chi2[i] = off * off / variance[i];
    }
    VectorXd sorted = chi2;
    double* middle = sorted.data() + count / 2;
    std::nth_element(sorted.data(), middle, sorted.data() + count);
    chi2 /= std::max(1.0, *middle / kMedianOfChi2);
    weights = (variance.array() * (1 + chi2.array())).rsqrt();
  }
  return chi2;
}

// Removes the points that contradict the others and returns their rows; keeps
// all points if too many do.
std::vector<std::size_t> TakeOutContradicting(const ForceLaw& law,
                                              std::vector<ForcePoint>* points) {
  const VectorXd chi2 = DistancesFromMost(law, *points);
  const auto count = static_cast<double>(points->size());
  std::vector<ForcePoint> kept;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const ForcePoint& point = (*points)[i];
    if (ChiSquaredTail(chi2[static_cast<Index>(i)], 1) > kFalseAlarms / count) {
      kept.push_back(point);
    } else {
      rows.push_back(point.row);
    }
  }
  if (kept.size() <= kLeastPoints ||
      static_cast<double>(rows.size()) > kMostLeftOut * count) {
    return {};
  }
  *points = std::move(kept);
  return rows;
}

StiffnessFit FitLaw(const std::vector<ForcePoint>& points,
                    const ForceLaw& law) {
  StiffnessFit fit;
  fit.law = law;
  VectorXd a =
      law.Fit(points, VectorXd::Ones(static_cast<Index>(points.size())));
  std::vector<double> v;
  for (const ForcePoint& point : points) v.push_back(point.displacement_mm);
  ceres::Problem problem;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<ForcePointCost, 6>(
        new ForcePointCost{points[i], law,
                           points[i].covariance.llt().matrixL().solve(
                               Eigen::Matrix2d::Identity())});
    cost->AddParameterBlock(law.parameters());
    cost->AddParameterBlock(1);
    cost->SetNumResiduals(2);
    problem.AddResidualBlock(cost, nullptr, a.data(), &v[i]);
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
  fit.dof = static_cast<int>(points.size()) - law.parameters();
  // With each v_i eliminated, a point weighs by its error across the law.
  MatrixXd information = MatrixXd::Zero(a.size(), a.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::RowVectorXd row = law.Row(v[i], points[i].direction);
    information +=
        row.transpose() * row / law.VarianceAcross(a, points[i], v[i]);
    fit.largest_force_N = std::max(fit.largest_force_N, points[i].force_N);
  }
  const double scale = fit.noise_scale();
  fit.covariance =
      scale * scale *
      information.completeOrthogonalDecomposition().pseudoInverse();
  const auto [near, far] = std::minmax_element(v.begin(), v.end());
  fit.least_mm = *near;
  fit.largest_mm = *far;
  fit.points = points.size();
  return fit;
}

bool Rises(const StiffnessFit& fit) {
  for (int k = 0; k <= 20; ++k) {
    const double u = fit.least_mm + (fit.largest_mm - fit.least_mm) * k / 20;
    if (!(fit.law.Slope(fit.coefficients, u) > 0)) return false;
  }
  return true;
}

bool BothDirections(const std::vector<ForcePoint>& points) {
  const auto forward =
      std::count_if(points.begin(), points.end(),
                    [](const ForcePoint& p) { return p.direction > 0; });
  return forward >= 2 &&
         static_cast<std::ptrdiff_t>(points.size()) - forward >= 2;
}

}  // namespace

double StiffnessFit::friction_N() const {
  return law.has_friction ? coefficients[law.degree + 1] : std::nan("");
}

double StiffnessFit::friction_std_N() const {
  return law.has_friction
             ? std::sqrt(covariance(law.degree + 1, law.degree + 1))
             : std::nan("");
}

double StiffnessFit::ForceAt(double displacement_mm) const {
  return law.Force(coefficients.data(), displacement_mm, 0);
}

double StiffnessFit::DisplacementAt(double force_N) const {
  if (law.degree == 1) return (force_N - coefficients[0]) / coefficients[1];
  // Not far beyond the points, where the law still rises.
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
        " with one contact and a moving slider; expected at least " +
        std::to_string(kLeastPoints));
  }
  const std::size_t standing = points.size() - sliding.size();
  // The most flexible law decides which points contradict the others.
  ForceLaw judge{0, BothDirections(sliding)};
  judge.degree = std::clamp(
      static_cast<int>(sliding.size()) - judge.parameters() - kSparePoints, 1,
      most_degree);
  const std::vector<std::size_t> left_out =
      TakeOutContradicting(judge, &sliding);
  const auto count = static_cast<int>(sliding.size());
  std::optional<StiffnessFit> best;
  double least = 0;
  for (int degree = 1; degree <= most_degree; ++degree) {
    const ForceLaw law{degree, BothDirections(sliding)};
    if (degree > 1 && count < law.parameters() + kSparePoints) break;
    StiffnessFit fit = FitLaw(sliding, law);
    const double price = fit.chi2 + law.parameters() * std::log(count);
    // A curved law must rise with the displacement everywhere.
    if (best && (!Rises(fit) || price >= least)) continue;
    least = price;
    best = fit;
  }
  if (!(best->coefficients[1] > 0) && best->law.degree == 1) {
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

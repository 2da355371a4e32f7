#include "finray/perception/contradicting_points.h"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

#include "finray/perception/force_law.h"
#include "finray/sensing/chi_squared.h"

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Points that are left out though they belong to the law, expected in a trial.
constexpr double kFalseAlarms = 0.01;
// Of the points; if there are more, the law is wrong, or the std.
constexpr double kMostLeftOut = 0.25;
constexpr double kMedianOfChi2 = 0.4549;  // with one degree of freedom
constexpr int kAnnealingSteps = 20;

// How far points are from a law, across it, and the variance of that.
struct Distances {
  VectorXd off, variance;
  VectorXd chi2() const { return off.cwiseAbs2().cwiseQuotient(variance); }
};
Distances DistancesFrom(const VectorXd& a,
                        const std::vector<ForcePoint>& points, int degree,
                        bool friction) {
  const auto count = static_cast<Index>(points.size());
  Distances distances{VectorXd(count), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    const ForcePoint& point = points[static_cast<std::size_t>(i)];
    const double u = point.displacement_mm;
    distances.off[i] = point.force_N - ForceOf(a, degree, u) -
                       (friction ? point.direction * a[degree + 1] : 0);
    const Vector2d across(-SlopeOf(a, degree, u), 1);
    distances.variance[i] = across.dot(point.covariance * across);
  }
  return distances;
}

// What the middle one of squared distances says the variance to be, in units
// of the stated one.
double ScaleOf(VectorXd chi2) {
  double* middle = chi2.data() + chi2.size() / 2;
  std::nth_element(chi2.data(), middle, chi2.data() + chi2.size());
  return std::max(1.0, *middle / kMedianOfChi2);
}

// Whether the law that most points follow explains each of them, the errors
// being as large as they are for the half of them.
std::vector<bool> Explained(const std::vector<ForcePoint>& points, int degree,
                            bool friction) {
  // F on u, with Cauchy's weights of ever smaller scales: with errors of both
  // a line might go up through wild points.
  const LawRows rows = LawRowsOf(points, degree, friction);
  VectorXd a = rows.left.colPivHouseholderQr().solve(rows.right);
  Distances from = DistancesFrom(a, points, degree, friction);
  for (int step = 0; step < kAnnealingSteps; ++step) {
    const VectorXd chi2 = from.chi2();
    const VectorXd weights =
        (from.variance.array() * (1 + chi2.array() / ScaleOf(chi2)))
            .rsqrt()
            .matrix();
    a = (weights.asDiagonal() * rows.left)
            .colPivHouseholderQr()
            .solve(weights.cwiseProduct(rows.right));
    from = DistancesFrom(a, points, degree, friction);
  }
  const VectorXd chi2 = from.chi2() / ScaleOf(from.chi2());
  std::vector<bool> explained;
  for (const double its : chi2) {
    explained.push_back(ChiSquaredTail(its, 1) >
                        kFalseAlarms / static_cast<double>(points.size()));
  }
  return explained;
}

}  // namespace

std::vector<std::size_t> TakeOutContradicting(int degree, bool friction,
                                              std::size_t least,
                                              std::vector<ForcePoint>* points) {
  const std::vector<bool> explained = Explained(*points, degree, friction);
  std::vector<ForcePoint> kept;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < points->size(); ++i) {
    if (explained[i]) {
      kept.push_back((*points)[i]);
    } else {
      rows.push_back((*points)[i].row);
    }
  }
  if (kept.size() < least ||
      static_cast<double>(rows.size()) >
          kMostLeftOut * static_cast<double>(points->size())) {
    return {};
  }
  *points = std::move(kept);
  return rows;
}

}  // namespace finray

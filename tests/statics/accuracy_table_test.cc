// Prints the tables of docs/evidence/statics_accuracy.md: accuracy by mesh and
// order.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "finray/ladder/taylor_element.h"
#include "finray/statics/equilibrium.h"
#include "ladder/computed_element.h"
#include "statics/beam_ode.h"
#include "statics/special_cases.h"

namespace finray {
namespace {

constexpr double kFront_mm = 140;
constexpr double kStiffness = 12500;

// Largest differences of tip (of l_0), gauges and rib forces (of the largest).
struct Difference {
  double tip, gauges, ribs;
};

Difference Compare(const EquilibriumSolver& a, const EquilibriumSolver& b) {
  Difference d;
  d.tip = (a.tip_pose() - b.tip_pose()).head<2>().norm() / kFront_mm;
  const int m = b.model().gauges(), r = b.model().ribs();
  const Eigen::VectorXd gauges = b.outputs().head(m);
  d.gauges = (a.outputs().head(m) - gauges).cwiseAbs().maxCoeff() /
             gauges.cwiseAbs().maxCoeff();
  const Eigen::VectorXd ribs = b.state().q.tail(r);
  d.ribs = (a.state().q.tail(r) - ribs).cwiseAbs().maxCoeff() /
           ribs.cwiseAbs().maxCoeff();
  return d;
}

Difference WorstOverGrid(const Discretization& first,
                         const Discretization& second) {
  Difference worst{0, 0, 0};
  EquilibriumSolver a(PaperFinger(), first), b(PaperFinger(), second);
  for (const Case& at : GridCases()) {
    EXPECT_TRUE(a.Solve(at.contacts)) << at.name;
    EXPECT_TRUE(b.Solve(at.contacts)) << at.name;
    const Difference d = Compare(a, b);
    worst.tip = std::max(worst.tip, d.tip);
    worst.gauges = std::max(worst.gauges, d.gauges);
    worst.ribs = std::max(worst.ribs, d.ribs);
  }
  return worst;
}

TEST(AccuracyTableTest, MeshDoubling) {
  std::printf(
      "| elements | tip / l_0 | gauges | rib forces |\n"
      "|---|---|---|---|\n");
  for (const int elements : {14, 24, 48}) {
    const Difference d = WorstOverGrid({Scheme::kTaylor, elements},
                                       {Scheme::kTaylor, 2 * elements});
    std::printf("| %d, %d | %.1e | %.1e | %.1e |\n", elements, 2 * elements,
                d.tip, d.gauges, d.ribs);
    if (elements < 24) continue;
    EXPECT_LT(d.tip, 1e-9);
    EXPECT_LT(d.gauges, 1e-9);
    EXPECT_LT(d.ribs, 1e-9);
  }
}

// Against 96 elements of order 16. Times are in
// benchmarks/statics_benchmark.cc.
TEST(AccuracyTableTest, SchemesAndResolutions) {
  const std::pair<Scheme, std::vector<int>> choices[] = {
      {Scheme::kRigidChain, {50, 100, 200, 400, 800}},
      {Scheme::kTaylor4, {24, 48, 96, 192}},
      {Scheme::kTaylor8, {12, 24, 48}},
      {Scheme::kTaylor12, {12, 24, 48}},
      {Scheme::kTaylor, {0, 12, 24, 48}}};
  std::printf(
      "| scheme | resolution | tip / l_0 | gauges | rib forces |\n"
      "|---|---|---|---|---|\n");
  for (const auto& [scheme, resolutions] : choices) {
    for (const int resolution : resolutions) {
      const Difference d =
          WorstOverGrid({scheme, resolution}, {Scheme::kTaylor, 96});
      std::printf("| %s | %d | %.1e | %.1e | %.1e |\n",
                  SchemeName(scheme).c_str(), resolution, d.tip, d.gauges,
                  d.ribs);
      if (scheme == Scheme::kTaylor && resolution == 0) {
        EXPECT_LT(std::max({d.tip, d.gauges, d.ribs}), 1e-8);
      }
    }
  }
}

// Error of one element by order, over the elements of the paper's finger at
// 20 N.
class OrderTable {
 public:
  OrderTable() {
    EquilibriumSolver solver(PaperFinger(), {Scheme::kTaylor, 24});
    for (double arc = 5; arc <= 135; arc += 5) {
      const std::vector<PointContact> contacts = {{arc, 20, 0}};
      EXPECT_TRUE(solver.Solve(contacts));
      for (const auto& side : solver.Spans(contacts)) {
        spans_.insert(spans_.end(), side.begin(), side.end());
      }
    }
    for (const BeamSpan& span : spans_) {
      exact_.push_back(
          IntegrateBeam({0, 0, span.start.theta_rad, span.start.moment_N_mm},
                        span.start.force_x_N, span.start.force_y_N, kStiffness,
                        span.length_mm, 300));
    }
  }

  /// Prints a line and returns the worst error of the angle.
  template <int K>
  double Print() const {
    double angle = 0, moment = 0;
    for (std::size_t i = 0; i < spans_.size(); ++i) {
      const auto element = ComputedElement<TaylorElement<K>>(
          spans_[i].start, kStiffness, spans_[i].length_mm);
      const double* end = element.map().end;
      angle =
          std::max(angle, std::abs(end[2] - static_cast<double>(exact_[i][2])));
      moment = std::max(moment,
                        std::abs(end[3] - static_cast<double>(exact_[i][3])));
    }
    std::printf("| %d | %.1e | %.1e |\n", K, angle, moment);
    return angle;
  }

 private:
  std::vector<BeamSpan> spans_;
  std::vector<BeamOdeState> exact_;
};

TEST(AccuracyTableTest, OrderOfTheSeries) {
  const OrderTable table;
  std::printf(
      "| order | angle, rad | moment, N mm |\n"
      "|---|---|---|\n");
  const double order8 = table.Print<8>();
  table.Print<10>();
  const double order12 = table.Print<12>();
  table.Print<14>();
  const double order16 = table.Print<16>();
  table.Print<20>();
  EXPECT_LT(order12, 0.1 * order8);
  EXPECT_LT(order16, 1e-11);
}

// How hard a finger can be loaded: cold solves on the default mesh, which is
// refined as the load asks for it, against 192 elements.
TEST(AccuracyTableTest, RangeOfLoads) {
  std::printf(
      "| f_c, N | f_c l_0^2 / EI | solved | limit points | elements | tip, mm "
      "|\n|---|---|---|---|---|---|\n");
  for (const double force : {10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
    int solved = 0, limits = 0, cases = 0, most = 0;
    double worst = 0;
    for (double arc = 5; arc <= 135; arc += 5) {
      const std::vector<PointContact> contacts = {{arc, force, 0}};
      EquilibriumSolver solver(PaperFinger(), {});
      EquilibriumSolver fine(PaperFinger(), {Scheme::kTaylor, 192});
      ++cases;
      if (!solver.Solve(contacts)) {
        limits += solver.status() == SolveStatus::kLimitPoint;
        continue;
      }
      ++solved;
      const BeamMesh& front = solver.model().mesh(Side::kFront);
      const BeamMesh& back = solver.model().mesh(Side::kBack);
      most = std::max(most, front.elements() + back.elements());
      ASSERT_TRUE(fine.Solve(contacts)) << arc << " mm " << force << " N";
      worst = std::max(worst,
                       (solver.tip_pose() - fine.tip_pose()).head<2>().norm());
    }
    std::printf("| %g | %.0f | %d of %d | %d | %d | %.1e |\n", force,
                force * kFront_mm * kFront_mm / kStiffness, solved, cases,
                limits, most, worst);
    EXPECT_EQ(solved + limits, cases) << force;
    EXPECT_LT(worst, 1e-6) << force;
  }
}

}  // namespace
}  // namespace finray

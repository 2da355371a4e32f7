// Checks of the equilibrium beyond equilibrium_test.cc: both schemes over more
// cases, every beam cut by itself, reciprocity, size, bad loads.

#include "finray/statics/equilibrium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "finray/chain/se2.h"
#include "finray/io/error.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/special_cases.h"
#include "statics/strain_energy.h"

namespace finray {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFrontLength = 140;
const double kBackLength = 140 / std::sin(112 * M_PI / 180);
const double kBackBase = 140 / std::tan(68 * M_PI / 180);

Vector2d Tangent(double theta) { return {std::cos(theta), std::sin(theta)}; }
Vector2d NormalInward(double theta) {
  return {std::sin(theta), -std::cos(theta)};
}

Vector2d Point(const Section& section) { return {section.x_mm, section.y_mm}; }
Vector2d Force(const Section& section) {
  return {section.force_x_N, section.force_y_N};
}

std::vector<Case> AllCases() {
  std::vector<Case> cases = GridCases();
  for (const Case& special : SpecialCases()) cases.push_back(special);
  return cases;
}

// The largest load, with a floor for prestress alone.
double LoadScale(const Case& at) {
  double scale = at.contacts.empty() ? 1 : 0;
  for (const PointContact& contact : at.contacts) {
    scale = std::max(scale, contact.normal_N);
  }
  return scale;
}

Vector2d ContactForce(const EquilibriumSolver& solver, const Case& at, int i) {
  const double theta = solver.contact_pose(i).z();
  const PointContact& contact = at.contacts[i];
  return contact.normal_N *
         (NormalInward(theta) + contact.friction * Tangent(theta));
}

class EquilibriumTest : public testing::TestWithParam<Scheme> {
 protected:
  Discretization discretization() const { return {GetParam(), 0}; }
};

INSTANTIATE_TEST_SUITE_P(Schemes, EquilibriumTest,
                         testing::Values(Scheme::kTaylor, Scheme::kRigidChain),
                         [](const auto& info) {
                           return info.param == Scheme::kTaylor
                                      ? std::string("Taylor")
                                      : std::string("RigidChain");
                         });

// Clamps and contacts are all that acts on the finger from outside.
TEST_P(EquilibriumTest, ReactionsBalanceTheContacts) {
  for (const Case& at : AllCases()) {
    SCOPED_TRACE(at.name);
    EquilibriumSolver solver(at.finger, discretization());
    ASSERT_TRUE(solver.Solve(at.contacts));
    Vector2d force(0, 0);
    double moment = 0;
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Vector3d reaction = BaseReaction(solver, side);
      const Vector2d base(side == Side::kFront ? 0 : kBackBase, 0);
      force += reaction.tail<2>();
      moment += reaction[0] + Cross(base, reaction.tail<2>());
    }
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      const Vector2d pushed = ContactForce(solver, at, static_cast<int>(i));
      force += pushed;
      moment +=
          Cross(solver.contact_pose(static_cast<int>(i)).head<2>(), pushed);
    }
    EXPECT_LT(force.norm(), 1e-9 * LoadScale(at));
    EXPECT_LT(std::abs(moment), 1e-9 * LoadScale(at) * kFrontLength);
  }
}

// A cut through one beam: what it transmits is the sum of all that acts beyond.
TEST_P(EquilibriumTest, EveryCutCarriesWhatLiesBeyond) {
  for (const Case& at : AllCases()) {
    SCOPED_TRACE(at.name);
    EquilibriumSolver solver(at.finger, discretization());
    ASSERT_TRUE(solver.Solve(at.contacts));
    const Shape shape(solver, at.contacts);
    for (const Side side : {Side::kFront, Side::kBack}) {
      const bool front = side == Side::kFront;
      const Side other = front ? Side::kBack : Side::kFront;
      for (const double cut_mm : {3.1, 24.7, 50.0, 69.0, 93.3, 118.0, 133.0}) {
        // The chain's moment is given at joints only; at a station it is exact.
        const std::vector<double> stations =
            Stations(solver, at.contacts, side);
        const double arc =
            GetParam() == Scheme::kTaylor
                ? cut_mm
                : *std::upper_bound(stations.begin(), stations.end(), cut_mm);
        const Section cut = shape.At(side, arc);
        // The other beam holds this one's tip with the opposite of its own.
        const Section end = shape.At(other, front ? kBackLength : kFrontLength);
        Vector2d force = -Force(end);
        double moment = Cross(Point(end) - Point(cut), -Force(end));
        if (GetParam() == Scheme::kTaylor) moment -= end.moment_N_mm;
        for (std::size_t i = 0; i < at.finger.ribs.size(); ++i) {
          const Rib& rib = at.finger.ribs[i];
          if ((front ? rib.front_mm : rib.back_mm) <= arc) continue;
          const Vector2d here =
              Point(shape.At(side, front ? rib.front_mm : rib.back_mm));
          const Vector2d there =
              Point(shape.At(other, front ? rib.back_mm : rib.front_mm));
          const Vector2d pull = solver.rib_tension(static_cast<int>(i)) *
                                (there - here).normalized();
          force += pull;
          moment += Cross(here - Point(cut), pull);
        }
        for (std::size_t i = 0; front && i < at.contacts.size(); ++i) {
          if (at.contacts[i].arc_mm <= arc) continue;
          const int contact = static_cast<int>(i);
          const Vector2d pushed = ContactForce(solver, at, contact);
          force += pushed;
          moment += Cross(solver.contact_pose(contact).head<2>() - Point(cut),
                          pushed);
        }
        EXPECT_LT((Force(cut) - force).norm(), 1e-9 * LoadScale(at))
            << (front ? "front " : "back ") << arc;
        if (GetParam() == Scheme::kTaylor) {
          EXPECT_LT(std::abs(cut.moment_N_mm - moment),
                    1e-9 * LoadScale(at) * kFrontLength)
              << (front ? "front " : "back ") << arc;
        }
      }
    }
  }
}

TEST_P(EquilibriumTest, RibsKeepTheirLengthAndTheTipIsClosed) {
  for (const Case& at : AllCases()) {
    SCOPED_TRACE(at.name);
    EquilibriumSolver solver(at.finger, discretization());
    ASSERT_TRUE(solver.Solve(at.contacts));
    const Shape shape(solver, at.contacts);
    for (std::size_t i = 0; i < at.finger.ribs.size(); ++i) {
      const Rib& rib = at.finger.ribs[i];
      const double length = (Point(shape.At(Side::kBack, rib.back_mm)) -
                             Point(shape.At(Side::kFront, rib.front_mm)))
                                .norm();
      const double stretch = solver.rib_tension(static_cast<int>(i)) *
                             rib.length_mm / rib.axial_stiffness_N;
      EXPECT_NEAR(length, rib.length_mm + stretch, 1e-10);
    }
    const Section front = shape.At(Side::kFront, kFrontLength);
    const Section back = shape.At(Side::kBack, kBackLength);
    EXPECT_NEAR(front.x_mm, back.x_mm, 1e-10);
    EXPECT_NEAR(front.y_mm, back.y_mm, 1e-10);
    EXPECT_NEAR(front.theta_rad - back.theta_rad, -22 * M_PI / 180, 1e-11);
    const Vector3d tip = solver.tip_pose();
    EXPECT_NEAR(tip.x(), front.x_mm, 1e-10);
    EXPECT_NEAR(tip.y(), front.y_mm, 1e-10);
    EXPECT_NEAR(tip.z(), front.theta_rad, 1e-11);
    for (std::size_t i = 0; i < at.contacts.size(); ++i) {
      const Vector3d pose = solver.contact_pose(static_cast<int>(i));
      const Section section = shape.At(Side::kFront, at.contacts[i].arc_mm);
      EXPECT_NEAR(pose.x(), section.x_mm, 1e-10);
      EXPECT_NEAR(pose.y(), section.y_mm, 1e-10);
      EXPECT_NEAR(pose.z(), section.theta_rad, 1e-11);
    }
    for (std::size_t j = 0; j < at.finger.gauges.size(); ++j) {
      const Gauge& gauge = at.finger.gauges[j];
      EXPECT_NEAR(
          solver.gauge_angle(static_cast<int>(j)),
          shape.At(gauge.beam, gauge.start_mm + gauge.length_mm).theta_rad -
              shape.At(gauge.beam, gauge.start_mm).theta_rad,
          1e-11);
    }
  }
}

// Integral of F . dr over a load path, against the energy it stores.
TEST_P(EquilibriumTest, WorkOfTheContactsIsStoredAsStrainEnergy) {
  std::vector<Case> cases = SpecialCases();
  const std::vector<Case> grid = GridCases();
  for (std::size_t i = 5; i < grid.size(); i += 6) cases.push_back(grid[i]);
  for (const Case& at : cases) {
    SCOPED_TRACE(at.name);
    if (at.contacts.empty()) continue;
    EquilibriumSolver solver(at.finger, discretization());
    // With its contacts at no force: they split the chain's links.
    std::vector<PointContact> resting = at.contacts;
    for (PointContact& contact : resting) contact.normal_N = 0;
    ASSERT_TRUE(solver.Solve(resting));
    const double before = StrainEnergy(solver, resting);
    double work = 0;
    for (const QuadraturePoint& q : GaussLegendre(16, 0, 1)) {
      Case part = at;
      for (PointContact& contact : part.contacts) contact.normal_N *= q.at;
      ASSERT_TRUE(solver.SolveWithSensitivities(part.contacts));
      for (std::size_t i = 0; i < at.contacts.size(); ++i) {
        Vector2d velocity(0, 0);  // by the common load factor
        const int row = solver.model().gauges() + 3 * static_cast<int>(i);
        for (std::size_t j = 0; j < at.contacts.size(); ++j) {
          velocity += at.contacts[j].normal_N *
                      solver.d_outputs().block<2, 1>(row, 2 * j + 1);
        }
        work += q.weight *
                ContactForce(solver, part, static_cast<int>(i)).dot(velocity);
      }
    }
    ASSERT_TRUE(solver.Solve(at.contacts));
    const double stored = StrainEnergy(solver, at.contacts) - before;
    // Base and tip do not yield, so that work is nothing but rounding there.
    EXPECT_NEAR(work, stored, 1e-6 * std::abs(stored) + 1e-11);
  }
}

// Rows of the outputs share a unit with their kind only.
double ColumnError(const Eigen::VectorXd& analytic,
                   const Eigen::VectorXd& numeric,
                   const std::vector<int>& kind) {
  double worst = 0;
  for (int k = 0; k < 2; ++k) {
    double largest = 0, error = 0;
    for (int i = 0; i < analytic.size(); ++i) {
      if (kind[i] != k) continue;
      largest = std::max(largest, std::abs(numeric[i]));
      error = std::max(error, std::abs(analytic[i] - numeric[i]));
    }
    if (largest > 0) worst = std::max(worst, error / largest);
  }
  return worst;
}

TEST_P(EquilibriumTest, SensitivitiesMatchCentralDifferences) {
  Finger finger = PrestressedPaperFinger();
  finger.ribs[1].axial_stiffness_N = 300;
  finger.gauges[0].beam = Side::kFront;  // 30 to 48: holds the second contact
  const std::vector<std::vector<PointContact>> loads = {
      {{52.3, 3, 0.2}, {90, 1, -0.1}},
      {{12, 2, 0}, {38.3, 5, 0.3}},
      {{64.1, 2, 0}, {66.2, 3, 0.1}},
      {{47.6, 3, 0.1}, {29.6, 2, 0}},  // beside the ends of a gauge, in the
      {{48.3, 3, 0.1}, {30.4, 2, 0}},  // same link
      {{128, 4, 0}, {100, 0.5, 0}},
      {{45, 15, 0}},
  };
  double worst = 0;
  for (const std::vector<PointContact>& contacts : loads) {
    EquilibriumSolver solver(finger, discretization());
    ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
    const int n = static_cast<int>(contacts.size());
    const int ribs = static_cast<int>(finger.ribs.size());
    const int columns = 2 * n + 2 + ribs;
    ASSERT_EQ(solver.d_outputs().cols(), columns);
    std::vector<int> output_kind(solver.outputs().size(), 0);
    for (int i = 0; i < 3 * (n + 1); ++i) {
      output_kind[solver.model().gauges() + i] = i % 3 == 2 ? 0 : 1;
    }
    for (int p = 0; p < columns; ++p) {
      const bool arc = p < 2 * n && p % 2 == 0;
      const bool stiffness = p >= 2 * n && p < 2 * n + 2;
      const double step = arc ? 2e-3 : stiffness ? 5.0 : 1e-3;
      Eigen::VectorXd outputs[4];
      for (int k = 0; k < 4; ++k) {
        const double move = step * (k == 0 ? -2 : k == 1 ? -1 : k == 2 ? 1 : 2);
        EquilibriumSolver moved(finger, discretization());
        std::vector<PointContact> loaded = contacts;
        if (p < 2 * n) {
          (arc ? loaded[p / 2].arc_mm : loaded[p / 2].normal_N) += move;
        } else if (stiffness) {
          moved.model().set_stiffness(
              finger.front_stiffness_N_mm2 + (p == 2 * n ? move : 0),
              finger.back_stiffness_N_mm2 + (p == 2 * n ? 0 : move));
        } else {
          const int rib = p - 2 * n - 2;
          moved.model().set_rib_length(rib, finger.ribs[rib].length_mm + move);
        }
        ASSERT_TRUE(moved.Solve(loaded));
        outputs[k] = moved.outputs();
      }
      const auto slope = [step](const Eigen::VectorXd* y) {
        return Eigen::VectorXd((8 * (y[2] - y[1]) - (y[3] - y[0])) /
                               (12 * step));
      };
      const double error =
          ColumnError(solver.d_outputs().col(p), slope(outputs), output_kind);
      EXPECT_LT(error, 1e-6) << "column " << p << " of " << n << " contacts";
      worst = std::max(worst, error);
    }
  }
  std::printf("worst relative difference of a sensitivity: %.1e\n", worst);
}

// EI and forces together: the same shape. Lengths by 1000 and forces by 1e-6,
// at one EI: the same angles.
TEST_P(EquilibriumTest, ScalesWithStiffnessAndSize) {
  for (const Case& at : SpecialCases()) {
    SCOPED_TRACE(at.name);
    EquilibriumSolver solver(at.finger, discretization());
    ASSERT_TRUE(solver.Solve(at.contacts));
    const int gauges = solver.model().gauges();

    Case stiffer = at, larger = at;
    stiffer.finger.front_stiffness_N_mm2 *= 7.5;
    stiffer.finger.back_stiffness_N_mm2 *= 7.5;
    for (Rib& rib : stiffer.finger.ribs) rib.axial_stiffness_N *= 7.5;
    for (PointContact& contact : stiffer.contacts) contact.normal_N *= 7.5;
    larger.finger.front_length_mm *= 1e3;
    for (Rib& rib : larger.finger.ribs) {
      rib.front_mm *= 1e3;
      rib.back_mm *= 1e3;
      rib.length_mm *= 1e3;
      rib.axial_stiffness_N *= 1e-6;
    }
    for (Gauge& gauge : larger.finger.gauges) {
      gauge.start_mm *= 1e3;
      gauge.length_mm *= 1e3;
    }
    for (PointContact& contact : larger.contacts) {
      contact.arc_mm *= 1e3;
      contact.normal_N *= 1e-6;
    }
    const auto expect_same = [&](const Case& other, double force,
                                 double length) {
      EquilibriumSolver scaled(other.finger, discretization());
      ASSERT_TRUE(scaled.Solve(other.contacts));
      for (int j = 0; j < gauges; ++j) {
        EXPECT_NEAR(scaled.gauge_angle(j), solver.gauge_angle(j), 1e-10);
      }
      for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(scaled.tip_pose()[i] / length, solver.tip_pose()[i], 1e-8);
      }
      EXPECT_NEAR(scaled.tip_pose()[2], solver.tip_pose()[2], 1e-10);
      for (int i = 0; i < solver.model().ribs(); ++i) {
        EXPECT_NEAR(scaled.rib_tension(i) / force, solver.rib_tension(i), 1e-7);
      }
    };
    expect_same(stiffer, 7.5, 1);
    expect_same(larger, 1e-6, 1e3);
  }
}

// Scaled loads on a tiny scale: the response is a multiple of its slope, and
// that slope obeys Betti: a force at A moves B as one at B moves A.
TEST_P(EquilibriumTest, TinyForcesActLinearlyAndReciprocally) {
  EquilibriumSolver solver(PaperFinger(), discretization());
  for (const double a : {8.0, 50.0, 61.0, 122.0}) {
    for (const double b : {30.0, 95.0, 135.0}) {
      ASSERT_TRUE(solver.SolveWithSensitivities({{a, 0, 0}, {b, 0, 0}}));
      const Eigen::VectorXd rest = solver.outputs();
      const EquilibriumSolver::Matrix slope = solver.d_outputs();
      const int row = solver.model().gauges();
      // Normals are +x in the undeformed finger.
      const double b_by_a = slope(row + 3, 1), a_by_b = slope(row, 3);
      EXPECT_NEAR(b_by_a / a_by_b, 1, 1e-9) << a << ", " << b;
      EXPECT_GT(slope(row, 1), 0);
      for (const double force : {1e-6, 1e-4}) {
        ASSERT_TRUE(solver.Solve({{a, force, 0}, {b, 0, 0}}));
        const Eigen::VectorXd change = (solver.outputs() - rest) / force;
        EXPECT_LT((change - slope.col(1)).norm(), 2e-3 * slope.col(1).norm());
      }
    }
  }
}

TEST_P(EquilibriumTest, WarmStartEqualsColdStart) {
  EquilibriumSolver warm(PrestressedPaperFinger(), discretization());
  int warm_iterations = 0, cold_iterations = 0;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.05 * i;
    const std::vector<PointContact> contacts = {
        {70 + 55 * std::sin(u), 4 + 3.9 * std::sin(3 * u), 0.1}};
    EquilibriumSolver cold(PrestressedPaperFinger(), discretization());
    ASSERT_TRUE(warm.Solve(contacts));
    ASSERT_TRUE(cold.Solve(contacts));
    EXPECT_LT((warm.outputs() - cold.outputs()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((warm.state().q - cold.state().q).cwiseAbs().maxCoeff(), 1e-7);
    warm_iterations += warm.iterations();
    cold_iterations += cold.iterations();
  }
  EXPECT_LT(warm_iterations, cold_iterations);
}

TEST_P(EquilibriumTest, AbsurdLoadsAreRefusedAndDoNoHarm) {
  const std::vector<PointContact> sane = {{70, 2, 0}};
  EquilibriumSolver solver(PaperFinger(), discretization());
  ASSERT_TRUE(solver.Solve(sane));
  const Eigen::VectorXd expected = solver.outputs();
  for (const double force :
       {1e6, -1e6, 1e12, 1e300, std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()}) {
    for (const double arc : {20.0, 70.0, 130.0}) {
      EXPECT_FALSE(solver.Solve({{arc, force, 0}})) << force << " at " << arc;
      EXPECT_TRUE(solver.state().q.allFinite());
      ASSERT_TRUE(solver.Solve(sane));
      EXPECT_LT((solver.outputs() - expected).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

TEST_P(EquilibriumTest, ContactsOffTheBeamAreRefused) {
  EquilibriumSolver solver(PaperFinger(), discretization());
  for (const double arc : {-1e-9, 140.0000001, 500.0, std::nan("")}) {
    EXPECT_FALSE(solver.Solve({{arc, 2, 0}})) << arc;
  }
  EXPECT_TRUE(solver.Solve({{140, 2, 0}}));
}

TEST_P(EquilibriumTest, NothingIsReadFromASolveThatFailed) {
  EquilibriumSolver solver(PaperFinger(), discretization());
  EXPECT_FALSE(solver.Solve({{500, 2, 0}}));
  EXPECT_EQ(solver.status(), SolveStatus::kBadLoad);
  EXPECT_THROW(Shape(solver, {}), std::logic_error);
  EXPECT_THROW(solver.set_state(LadderState()), InputError);
  EXPECT_TRUE(solver.Solve({{70, 2, 0}}));
  EXPECT_NO_THROW(Shape(solver, {{70, 2, 0}}));
  LadderShot shot;
  EXPECT_TRUE(solver.Shoot(solver.state().q * 1.1, {{70, 2, 0}}, &shot));
  EXPECT_THROW(Shape(solver, {{70, 2, 0}}), std::logic_error);
}

TEST_P(EquilibriumTest, ContactPassesOverARibContinuously) {
  constexpr double kHair = 1e-6;
  const Finger finger = PaperFinger();
  for (const Rib& rib : finger.ribs) {
    for (const double force : {0.5, 5.0, 15.0}) {
      EquilibriumSolver solver(finger, discretization());
      Eigen::VectorXd outputs[3], q[3];
      Eigen::MatrixXd slope;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(solver.SolveWithSensitivities(
            {{rib.front_mm + (k - 1) * kHair, force, 0.2}}));
        EXPECT_LE(solver.iterations(), 8);
        outputs[k] = solver.outputs();
        q[k] = solver.state().q;
        if (k != 1) {
          // On either side of the rib a different piece grows.
          const Eigen::VectorXd column = solver.d_outputs().col(0);
          slope.conservativeResize(column.size(), k == 0 ? 1 : 2);
          slope.rightCols<1>() = column;
        }
      }
      const double steepest = slope.cwiseAbs().maxCoeff();
      EXPECT_LT((outputs[1] - outputs[0]).cwiseAbs().maxCoeff(),
                1.1 * kHair * steepest);
      EXPECT_LT((outputs[2] - outputs[1]).cwiseAbs().maxCoeff(),
                1.1 * kHair * steepest);
      EXPECT_LT((q[2] - q[0]).cwiseAbs().maxCoeff(), 1e-3 * force);
    }
  }
}

}  // namespace
}  // namespace finray

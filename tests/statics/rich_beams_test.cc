// Beams of several pieces, beams that stretch and contacts on the back beam, as
// read from files: conservation laws, limits, symmetry, derivatives.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "finray/chain/se2.h"
#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/strain_energy.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const char kUniform[] = "bending_stiffness_N_mm2: 12500";
const char kStepped[] =
    "pieces: [{end_mm: 50, bending_stiffness_N_mm2: 20000}, "
    "{end_mm: 71.3, bending_stiffness_N_mm2: 9000}, "
    "{bending_stiffness_N_mm2: 6000}]";
const char kSoft[] = ", axial_stiffness_N: 2e4";

// The paper's finger with other beams; each is the inside of its mapping.
Finger WithBeams(const std::string& front, const std::string& back,
                 const std::string& angle_deg = "112", bool ribs = true) {
  const TempFolder folder;
  return ReadFinger(
      folder.Write("finger.yaml",
                   "schema_version: 1\nname: test\n"
                   "geometry: {front_length_mm: 140, back_angle_deg: " +
                       angle_deg + "}\nbeams:\n  front: {" + front +
                       "}\n  back: {" + back + "}\n" +
                       (ribs ? "ribs:\n"
                               "  - {front_mm: 17, angle_deg: 10}\n"
                               "  - {front_mm: 39, angle_deg: 13}\n"
                               "  - {front_mm: 61, angle_deg: 16}\n"
                               "  - {front_mm: 83, angle_deg: 19}\n"
                               "  - {front_mm: 105, angle_deg: 22}\n"
                             : "") +
                       "gauges:\n"
                       "  - {beam: back, start_mm: 40, length_mm: 18}\n"
                       "  - {beam: front, start_mm: 64, length_mm: 18}\n"));
}

Finger RichFinger() {
  return WithBeams(std::string(kStepped) + kSoft,
                   std::string(kStepped) + ", axial_stiffness_N: 1.5e4");
}

const std::vector<std::vector<PointContact>> kLoads = {
    {{70, 4, 0.2}},
    {{80, 3, -0.3, Side::kBack}},
    {{52.3, 3, 0.2}, {95, 2, 0.1, Side::kBack}},
    {{147, 1, 0, Side::kBack}, {30, 5, 0}},
};

Vector2d ContactForce(const Vector3d& pose, const PointContact& contact) {
  const Vector2d tangent(std::cos(pose.z()), std::sin(pose.z()));
  const Vector2d right(tangent.y(), -tangent.x());
  return contact.normal_N * ((contact.side == Side::kFront ? 1 : -1) * right +
                             contact.friction * tangent);
}

double Distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(RichBeamsTest, EqualPiecesAreTheUniformBeam) {
  const std::string pieces =
      "pieces: [{end_mm: 61, bending_stiffness_N_mm2: 12500}, "
      "{bending_stiffness_N_mm2: 12500}]";
  // The pieces meet at a rib, so the mesh is the same and only the pieces
  // differ.
  const Finger uniform = WithBeams(kUniform, kUniform);
  const Finger equal = WithBeams(pieces, kUniform);
  for (const Scheme scheme : {Scheme::kTaylor, Scheme::kRigidChain}) {
    EquilibriumSolver a(uniform, {scheme, 0}), b(equal, {scheme, 0});
    for (const std::vector<PointContact>& contacts : kLoads) {
      ASSERT_TRUE(a.Solve(contacts));
      ASSERT_TRUE(b.Solve(contacts));
      EXPECT_LT(Distance(a.outputs(), b.outputs()), 1e-12);
    }
  }
  // Anywhere else it is the same beam, to the accuracy of the mesh.
  const Finger elsewhere = WithBeams(
      "pieces: [{end_mm: 50.7, bending_stiffness_N_mm2: 12500}, "
      "{bending_stiffness_N_mm2: 12500}]",
      kUniform);
  EquilibriumSolver a(uniform, {Scheme::kTaylor, 200}),
      b(elsewhere, {Scheme::kTaylor, 200});
  for (const std::vector<PointContact>& contacts : kLoads) {
    ASSERT_TRUE(a.Solve(contacts));
    ASSERT_TRUE(b.Solve(contacts));
    EXPECT_LT(Distance(a.outputs(), b.outputs()), 1e-11);
  }
}

TEST(RichBeamsTest, GreatAxialStiffnessIsInextensible) {
  const std::string hard = std::string(kStepped) + ", axial_stiffness_N: 1e12";
  EquilibriumSolver a(WithBeams(kStepped, kStepped), {});
  EquilibriumSolver b(WithBeams(hard, hard), {});
  EquilibriumSolver soft(RichFinger(), {});
  for (const std::vector<PointContact>& contacts : kLoads) {
    ASSERT_TRUE(a.Solve(contacts));
    ASSERT_TRUE(b.Solve(contacts));
    ASSERT_TRUE(soft.Solve(contacts));
    EXPECT_LT(Distance(a.outputs(), b.outputs()), 1e-8);
    EXPECT_GT(Distance(a.outputs(), soft.outputs()), 1e-4);
  }
}

TEST(RichBeamsTest, ReactionsBalanceTheContacts) {
  EquilibriumSolver solver(RichFinger(), {});
  for (const std::vector<PointContact>& contacts : kLoads) {
    ASSERT_TRUE(solver.Solve(contacts));
    Vector2d force(0, 0);
    double moment = 0;
    const auto add = [&](const Vector2d& at, const Vector2d& f) {
      force += f;
      moment += Cross(at, f);
    };
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Vector3d reaction = BaseReaction(solver, side);
      add(BeamBase(solver.model().finger(), side), reaction.tail<2>());
      moment += reaction[0];
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vector3d pose = solver.contact_pose(static_cast<int>(i));
      add(pose.head<2>(), ContactForce(pose, contacts[i]));
    }
    EXPECT_LT(force.norm(), 1e-9);
    EXPECT_LT(std::abs(moment), 1e-7);
  }
}

TEST(RichBeamsTest, WorkOfTheContactsIsStoredAsStrainEnergy) {
  for (const std::vector<PointContact>& contacts : kLoads) {
    EquilibriumSolver solver(RichFinger(), {});
    double work = 0;
    for (const QuadraturePoint& q : GaussLegendre(16, 0, 1)) {
      std::vector<PointContact> part = contacts;
      for (PointContact& contact : part) contact.normal_N *= q.at;
      ASSERT_TRUE(solver.SolveWithSensitivities(part));
      for (std::size_t i = 0; i < part.size(); ++i) {
        Vector2d velocity(0, 0);  // by the common load factor
        const int row = solver.model().gauges() + 3 * static_cast<int>(i);
        for (std::size_t j = 0; j < part.size(); ++j) {
          velocity += contacts[j].normal_N *
                      solver.d_outputs().block<2, 1>(row, 2 * j + 1);
        }
        const Vector3d pose = solver.contact_pose(static_cast<int>(i));
        work += q.weight * ContactForce(pose, part[i]).dot(velocity);
      }
    }
    ASSERT_TRUE(solver.Solve(contacts));
    const double stored = StrainEnergy(solver, contacts);
    EXPECT_NEAR(work / stored, 1, 1e-6);
  }
}

// Betti: a unit force at A moves B along its force as one at B moves A.
TEST(RichBeamsTest, FrontAndBackContactsAreReciprocal) {
  const Finger finger = RichFinger();
  EquilibriumSolver solver(finger, {});
  for (const double a : {20.0, 61.0, 122.0}) {
    for (const double b : {30.0, 71.3, 140.0}) {
      const std::vector<PointContact> contacts = {{a, 0, 0},
                                                  {b, 0, 0, Side::kBack}};
      ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
      const auto moved = [&](int at, int by) {
        PointContact unit = contacts[at];
        unit.normal_N = 1;
        const Vector2d direction = ContactForce(solver.contact_pose(at), unit);
        return direction.dot(solver.d_outputs().block<2, 1>(
            solver.model().gauges() + 3 * at, 2 * by + 1));
      };
      EXPECT_NEAR(moved(0, 1), moved(1, 0), 1e-9 * std::abs(moved(0, 1)));
      EXPECT_GT(moved(0, 0), 0);
      EXPECT_GT(moved(1, 1), 0);
    }
  }
}

// With two nearly coincident beams, a mirror swaps front and back. The beams
// stretch: two inextensible beams side by side could not bend.
TEST(RichBeamsTest, BackContactMirrorsTheFrontOne) {
  const std::string beam = std::string(kStepped) + kSoft;
  Finger finger = WithBeams(beam, beam, "90.00001", false);
  finger.gauges[0].start_mm = finger.gauges[1].start_mm;
  EquilibriumSolver front(finger, {}), back(finger, {});
  for (const double arc : {30.0, 65.0, 110.0, 139.0}) {
    for (const double friction : {0.0, 0.3}) {
      ASSERT_TRUE(front.Solve({{arc, 0.5, friction}}));
      ASSERT_TRUE(back.Solve({{arc, 0.5, friction, Side::kBack}}));
      const double bent = M_PI - front.tip_pose().z();
      EXPECT_GT(front.tip_pose().x(), 0.1);
      EXPECT_NEAR(back.tip_pose().x(), -front.tip_pose().x(), 1e-4);
      EXPECT_NEAR(back.tip_pose().y(), front.tip_pose().y(), 1e-4);
      EXPECT_NEAR(back.tip_pose().z(), bent, 1e-6);
      EXPECT_NEAR(back.contact_pose(0).x(), -front.contact_pose(0).x(), 1e-4);
      EXPECT_NEAR(back.gauge_angle(0), -front.gauge_angle(1), 1e-6);
      EXPECT_NEAR(back.gauge_angle(1), -front.gauge_angle(0), 1e-6);
    }
  }
}

TEST(RichBeamsTest, SensitivitiesMatchCentralDifferences) {
  const Finger finger = RichFinger();
  const int ribs = static_cast<int>(finger.ribs.size());
  for (const std::vector<PointContact>& contacts : kLoads) {
    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.SolveWithSensitivities(contacts));
    const int n = static_cast<int>(contacts.size());
    ASSERT_EQ(solver.d_outputs().cols(), 2 * n + 2 + ribs);
    for (int p = 0; p < 2 * n + 2 + ribs; ++p) {
      const bool load = p < 2 * n, arc = load && p % 2 == 0;
      const bool stiffness = !load && p < 2 * n + 2;
      const double step = arc ? 2e-3 : stiffness ? 5.0 : 1e-3;
      const auto outputs = [&](double move) {
        EquilibriumSolver moved(finger, {});
        std::vector<PointContact> loaded = contacts;
        if (load) {
          (arc ? loaded[p / 2].arc_mm : loaded[p / 2].normal_N) += move;
        } else if (stiffness) {
          moved.model().set_stiffness(
              finger.front_stiffness_N_mm2 + (p == 2 * n ? move : 0),
              finger.back_stiffness_N_mm2 + (p == 2 * n ? 0 : move));
        } else {
          const int rib = p - 2 * n - 2;
          moved.model().set_rib_length(rib, finger.ribs[rib].length_mm + move);
        }
        EXPECT_TRUE(moved.Solve(loaded));
        return moved.outputs();
      };
      const Eigen::VectorXd slope = (8 * (outputs(step) - outputs(-step)) -
                                     (outputs(2 * step) - outputs(-2 * step))) /
                                    (12 * step);
      const Eigen::VectorXd error = solver.d_outputs().col(p) - slope;
      // Angles and lengths apart, as they have no unit in common.
      double error_of[2] = {}, largest[2] = {};
      for (int i = 0; i < slope.size(); ++i) {
        const int k = i - solver.model().gauges();
        const int kind = k >= 0 && k % 3 != 2;
        error_of[kind] = std::max(error_of[kind], std::abs(error[i]));
        largest[kind] = std::max(largest[kind], std::abs(slope[i]));
      }
      EXPECT_LT(error_of[0], 1e-6 * largest[0]) << "column " << p;
      EXPECT_LT(error_of[1], 1e-6 * largest[1]) << "column " << p;
    }
  }
}

}  // namespace
}  // namespace finray

// The sweep against a dense solve of the same linear system, its matrix by
// differences of the evaluation; and one instruction set against the other.

#include "finray/ladder/ladder_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <vector>

#include "finray/ladder/instruction_set.h"
#include "finray/ladder/ladder_newton.h"
#include "finray/ladder/ladder_workspace.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

// A frame at a state that is no equilibrium.
class Fixture {
 public:
  Fixture(const Finger& finger, int resolution,
          const std::vector<PointContact>& contacts, double off)
      : model_(finger, {Scheme::kTaylor, resolution}), workspace_(model_) {
    EquilibriumSolver solver(finger, {Scheme::kTaylor, resolution});
    EXPECT_TRUE(solver.Solve(contacts));
    LadderState state = solver.state();
    for (auto& nodes : state.nodes) {
      for (Eigen::Index k = 1; k < nodes.cols(); ++k) {
        nodes.col(k).tail<4>() +=
            off * std::sin(3.0 * k) * Eigen::Vector4d(1, -1, 0.01, 50);
      }
    }
    state.q *= 1 + off;
    workspace_.SetContacts(model_, contacts);
    workspace_.Load(state);
  }

  LadderFrame<double>& frame() { return workspace_.frame(); }

  // Unknowns: q, then (x, y, theta, M) of every node but the bases.
  std::vector<double*> Unknowns(const LadderNodes<double>& z) {
    std::vector<double*> all;
    for (int i = 0; i < 6 + frame().ribs; ++i) all.push_back(z.q + i);
    for (int e = 1; e < frame().elements; ++e) {
      if (e == frame().front_elements) continue;
      for (double* field : {z.x, z.y, z.theta, z.moment}) {
        all.push_back(field + e);
      }
    }
    return all;
  }

  Eigen::VectorXd Residual(const LadderKernel& kernel) {
    LadderFrame<double>& f = frame();
    f.state.moment[0] = f.state.q[0];
    f.state.moment[f.front_elements] = f.state.q[3];
    kernel.evaluate(f, SweepColumns::kNone, false);
    std::vector<double> all(f.closure, f.closure + f.ribs + 6);
    for (int e = 1; e < f.elements; ++e) {
      if (e == f.front_elements) continue;
      all.insert(all.end(), f.gap + 4 * e, f.gap + 4 * e + 4);
    }
    return Eigen::Map<Eigen::VectorXd>(all.data(), all.size());
  }

  Eigen::VectorXd DenseStep(const LadderKernel& kernel) {
    const std::vector<double*> unknowns = Unknowns(frame().state);
    const Eigen::VectorXd residual = Residual(kernel);
    Eigen::MatrixXd jacobian(residual.size(), unknowns.size());
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      const double at = *unknowns[j], h = 1e-6 * std::max(1.0, std::abs(at));
      *unknowns[j] = at + h;
      const Eigen::VectorXd above = Residual(kernel);
      *unknowns[j] = at - h;
      jacobian.col(j) = (above - Residual(kernel)) / (2 * h);
      *unknowns[j] = at;
    }
    Residual(kernel);
    return -jacobian.fullPivLu().solve(residual);
  }

  Eigen::VectorXd SweptStep(const LadderKernel& kernel) {
    Residual(kernel);
    EXPECT_TRUE(kernel.sweep(frame(), SweepColumns::kNone, false));
    std::vector<double> step;
    for (const double* value : Unknowns(frame().step)) step.push_back(*value);
    return Eigen::Map<Eigen::VectorXd>(step.data(), step.size());
  }

 private:
  LadderModel model_;
  LadderWorkspace<double> workspace_;
};

double Difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(LadderKernelTest, SweepSolvesTheLinearSystem) {
  Finger elastic = PaperFinger();
  elastic.ribs[1].axial_stiffness_N = 500;
  elastic.back_stiffness_N_mm2 = 7000;
  Finger ribless = PaperFinger();
  ribless.ribs.clear();
  const struct {
    const char* name;
    Finger finger;
    std::vector<PointContact> contacts;
  } cases[] = {{"one contact", PaperFinger(), {{70, 3, 0}}},
               {"friction, on a rib and at the tip",
                elastic,
                {{61, 2, 0.4}, {140, 1, -0.2}}},
               {"two in an element, one on the back beam",
                elastic,
                {{50, 2, 0.1}, {50.5, 1, 0}, {80, 1, 0.2, Side::kBack}}},
               {"no ribs", ribless, {{70, 0.5, 0}}}};
  const LadderKernel& kernel = FindLadderKernel(Scheme::kTaylor, false);
  for (const auto& at : cases) {
    Fixture fixture(at.finger, 24, at.contacts, 1e-3);
    const double error =
        Difference(fixture.SweptStep(kernel), fixture.DenseStep(kernel));
    std::printf("%s: %.1e\n", at.name, error);
    EXPECT_LT(error, 1e-6) << at.name;
  }
}

// Without exchanges of parameters the columns would grow by exp(17) or so
// and the step would be lost.
TEST(LadderKernelTest, SweepIsStableWhereAMarchIsNot) {
  Finger soft = PaperFinger();
  soft.front_stiffness_N_mm2 = soft.back_stiffness_N_mm2 = 12.5;
  const LadderKernel& kernel = FindLadderKernel(Scheme::kTaylor, false);
  Fixture fixture(soft, 240, {{70, 0.2, 0}}, 1e-4);
  const Eigen::VectorXd swept = fixture.SweptStep(kernel);
  const double error = Difference(swept, fixture.DenseStep(kernel));
  std::printf("soft finger: %.1e\n", error);
  EXPECT_LT(error, 1e-5);
}

// Its rows have room for so many.
TEST(LadderKernelTest, DerivativesByManyContactsAreRefused) {
  LadderNewton newton(PaperFinger(), {});
  std::vector<PointContact> contacts;
  for (int c = 0; c < 6; ++c) contacts.push_back({20.0 + 15 * c, 0.5, 0});
  ASSERT_TRUE(newton.Converge(contacts, 1, SweepColumns::kNone));
  EXPECT_FALSE(newton.Converge(contacts, 1, SweepColumns::kContacts));
  contacts.resize(kFittedContacts);
  EXPECT_TRUE(newton.Converge(contacts, 1, SweepColumns::kContacts));
}

TEST(LadderKernelTest, InstructionSetsAgree) {
  for (const Scheme scheme :
       {Scheme::kRigidChain, Scheme::kTaylor4, Scheme::kTaylor}) {
    for (const bool stretch : {false, true}) {
      Fixture fixture(PaperFinger(), 24, {{70, 3, 0.1}}, 1e-3);
      const Eigen::VectorXd best =
          fixture.SweptStep(FindLadderKernel(scheme, stretch));
      for (int set = 1; set < InstructionSets(); ++set) {
        EXPECT_LT(Difference(
                      fixture.SweptStep(FindLadderKernel(scheme, stretch, set)),
                      best),
                  1e-11)
            << InstructionSetName(set);
      }
    }
  }
}

}  // namespace
}  // namespace finray

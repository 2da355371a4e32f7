// Single against double precision: the same kernel over float and double.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "finray/ladder/ladder_evaluate.h"
#include "finray/ladder/ladder_sweep.h"
#include "finray/ladder/ladder_workspace.h"
#include "finray/ladder/taylor_element.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

struct Outcome {
  Eigen::VectorXd gauges, ribs;
};

// Full Newton steps in T from the undeformed finger, until they end.
template <class T>
Outcome SolveIn(const Finger& finger, const PointContact& contact) {
  using Wide = TaylorElement<16, typename Lanes<T>::Vector>;
  const LadderModel model(finger, {Scheme::kTaylor, 24});
  LadderWorkspace<T> workspace(model);
  workspace.SetContacts(model, {contact});
  workspace.Load(LadderState::Undeformed(model));
  LadderFrame<T>& f = workspace.frame();
  LadderEvaluator<T, Wide, TaylorElement<16, T>> evaluator(&f,
                                                           SweepColumns::kNone);
  Outcome outcome{Eigen::VectorXd::Zero(model.gauges()), {}};
  for (int iteration = 0; iteration < 12; ++iteration) {
    evaluator.Evaluate(false);
    LadderSweeper<T, 0>(&f, SweepColumns::kNone, false).Run(true);
    const int count = 6 + f.ribs + 4 * f.elements;
    for (int i = 0; i < count; ++i) f.state.q[i] += f.step.q[i];
  }
  for (int i = 0; i < f.readout_count; ++i) {
    outcome.gauges[f.readouts[i].gauge] +=
        f.readouts[i].sign * (f.readout_map[kReadoutValues * i] +
                              f.taps[f.readout_tap(i) * f.stride + f.affine]);
  }
  LadderState state;
  workspace.Save(model, &state);
  outcome.ribs = state.q.tail(model.ribs());
  return outcome;
}

double Relative(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(PrecisionTest, SingleAgainstDouble) {
  const Finger finger = PaperFinger();
  std::printf(
      "| f_c, N | l_c, mm | gauges, float | ribs, float | gauges, double | "
      "ribs, double |\n|---|---|---|---|---|---|\n");
  double worst_middle = 0, worst_double = 0;
  for (const double force : {0.01, 0.1, 1.0, 5.0, 15.0}) {
    for (const double arc : {15.0, 70.0, 125.0}) {
      const PointContact contact = {arc, force, 0};
      EquilibriumSolver solver(finger, {Scheme::kTaylor, 48});
      ASSERT_TRUE(solver.Solve({contact}));
      const Eigen::VectorXd gauges = solver.outputs().head(4);
      const Eigen::VectorXd ribs = solver.state().q.tail(5);
      const Outcome single = SolveIn<float>(finger, contact);
      const Outcome both = SolveIn<double>(finger, contact);
      std::printf("| %g | %g | %.1e | %.1e | %.1e | %.1e |\n", force, arc,
                  Relative(single.gauges, gauges), Relative(single.ribs, ribs),
                  Relative(both.gauges, gauges), Relative(both.ribs, ribs));
      worst_double = std::max({worst_double, Relative(both.gauges, gauges),
                               Relative(both.ribs, ribs)});
      if (force >= 1 && arc == 70) {
        worst_middle = std::max(worst_middle, Relative(single.gauges, gauges));
      }
    }
  }
  EXPECT_LT(worst_double, 2e-9);
  EXPECT_LT(worst_middle, 1e-3);
  EXPECT_GT(worst_middle, 1e-8);  // it is single precision
}

}  // namespace
}  // namespace finray

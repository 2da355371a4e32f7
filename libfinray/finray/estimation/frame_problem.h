#ifndef FINRAY_ESTIMATION_FRAME_PROBLEM_H_
#define FINRAY_ESTIMATION_FRAME_PROBLEM_H_

#include <optional>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/residuals/frame_blocks.h"

namespace finray {

/// Solves for the contacts of one frame by ceres::Solve, on the residual blocks
/// that calibration uses too (residuals/frame_blocks.h). All parameters of the
/// finger are constant. It minimises
///
///   chi2(x) = sum_k |r_k(x)|^2,   0 <= l_c <= l_0, 0 <= f_c <= its bound.
///
/// x is (l_c, f_c) of each contact in the reduced form, and (base loads, rib
/// tensions, l_c, f_c of each contact) in the weighted one. FrameProblem is the
/// reference against which the default solver (RowFit) is tested.
class FrameProblem {
 public:
  /// Far above the chi2 that noise or a slightly wrong finger leaves. The solve
  /// of such a frame ends as soon as it makes little progress.
  static constexpr double kHopelessChi2 = 1e3;

  /// Throws InputError as LadderModel does.
  FrameProblem(const Finger& finger, const Scene& scene,
               const Discretization& discretization, EquilibriumForm form,
               double most_force_N);

  /// Solves from a start. Returns false if there is no equilibrium near the
  /// start or Ceres does not converge; `solution` is then undefined.
  bool Fit(const ContactStart& start, const Measurements& row,
           ContactSolution* solution);

  /// A fit that takes more Ceres iterations does not converge, and neither does
  /// one whose first equilibrium is far from that of its start: the way there
  /// has no bound.
  void set_most_iterations(int count) { most_iterations_ = count; }
  /// The friction of the contacts; the scene's at first.
  void set_friction(double friction) { friction_ = friction; }

  /// chi2 of the finger without a contact; infinite if it has no equilibrium.
  double FreeChi2(const Measurements& row);

  /// Number of Ceres iterations of the last Fit.
  int iterations() const { return iterations_; }

 private:
  // Adds the frame and makes its blocks at `unknowns_`.
  FrameEvaluation& Prepare(const Measurements& row, int contacts,
                           const LadderState& state, double weight);
  bool SetUnknowns(const ContactStart& start);
  bool Solve();
  bool Read(const ContactStart& start, const FrameEvaluation& frame,
            ContactSolution* solution);

  Finger finger_;
  MeasurementModel model_;
  double friction_, most_force_N_;
  bool camera_;
  EquilibriumForm form_;
  FingerParameters parameters_;
  FrameSet frames_;
  EquilibriumSolver
      solver_;  // finds the base loads that weighted fits start from
  std::vector<double> unknowns_;
  std::vector<FrameBlock> blocks_;
  std::optional<int> most_iterations_;
  int iterations_ = 0;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_FRAME_PROBLEM_H_

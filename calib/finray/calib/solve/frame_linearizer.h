#ifndef FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_
#define FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

#include "finray/calib/problem/calibration_blocks.h"
#include "finray/calib/solve/linearized_frame.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Evaluates frames one by one through their residual blocks, at the present
/// values of the parameters, which it only reads. One for each thread.
class FrameLinearizer {
 public:
  /// `blocks` and `parameters` must stay in place.
  FrameLinearizer(const EquilibriumSolver& solver, const Plan& plan,
                  const CalibrationBlocks* blocks,
                  const CalibrationParameters* parameters);

  /// Linearises the frame with its contact at (l_c, f_c) = `contact`, which a
  /// free frame does not use. Equilibrium starts from `*state` and is left
  /// there. Returns false if the model cannot be evaluated.
  bool Linearize(const CalibrationFrame& frame,
                 const std::array<double, 2>& contact, LadderState* state,
                 LinearizedFrame* out);

  /// Moves the contact to where it explains the frame best, the parameters
  /// being what they are: Gauss-Newton on l_c and f_c within their bounds,
  /// until a further step would lower chi2 / 2 by less than kSmallDecrease.
  /// LinearizedFrame::move knows the rest of the way well enough. Where the
  /// model cannot be evaluated it returns false and leaves `out` without rows.
  static constexpr double kSmallDecrease = 1e-5;
  bool FitContact(const CalibrationFrame& frame, std::array<double, 2>* contact,
                  LadderState* state, LinearizedFrame* out);

 private:
  // A frame's blocks and the evaluation at a contact that they read.
  struct Model;

  void Prepare(const CalibrationFrame& frame, const LadderState& start,
               Model* model);
  bool Evaluate(const std::array<double, 2>& contact, Model* model,
                LadderState* state, LinearizedFrame* out);
  bool FindContact(const CalibrationFrame& frame,
                   std::array<double, 2>* contact, LadderState* state,
                   LinearizedFrame* out);
  void AddBlock(const FrameBlock& block, const double* contact, int first_row,
                LinearizedFrame* out);

  EquilibriumSolver solver_;
  double friction_;
  const CalibrationBlocks& blocks_;
  const CalibrationParameters& parameters_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unordered_map<const double*, int> column_of_;  // first one of a block
  // By parameter of a block: its Jacobian, and the column that this goes to.
  std::vector<std::vector<double>> scratch_;
  std::vector<double*> jacobians_;
  std::vector<int> columns_;
  LinearizedFrame tried_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

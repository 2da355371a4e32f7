#ifndef FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_
#define FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "finray/calib/problem/calibration_blocks.h"
#include "finray/calib/solve/linearization.h"
#include "finray/residuals/model_surface.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Evaluates frames one by one through their residual blocks, at the present
/// values of the parameters. It does not change the parameters. Each thread has
/// one.
class FrameLinearizer {
 public:
  /// `blocks` and `parameters` must stay in place, and `surface` too unless it
  /// is null: the model at the present values, for frames that it serves.
  FrameLinearizer(const EquilibriumSolver& solver, const Plan& plan,
                  const CalibrationBlocks* blocks,
                  const CalibrationParameters* parameters,
                  const ModelSurface* surface = nullptr);

  /// Makes the state that the first solve of a frame's equilibrium starts from;
  /// an empty one for the undeformed finger. It is not called where the surface
  /// gives all values.
  using StartState = std::function<LadderState()>;

  /// Says whether a surface can serve the frame (FrameEvaluation::FitsSurface).
  static bool FitsSurface(const CalibrationFrame& frame,
                          const CalibrationParameters& parameters);

  /// Wherever it is, a contact without force is the free finger.
  static std::array<double, 2> FreeContact(const Finger& finger) {
    return {finger.front_length_mm / 2, 0};
  }

  /// Linearises the frame with its contact at (l_c, f_c) = `contact`. A free
  /// frame does not use `contact`. Returns false if the model cannot be
  /// evaluated.
  bool Linearize(const CalibrationFrame& frame,
                 const std::array<double, 2>& contact, const StartState& start,
                 LinearizedFrame* out);

  /// Moves the contact to where it explains the frame best with the present
  /// parameters, and linearises the frame there. It takes Gauss-Newton steps of
  /// l_c and f_c within their bounds, until a further step would lower chi2 / 2
  /// by less than kSmallDecrease, 0.04 std. LinearizedFrame::move tells the
  /// rest of the way well enough, and the next pass starts behind it. If the
  /// model cannot be evaluated, it returns false and leaves `out` without rows.
  static constexpr double kSmallDecrease = 1e-3;
  bool FitContact(const CalibrationFrame& frame, std::array<double, 2>* contact,
                  const StartState& start, LinearizedFrame* out);

 private:
  // The blocks of a frame, and the evaluation at a contact from which they
  // read.
  struct Model;

  void Prepare(const CalibrationFrame& frame, Model* model);
  // With `all` false, the derivatives by the parameters may be left undefined.
  bool Evaluate(const std::array<double, 2>& contact, bool all, Model* model,
                LinearizedFrame* out);
  bool TakeFromSurface(const std::array<double, 2>& contact, bool all,
                       FrameEvaluation* evaluation);
  bool Solve(const std::array<double, 2>& contact, Model* model);
  // The first column of each parameter of the index-th block of a frame.
  const std::vector<int>& ColumnsOf(const FrameBlock& block, std::size_t index);
  void AddBlock(const FrameBlock& block, const std::vector<int>& columns,
                const double* contact, bool all, LinearizedFrame* out);

  EquilibriumSolver solver_;
  double friction_;
  bool movable_gauges_;
  const CalibrationBlocks& blocks_;
  const CalibrationParameters& parameters_;
  const ModelSurface* surface_;
  std::unique_ptr<ceres::LossFunction> loss_;
  // The first column of a parameter block.
  std::unordered_map<const double*, int> column_of_;
  struct KnownColumns {
    std::vector<double*> parameters;
    std::vector<int> columns;
  };
  std::vector<KnownColumns> known_;  // by index of the block
  // For each parameter of a residual block: its Jacobian, where that does not
  // go straight to the rows, and its first column.
  std::vector<std::vector<double>> scratch_;
  std::vector<double*> jacobians_;
  std::vector<int> columns_;
  // Evaluations without and with a contact, for frames without pins and without
  // friction of their own; and that of another frame.
  std::array<std::optional<FrameEvaluation>, 2> usual_;
  std::optional<FrameEvaluation> unusual_;
  // The last contact stayed where it was. If the next one does too, the
  // derivatives by the parameters are best computed at once. Results do not
  // depend on it.
  bool settled_ = false;
  LinearizedFrame tried_;
  ModelSurface::Values values_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

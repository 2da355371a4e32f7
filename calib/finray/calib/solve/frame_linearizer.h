#ifndef FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_
#define FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "finray/calib/problem/calibration_blocks.h"
#include "finray/fit/frame_fit.h"

namespace finray {

/// Evaluates frames one by one through their residual blocks, at the present
/// values of the parameters. It does not change the parameters. Each thread has
/// one.
class FrameLinearizer {
 public:
  struct Options {
    /// The model at the present values, for frames that it serves; or null.
    const ModelSurface* surface = nullptr;
    /// No fit moves a contact to a larger force.
    double most_force_N = std::numeric_limits<double>::infinity();
    /// The plan's loss and the derivatives by the parameters. A guess needs
    /// neither.
    bool calibrates = true;
  };
  /// The objects behind the pointers must stay in place.
  FrameLinearizer(const EquilibriumSolver& solver, const Plan& plan,
                  const CalibrationBlocks* blocks,
                  const CalibrationParameters* parameters,
                  const Options& options);
  FrameLinearizer(const EquilibriumSolver& solver, const Plan& plan,
                  const CalibrationBlocks* blocks,
                  const CalibrationParameters* parameters)
      : FrameLinearizer(solver, plan, blocks, parameters, Options()) {}

  using StartState = FrameFit::StartState;

  /// Says whether a surface can serve the frame (FrameEvaluation::FitsSurface).
  static bool FitsSurface(const CalibrationFrame& frame,
                          const CalibrationParameters& parameters);

  /// Linearises the frame with its contact at (l_c, f_c) = `contact`. A free
  /// frame does not use `contact`. Returns false if the model cannot be
  /// evaluated.
  bool Linearize(const CalibrationFrame& frame,
                 const std::array<double, 2>& contact, const StartState& start,
                 LinearizedFrame* out);

  /// Moves the contact to where it explains the frame best with the present
  /// parameters, and linearises the frame there: FrameFit::Fit. The next pass
  /// starts behind LinearizedFrame::move. If the model cannot be evaluated, it
  /// returns false and leaves `out` without rows.
  bool FitContact(const CalibrationFrame& frame, std::array<double, 2>* contact,
                  const StartState& start, LinearizedFrame* out,
                  const FrameFit::Ending& ending = {});
  /// Says whether the last fit has ended as `ending` says.
  bool converged() const { return fit_.converged(); }

 private:
  static EquilibriumSolver WithEffects(EquilibriumSolver solver,
                                       const CalibrationParameters& parameters);
  static FrameFit::Shared SharedOf(const CalibrationParameters& parameters,
                                   const ceres::LossFunction* loss,
                                   const Options& options);
  FrameFit::Frame Prepare(const CalibrationFrame& frame,
                          const std::array<double, 2>& contact);

  double friction_;
  bool movable_gauges_;
  const CalibrationBlocks& blocks_;
  const CalibrationParameters& parameters_;
  std::unique_ptr<ceres::LossFunction> loss_;  // of fit_, so before it
  FrameFit fit_;
  // Evaluations without and with a contact, for frames without pins and without
  // friction of their own; and that of another frame.
  std::array<std::optional<FrameEvaluation>, 2> usual_;
  std::optional<FrameEvaluation> unusual_;
  std::vector<FrameBlock> frame_blocks_;
  // In one place for all frames, so that their blocks have the same parameters.
  std::array<double, 2> contact_{};
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_LINEARIZER_H_

#ifndef FINRAY_FIT_FRAME_FIT_H_
#define FINRAY_FIT_FRAME_FIT_H_

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "finray/fit/contact_step.h"
#include "finray/fit/linearized_frame.h"
#include "finray/model/finger_model.h"
#include "finray/residuals/frame_blocks.h"

namespace finray {

/// Fits the contacts of a frame to its residual blocks (frame_blocks.h), with
/// the parameters that the frames share as they are:
///
///   min over (l_c, f_c of each contact) of sum_i rho(|r_i|^2) / 2,
///   0 <= l_c <= l_0,  0 <= f_c <= its bound, or narrower bounds of a frame,
///
/// by Gauss and Newton with Levenberg's damping. It leaves the frame linearised
/// by the contacts and by the parameters, from which covariance, dx/dp and what
/// a calibration eliminates follow (LinearizedFrame). A fit of frames with the
/// same blocks allocates nothing once it has fitted one. Each thread has one.
class FrameFit {
 public:
  /// The parts of the problem that all frames share. The objects that it points
  /// to must stay in place.
  struct Shared {
    const SharedParameters* parameters = nullptr;
    /// The first column of a parameter block in LinearizedFrame::by_parameter,
    /// of the parameters that are free, and the number of columns.
    std::unordered_map<const double*, int> column_of = {};
    int columns = 0;
    /// The model at the present values, for frames that it serves; or null.
    const ModelSurface* surface = nullptr;
    const ceres::LossFunction* loss = nullptr;  ///< rho; null for |r|^2
    double most_force_N = std::numeric_limits<double>::infinity();
    bool solves = true;  ///< Equilibria, where the surface does not serve.
  };

  /// A frame in the reduced form: its blocks, and the evaluation and the
  /// contacts from which they read. A row of the test bench has no evaluation.
  struct Frame {
    const std::vector<FrameBlock>* blocks = nullptr;
    FrameEvaluation* evaluation = nullptr;
    double* contacts = nullptr;  ///< (l_c, f_c) of each
    /// In mm and N; the contacts are within. Null: those of all frames.
    const ContactBounds* bounds = nullptr;
  };

  using StartState = FingerModel::StartState;

  /// The effects of `solver` must be those of the parameters.
  FrameFit(EquilibriumSolver solver, Shared shared)
      : shared_(std::move(shared)),
        model_(std::move(solver), {shared_.parameters, shared_.surface,
                                   shared_.solves, shared_.columns > 0}) {}

  /// Linearises the frame with its contacts where they are, without
  /// LinearizedFrame::Eliminate. A free frame does not use the contacts.
  /// Returns false if the model cannot be evaluated.
  bool Linearize(const Frame& frame, const StartState& start,
                 LinearizedFrame* out);

  /// When a fit ends.
  struct Ending {
    /// A further step would lower the cost by less: 0.04 std by default.
    double small_decrease = kSmallDecrease;
    /// The step is smaller than this (LargestChange): where chi2 is flat, a far
    /// one lowers it by nothing.
    double small_change = std::numeric_limits<double>::infinity();
    int most_evaluations = 31;
    /// A fit that has used up its evaluations counts if the next step lowers
    /// the cost by less: along a curved valley, where the data hardly determine
    /// the contacts, steps do not end.
    double creeping = 0;
    /// The contacts take that step too. The frame stays linearised where it
    /// begins, with the cost that is expected at its end, and without the
    /// derivatives by the parameters. If false, LinearizedFrame::move says the
    /// rest of the way well enough within the bounds.
    bool takes_last_step = false;
  };
  static constexpr double kSmallDecrease = 1e-3;

  /// Moves the contacts to where they explain the frame best, and linearises
  /// the frame there. If the model cannot be evaluated, it returns false, and
  /// leaves `out` without rows and the contacts at the best ones. converged()
  /// says whether the fit has ended as `ending` says.
  bool Fit(const Frame& frame, const StartState& start, LinearizedFrame* out,
           const Ending& ending);
  bool Fit(const Frame& frame, const StartState& start, LinearizedFrame* out) {
    return Fit(frame, start, out, {});
  }
  bool converged() const { return converged_; }
  /// Evaluations of the model by the last fit.
  int evaluations() const { return evaluations_; }
  /// FingerModel::by_surface and error of the last evaluation.
  bool by_surface() const { return model_.by_surface(); }
  double error() const { return model_.error(); }

  /// The bounds of frames without their own, in mm and N.
  ContactBounds Bounds(int unknowns) const;
  EquilibriumSolver& solver() { return model_.solver(); }
  const EquilibriumSolver& solver() const { return model_.solver(); }

 private:
  // The parameters of a block and where their derivatives go.
  struct KnownBlock {
    std::vector<double*> parameters;
    std::vector<int> columns;  // the first one, or kNowhere
    int contacts;              // among the parameters; kNowhere if not there
    std::vector<double*> jacobians;
    std::vector<std::vector<double>> scratch;
  };

  // Moves the contacts from where the frame is linearised. `complete` says
  // whether `out` has the derivatives by the parameters.
  void Descend(const Frame& frame, const Ending& ending, bool* complete,
               LinearizedFrame* out);
  ContactVector UnitOf(int unknowns) const;  // mm and N
  // With `all` false, the derivatives by the parameters may be left undefined.
  bool Evaluate(const Frame& frame, bool all, LinearizedFrame* out);
  KnownBlock& Known(const Frame& frame, std::size_t index);
  void AddBlock(const FrameBlock& block, bool all, KnownBlock* known,
                LinearizedFrame* out);

  Shared shared_;
  FingerModel model_;
  std::vector<KnownBlock> known_;  // by index of the block

  // These belong to the fit under way.
  int evaluations_ = 0;
  bool converged_ = false;
  // The last contact stayed where it was. If the next one does too, the
  // derivatives by the parameters are best computed at once. Results do not
  // depend on it.
  bool settled_ = false;
  LinearizedFrame tried_;
};

}  // namespace finray

#endif  // FINRAY_FIT_FRAME_FIT_H_

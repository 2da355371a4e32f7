#ifndef FINRAY_FIT_FRAME_FIT_H_
#define FINRAY_FIT_FRAME_FIT_H_

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "finray/fit/linearized_frame.h"
#include "finray/residuals/frame_blocks.h"
#include "finray/residuals/model_surface.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Fits the contact of a frame to its residual blocks (frame_blocks.h), with
/// the parameters that the frames share as they are:
///
///   min over (l_c, f_c) of sum_i rho(|r_i|^2) / 2,
///   0 <= l_c <= l_0,  0 <= f_c,
///
/// by Gauss and Newton with Levenberg's damping. It leaves the frame linearised
/// by the contact and by the parameters, from which covariance, dx/dp and what
/// a calibration eliminates follow (LinearizedFrame). Each thread has one.
class FrameFit {
 public:
  /// What frames share. All that is pointed to must stay in place.
  struct Shared {
    const SharedParameters* parameters = nullptr;
    /// The first column of a parameter block in LinearizedFrame::by_parameter,
    /// of the parameters that are free, and the number of columns.
    std::unordered_map<const double*, int> column_of = {};
    int columns = 0;
    /// The model at the present values, for frames that it serves; or null.
    const ModelSurface* surface = nullptr;
    const ceres::LossFunction* loss = nullptr;  ///< rho; null for |r|^2
  };

  /// A frame with one contact or none, in the reduced form: its blocks, and the
  /// evaluation and the contact from which they read. A row of the test bench
  /// has no evaluation.
  struct Frame {
    std::vector<FrameBlock> blocks;
    FrameEvaluation* evaluation = nullptr;
    double* contact = nullptr;  ///< (l_c, f_c)
  };

  /// Makes the state that the first solve of a frame's equilibrium starts from,
  /// near the contact where the fit has come to; an empty one for the
  /// undeformed finger. It is not called where the surface gives all values.
  using StartState = std::function<LadderState(double arc_mm, double normal_N)>;

  /// The effects of `solver` must be those of the parameters.
  FrameFit(EquilibriumSolver solver, Shared shared)
      : solver_(std::move(solver)), shared_(std::move(shared)) {}

  /// Wherever it is, a contact without force is the free finger.
  static std::array<double, 2> FreeContact(const Finger& finger) {
    return {finger.front_length_mm / 2, 0};
  }

  /// Linearises the frame with its contact where frame.contact says. A free
  /// frame does not use it. Returns false if the model cannot be evaluated.
  bool Linearize(const Frame& frame, const StartState& start,
                 LinearizedFrame* out);

  /// Moves frame.contact until a further step would lower chi2 / 2 by less than
  /// kSmallDecrease, 0.04 std, and linearises the frame there. Within the
  /// bounds LinearizedFrame::move says the rest of the way well enough. If the
  /// model cannot be evaluated, it returns false, and leaves `out` without rows
  /// and the contact at the best one.
  static constexpr double kSmallDecrease = 1e-3;
  bool Fit(const Frame& frame, const StartState& start, LinearizedFrame* out);

  const EquilibriumSolver& solver() const { return solver_; }

 private:
  // Where the solves of a frame start, and whether the last evaluation needed
  // one.
  struct Solves {
    const StartState& start;
    Eigen::Vector2d best;  // contact
    std::optional<LadderState> near = {};
    LadderState reached = {};  // by the last solve
    bool by_surface = false;

    // The next solve starts where the last evaluation was.
    void Stay(const Frame& frame) {
      if (frame.evaluation != nullptr && !by_surface) std::swap(*near, reached);
    }
  };

  // With `all` false, the derivatives by the parameters may be left undefined.
  bool Evaluate(const Frame& frame, bool all, Solves* solves,
                LinearizedFrame* out);
  bool TakeFromSurface(const Frame& frame, bool all);
  bool Solve(const Frame& frame, Solves* solves);
  // The first column of each parameter of the index-th block of a frame.
  const std::vector<int>& ColumnsOf(const FrameBlock& block, std::size_t index);
  void AddBlock(const FrameBlock& block, const std::vector<int>& columns,
                const double* contact, bool all, LinearizedFrame* out);

  EquilibriumSolver solver_;
  Shared shared_;
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
  // The last contact stayed where it was. If the next one does too, the
  // derivatives by the parameters are best computed at once. Results do not
  // depend on it.
  bool settled_ = false;
  LinearizedFrame tried_;
  ModelSurface::Values values_;
};

}  // namespace finray

#endif  // FINRAY_FIT_FRAME_FIT_H_

#ifndef FINRAY_RESIDUALS_FRAME_RESIDUAL_H_
#define FINRAY_RESIDUALS_FRAME_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "finray/model/frame_evaluation.h"

namespace finray {

/// Base class of the residual blocks that depend on a frame's whole model.
/// Parameter blocks, in this order (blocks of size 0 are left out):
///
///   [frame unknowns | ln EI front (1) | ln EI back (1) | rib lengths (r) |
///    effects of the model | extra blocks of the derived class].
///
/// Evaluate() returns false if the frame has no equilibrium; Ceres then takes a
/// smaller step.
class FrameResidual : public ceres::CostFunction {
 protected:
  FrameResidual(const FrameEvaluation* frame, int residuals,
                std::initializer_list<int> extra_blocks = {});
  /// All extra blocks have one parameter.
  FrameResidual(const FrameEvaluation* frame, int residuals,
                std::size_t extra_blocks);

  /// Index of the first extra block.
  int extra_block() const { return extra_block_; }

  /// Copies one residual's derivatives, given by the columns of
  /// FrameEvaluation, into the Jacobian blocks that Ceres asked for.
  template <typename Row>
  void SpreadRow(int residual, const Eigen::MatrixBase<Row>& by_column,
                 double** jacobians) const {
    int column = 0;
    for (int block = 0; block < extra_block_; ++block) {
      const int size = parameter_block_sizes()[block];
      if (jacobians[block] != nullptr) {
        Eigen::Map<Eigen::RowVectorXd>(jacobians[block] + residual * size,
                                       size) = by_column.segment(column, size);
      }
      column += size;
    }
  }

  const FrameEvaluation& frame() const { return *frame_; }

 private:
  // Sets the sizes of the blocks before the extra ones.
  void SetSizes(int residuals, std::size_t extra_blocks);

  const FrameEvaluation* frame_;
  int extra_block_;
};

/// Returns the parameter pointers in the order of FrameResidual, for
/// AddResidualBlock.
std::vector<double*> FrameParameterBlocks(const FrameEvaluation& frame,
                                          double* unknowns,
                                          double* ln_front_stiffness,
                                          double* ln_back_stiffness,
                                          double* rib_lengths_mm,
                                          double* effects = nullptr);

}  // namespace finray

#endif  // FINRAY_RESIDUALS_FRAME_RESIDUAL_H_

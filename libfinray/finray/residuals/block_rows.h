#ifndef FINRAY_RESIDUALS_BLOCK_ROWS_H_
#define FINRAY_RESIDUALS_BLOCK_ROWS_H_

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "finray/residuals/frame_blocks.h"

namespace finray {

/// The stacked residuals of some blocks and their derivatives by chosen
/// parameter blocks. Parameters that Ceres holds constant can be chosen too.
struct BlockRows {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;  ///< residuals x columns

  /// Evaluates `blocks`. `column_of` maps a parameter block to the column of
  /// its first element; blocks that it does not name are left out. Returns
  /// false if a block cannot be evaluated.
  bool Evaluate(const std::vector<FrameBlock>& blocks,
                const std::unordered_map<const double*, int>& column_of,
                int columns);
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_BLOCK_ROWS_H_

#ifndef FINRAY_RESIDUALS_BLOCK_ROWS_H_
#define FINRAY_RESIDUALS_BLOCK_ROWS_H_

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "finray/residuals/frame_blocks.h"

namespace finray {

/// The residuals of some blocks, one below the other, and their derivatives by
/// chosen parameter blocks, whatever Ceres holds constant.
struct BlockRows {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;  ///< residuals x columns

  /// `column_of` maps a parameter block to the column of its first element;
  /// blocks that it does not name are left out. Returns false if a block cannot
  /// be evaluated.
  bool Evaluate(const std::vector<FrameBlock>& blocks,
                const std::unordered_map<const double*, int>& column_of,
                int columns);
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_BLOCK_ROWS_H_

#include "finray/residuals/block_rows.h"

namespace finray {

bool BlockRows::Evaluate(
    const std::vector<FrameBlock>& blocks,
    const std::unordered_map<const double*, int>& column_of, int columns) {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  int rows = 0;
  for (const FrameBlock& block : blocks) rows += block.cost->num_residuals();
  residuals.resize(rows);
  jacobian.setZero(rows, columns);
  int first = 0;
  for (const FrameBlock& block : blocks) {
    const auto& sizes = block.cost->parameter_block_sizes();
    const int size = block.cost->num_residuals();
    std::vector<RowMajor> by_block(sizes.size());
    std::vector<double*> pointers(sizes.size(), nullptr);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (column_of.count(block.parameters[k]) == 0) continue;
      by_block[k].resize(size, sizes[k]);
      pointers[k] = by_block[k].data();
    }
    if (!block.cost->Evaluate(block.parameters.data(), residuals.data() + first,
                              pointers.data())) {
      return false;
    }
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (pointers[k] == nullptr) continue;
      jacobian.block(first, column_of.at(block.parameters[k]), size, sizes[k]) =
          by_block[k];
    }
    first += size;
  }
  return residuals.allFinite();
}

}  // namespace finray

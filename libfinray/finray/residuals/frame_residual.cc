#include "finray/residuals/frame_residual.h"

namespace finray {

FrameResidual::FrameResidual(const FrameEvaluation* frame, int residuals,
                             std::initializer_list<int> extra_blocks)
    : frame_(frame) {
  SetSizes(residuals, extra_blocks.size());
  std::vector<int>* sizes = mutable_parameter_block_sizes();
  sizes->insert(sizes->end(), extra_blocks);
}

FrameResidual::FrameResidual(const FrameEvaluation* frame, int residuals,
                             std::size_t extra_blocks)
    : frame_(frame) {
  SetSizes(residuals, extra_blocks);
  std::vector<int>* sizes = mutable_parameter_block_sizes();
  sizes->resize(sizes->size() + extra_blocks, 1);
}

void FrameResidual::SetSizes(int residuals, std::size_t extra_blocks) {
  set_num_residuals(residuals);
  std::vector<int>* sizes = mutable_parameter_block_sizes();
  sizes->reserve(5 + extra_blocks);
  if (frame_->frame_size() > 0) sizes->push_back(frame_->frame_size());
  sizes->push_back(1);
  sizes->push_back(1);
  if (frame_->ribs() > 0) sizes->push_back(frame_->ribs());
  if (frame_->effects() > 0) sizes->push_back(frame_->effects());
  extra_block_ = static_cast<int>(sizes->size());
}

std::vector<double*> FrameParameterBlocks(
    const FrameEvaluation& frame, double* unknowns, double* ln_front_stiffness,
    double* ln_back_stiffness, double* rib_lengths_mm, double* effects) {
  std::vector<double*> blocks;
  if (frame.frame_size() > 0) blocks.push_back(unknowns);
  blocks.push_back(ln_front_stiffness);
  blocks.push_back(ln_back_stiffness);
  if (frame.ribs() > 0) blocks.push_back(rib_lengths_mm);
  if (frame.effects() > 0) blocks.push_back(effects);
  return blocks;
}

}  // namespace finray

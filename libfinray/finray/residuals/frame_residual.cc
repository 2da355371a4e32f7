#include "finray/residuals/frame_residual.h"

namespace finray {

FrameResidual::FrameResidual(const FrameEvaluation* frame, int residuals,
                             const std::vector<int>& extra_blocks)
    : frame_(frame) {
  set_num_residuals(residuals);
  std::vector<int>* sizes = mutable_parameter_block_sizes();
  sizes->reserve(5 + extra_blocks.size());
  if (frame->frame_size() > 0) sizes->push_back(frame->frame_size());
  sizes->push_back(1);
  sizes->push_back(1);
  if (frame->ribs() > 0) sizes->push_back(frame->ribs());
  if (frame->effects() > 0) sizes->push_back(frame->effects());
  extra_block_ = static_cast<int>(sizes->size());
  sizes->insert(sizes->end(), extra_blocks.begin(), extra_blocks.end());
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

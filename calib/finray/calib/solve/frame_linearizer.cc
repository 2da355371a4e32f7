#include "finray/calib/solve/frame_linearizer.h"

namespace finray {

FrameLinearizer::FrameLinearizer(const EquilibriumSolver& solver,
                                 const Plan& plan,
                                 const CalibrationBlocks* blocks,
                                 const CalibrationParameters* parameters,
                                 const Options& options)
    : friction_(parameters->friction()),
      movable_gauges_(plan.MovesGauges()),
      blocks_(*blocks),
      parameters_(*parameters),
      loss_(options.calibrates ? MakeLoss(plan) : nullptr),
      fit_(WithEffects(solver, *parameters),
           SharedOf(*parameters, loss_.get(), options)) {}

EquilibriumSolver FrameLinearizer::WithEffects(
    EquilibriumSolver solver, const CalibrationParameters& parameters) {
  solver.model().set_effects(parameters.shared.effects,
                             parameters.shared.friction_varies);
  return solver;
}

FrameFit::Shared FrameLinearizer::SharedOf(
    const CalibrationParameters& parameters, const ceres::LossFunction* loss,
    const Options& options) {
  FrameFit::Shared shared;
  shared.parameters = &parameters.shared;
  shared.surface = options.surface;
  shared.loss = loss;
  shared.most_force_N = options.most_force_N;
  if (!options.calibrates) return shared;
  shared.columns = static_cast<int>(parameters.free().size());
  for (int k = 0; k < shared.columns; ++k) {
    shared.column_of.emplace(parameters.FreeParameter(k).block, k);
  }
  return shared;
}

bool FrameLinearizer::FitsSurface(const CalibrationFrame& frame,
                                  const CalibrationParameters& parameters) {
  if (frame.IsBench() || !frame.pins.empty()) return false;
  const RowFriction row = parameters.FrictionOf(frame);
  return row.offset == 0 && row.slope == 1;
}

FrameFit::Frame FrameLinearizer::Prepare(const CalibrationFrame& frame,
                                         const std::array<double, 2>& contact) {
  contact_ = contact;
  FrameFit::Frame prepared;
  prepared.contacts = contact_.data();
  if (!frame.IsBench()) {
    const RowFriction row = parameters_.FrictionOf(frame);
    const bool usual = FitsSurface(frame, parameters_);
    auto& evaluation = usual ? usual_[frame.contact] : unusual_;
    if (!usual || !evaluation) {
      evaluation.emplace(fit_.solver().model(), EquilibriumForm::kReduced,
                         frame.contact ? 1 : 0, friction_, !frame.pins.empty(),
                         movable_gauges_, row);
    }
    prepared.evaluation = &*evaluation;
  }
  frame_blocks_ = blocks_.Of(frame, prepared.evaluation, prepared.contacts);
  prepared.blocks = &frame_blocks_;
  return prepared;
}

bool FrameLinearizer::Linearize(const CalibrationFrame& frame,
                                const std::array<double, 2>& contact,
                                const StartState& start, LinearizedFrame* out) {
  if (!fit_.Linearize(Prepare(frame, contact), start, out)) return false;
  out->Eliminate();
  return true;
}

bool FrameLinearizer::FitContact(const CalibrationFrame& frame,
                                 std::array<double, 2>* contact,
                                 const StartState& start, LinearizedFrame* out,
                                 const FrameFit::Ending& ending) {
  const bool evaluated = fit_.Fit(Prepare(frame, *contact), start, out, ending);
  *contact = contact_;
  return evaluated;
}

}  // namespace finray

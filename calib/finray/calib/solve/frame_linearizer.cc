#include "finray/calib/solve/frame_linearizer.h"

namespace finray {

FrameLinearizer::FrameLinearizer(const EquilibriumSolver& solver,
                                 const Plan& plan,
                                 const CalibrationBlocks* blocks,
                                 const CalibrationParameters* parameters,
                                 const ModelSurface* surface,
                                 double most_force_N)
    : friction_(parameters->friction()),
      movable_gauges_(plan.MovesGauges()),
      blocks_(*blocks),
      parameters_(*parameters),
      loss_(MakeLoss(plan)),
      fit_(WithEffects(solver, *parameters),
           {&parameters->shared, ColumnsOf(*parameters),
            static_cast<int>(parameters->free().size()), surface, loss_.get(),
            most_force_N}) {}

EquilibriumSolver FrameLinearizer::WithEffects(
    EquilibriumSolver solver, const CalibrationParameters& parameters) {
  solver.model().set_effects(parameters.shared.effects,
                             parameters.shared.friction_varies);
  return solver;
}

std::unordered_map<const double*, int> FrameLinearizer::ColumnsOf(
    const CalibrationParameters& parameters) {
  std::unordered_map<const double*, int> columns;
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    columns.emplace(parameters.FreeParameter(k).block, static_cast<int>(k));
  }
  return columns;
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

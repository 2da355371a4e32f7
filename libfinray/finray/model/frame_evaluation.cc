#include "finray/model/frame_evaluation.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/nan.h"

namespace finray {

FrameEvaluation::FrameEvaluation(const LadderModel& model, EquilibriumForm form,
                                 int contacts, double friction, bool pins,
                                 bool movable_gauges, RowFriction row)
    : form_(form),
      ribs_(model.ribs()),
      effects_(model.effect_columns()),
      gauges_(model.gauges()),
      contact_count_(contacts),
      by_friction_(model.by_friction()),
      loads_(contacts),
      length_mm_(model.finger().front_length_mm),
      back_length_mm_(BeamLength(model.finger(), Side::kBack)),
      state_(LadderState::Undeformed(model)) {
  set_friction(friction, row);
  if (pins) {
    for (const Rib& rib : model.finger().ribs) {
      loads_.push_back({rib.front_mm, 0, 0, Side::kFront, true});
      loads_.push_back({rib.back_mm, 0, 0, Side::kBack, true});
    }
    for (std::size_t e = 0; e < model.effects().size(); ++e) {
      const FingerParameter& effect = model.effects()[e];
      if (!IsHingePlace(effect.kind)) continue;
      const int back = effect.kind == FingerParameterKind::kBackHinge;
      moved_pins_.push_back(
          {contacts + 2 * effect.index + back, static_cast<int>(e)});
    }
  }
  if (!movable_gauges) return;
  ends_ = 2 * gauges_;
  by_place_.resize(gauges_);
  for (const Gauge& gauge : model.finger().gauges) {
    loads_.push_back({gauge.start_mm, 0, 0, gauge.beam, true});
    loads_.push_back(
        {gauge.start_mm + gauge.length_mm, 0, 0, gauge.beam, true});
  }
}

void FrameEvaluation::set_friction(double friction, RowFriction row) {
  row_friction_ = row;
  for (int c = 0; c < contacts(); ++c) {
    loads_[c].friction = row.At(friction);
  }
}

void FrameEvaluation::PlaceGauges(const double* starts_mm,
                                  const double* lengths_mm) {
  on_beam_ = true;
  for (int j = 0; j < ends_ / 2; ++j) {
    PointContact* const ends = &loads_[loads_.size() - ends_ + 2 * j];
    ends[0].arc_mm = starts_mm[j];
    ends[1].arc_mm = starts_mm[j] + lengths_mm[j];
    const double length =
        ends[0].side == Side::kFront ? length_mm_ : back_length_mm_;
    on_beam_ = on_beam_ && ends[0].arc_mm >= 0 && lengths_mm[j] > 0 &&
               ends[1].arc_mm <= length;
  }
}

void FrameEvaluation::Update(const double* frame,
                             const SharedParameters& shared,
                             EquilibriumSolver* solver) {
  PlaceGauges(shared.gauge_starts_mm.data(), shared.gauge_lengths_mm.data());
  Update(frame, shared.ln_front_stiffness, shared.ln_back_stiffness,
         shared.rib_lengths_mm.data(), shared.effect_values.data(), solver);
}

void FrameEvaluation::Update(const double* frame, double ln_front_stiffness,
                             double ln_back_stiffness,
                             const double* rib_lengths_mm,
                             const double* effects, EquilibriumSolver* solver) {
  valid_ = false;
  if (!on_beam_) return;
  const double front = std::exp(ln_front_stiffness);
  const double back = std::exp(ln_back_stiffness);
  if (!std::isnormal(front) || !std::isnormal(back)) return;
  solver->model().set_stiffness(front, back);
  for (int i = 0; i < ribs_; ++i) {
    if (!(rib_lengths_mm[i] > 0)) return;
    solver->model().set_rib_length(i, rib_lengths_mm[i]);
  }
  for (int i = 0; i < effects_; ++i) {
    if (!std::isfinite(effects[i])) return;
    if (i == friction_effect()) {
      for (int c = 0; c < contacts(); ++c) {
        loads_[c].friction = row_friction_.At(effects[i]);
      }
    } else if (!solver->model().set_effect(i, effects[i])) {
      return;
    }
  }
  MovePins(solver->model().finger());
  for (int i = 0; i < contacts(); ++i) {
    const double* contact = frame + contact_offset(i);
    if (!std::isfinite(contact[0]) || !std::isfinite(contact[1])) return;
    // Ceres holds l_c within its bounds only up to rounding.
    loads_[i].arc_mm = std::clamp(contact[0], 0.0, length_mm_);
    loads_[i].normal_N = contact[1];
  }
  if (form_ == EquilibriumForm::kReduced) {
    UpdateReduced(solver);
  } else {
    UpdateWeighted(frame, solver);
  }
  if (!valid_) return;
  // dy/d ln EI = EI dy/dEI
  for (Matrix* d : {&d_outputs_, &d_closure_}) {
    if (d->size() == 0) continue;
    d->col(frame_size()) *= front;
    d->col(frame_size() + 1) *= back;
    if (by_friction_) {
      d->col(effect_column() + friction_effect()) *= row_friction_.slope;
    }
  }
}

bool FrameEvaluation::FitsSurface() const {
  const auto loads = static_cast<int>(loads_.size());
  return form_ == EquilibriumForm::kReduced && contacts() <= 1 &&
         loads == contacts() + ends_ && row_friction_.offset == 0 &&
         row_friction_.slope == 1;
}

void FrameEvaluation::Take(const double* frame, const Eigen::VectorXd& outputs,
                           const Matrix& d_outputs,
                           const std::vector<Eigen::Vector2d>& by_place) {
  if (contacts() == 1) {
    loads_[0].arc_mm = std::clamp(frame[0], 0.0, length_mm_);
    loads_[0].normal_N = frame[1];
  }
  const int first = contact_row(contacts()), tip = tip_row();
  outputs_.resize(tip + 3);
  d_outputs_.resize(tip + 3, columns());
  const Eigen::Index told = std::min<Eigen::Index>(first, outputs.size());
  outputs_.head(told) = outputs.head(told);
  d_outputs_.topRows(told) = d_outputs.topRightCorner(told, columns());
  outputs_.segment(told, first - told).setConstant(kNaN);
  d_outputs_.middleRows(told, first - told).setConstant(kNaN);
  if (outputs.size() > contact_row(1)) {
    outputs_.tail<3>() = outputs.tail<3>();
    d_outputs_.bottomRows<3>() = d_outputs.bottomRightCorner(3, columns());
  } else {
    outputs_.tail<3>().setConstant(kNaN);
    d_outputs_.bottomRows<3>().setConstant(kNaN);
  }
  by_place_ = by_place;
  valid_ = true;
}

void FrameEvaluation::UpdateReduced(EquilibriumSolver* solver) {
  if (state_.q.size() > 0 && !from_solver_) solver->set_state(state_);
  from_solver_ = false;
  // Pins and the ends of gauges are loads too.
  const bool by_contacts =
      !by_parameter_ && static_cast<int>(loads_.size()) == contacts();
  valid_ = by_contacts ? solver->SolveByContacts(loads_)
                       : solver->SolveWithSensitivities(loads_);
  if (!valid_) return;  // the next trial starts from the last equilibrium
  solver->SaveState(&state_);
  outputs_ = solver->outputs();
  SetWithoutPins(solver->d_outputs(), &d_outputs_);
  ReadMovedGauges(solver->d_outputs());
}

void FrameEvaluation::UpdateWeighted(const double* frame,
                                     EquilibriumSolver* solver) {
  const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(frame, 6 + ribs_);
  LadderShot shot;
  valid_ = solver->Shoot(q, loads_, &shot);
  if (!valid_) return;
  outputs_ = shot.outputs;
  closure_ = shot.closure;
  SetWithoutPins(shot.d_outputs, &d_outputs_);
  ReadMovedGauges(shot.d_outputs);
  SetWithoutPins(shot.d_closure, &d_closure_);
  solver->SaveState(&state_);
}

// A gauge's angle is that between its ends.
void FrameEvaluation::ReadMovedGauges(const Matrix& derivatives) {
  const int loads = static_cast<int>(loads_.size());
  for (int j = 0; j < ends_ / 2; ++j) {
    const int start = loads - ends_ + 2 * j;
    const int row = contact_row(start) + 2,
              end_row = contact_row(start + 1) + 2;
    outputs_[j] = outputs_[end_row] - outputs_[row];
    d_outputs_.row(j) = d_outputs_.row(end_row) - d_outputs_.row(row);
    // The column of the start's place, and the curvature at both ends.
    const int column = frame_size() + 2 * (start - contacts());
    const double at_start = derivatives(row, column),
                 at_end = derivatives(end_row, column + 2);
    by_place_[j] = {at_end - at_start, at_end};
  }
}

// Drops the columns of the pins' places and forces from `derivatives`: both are
// fixed.
void FrameEvaluation::SetWithoutPins(const Matrix& derivatives,
                                     Matrix* target) const {
  if (derivatives.cols() == columns()) {
    *target = derivatives;
    return;
  }
  target->resize(derivatives.rows(), columns());
  if (derivatives.cols() == frame_size()) {  // by the contacts only
    target->setConstant(kNaN);
    target->leftCols(frame_size()) = derivatives;
    return;
  }
  *target << derivatives.leftCols(frame_size()),
      derivatives.rightCols(2 + ribs_ + effects_);
  for (const auto& [load, effect] : moved_pins_) {
    target->col(effect_column() + effect) +=
        derivatives.col(frame_size() + 2 * (load - contacts()));
  }
}

void FrameEvaluation::MovePins(const Finger& finger) {
  for (const auto& moved : moved_pins_) {
    const Rib& rib = finger.ribs[(moved[0] - contacts()) / 2];
    loads_[moved[0]].arc_mm = HingePlace(rib, loads_[moved[0]].side);
  }
}

}  // namespace finray

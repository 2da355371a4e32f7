#include "finray/calib/solve/frame_linearizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "finray/finger/geometry.h"
#include "finray/sensing/fast/contact_step.h"

namespace finray {
namespace {

constexpr int kMostSteps = 30;
constexpr double kMostDamping = 1e8;
// A step that lowers the cost by less is most often the last one, as the next
// one lowers it by a thousandth of that.
constexpr double kNearlyThere = 0.03;
// Columns for a Jacobian that belongs to no parameter.
constexpr int kContact = -1, kNowhere = -2;

}  // namespace

struct FrameLinearizer::Model {
  const StartState& start;
  std::array<double, 2> contact{};
  FrameEvaluation* evaluation = nullptr;  // none on the bench
  bool by_surface = false;                // the last one
  std::optional<LadderState> near = {};   // where solves start
  LadderState reached = {};               // by the last solve
  std::vector<FrameBlock> blocks = {};

  // The next solve starts where the last evaluation was.
  void Stay() {
    if (evaluation != nullptr && !by_surface) std::swap(*near, reached);
  }
};

FrameLinearizer::FrameLinearizer(const EquilibriumSolver& solver,
                                 const Plan& plan,
                                 const CalibrationBlocks* blocks,
                                 const CalibrationParameters* parameters,
                                 const ModelSurface* surface)
    : solver_(solver),
      friction_(parameters->friction()),
      movable_gauges_(plan.MovesGauges()),
      blocks_(*blocks),
      parameters_(*parameters),
      surface_(surface),
      loss_(MakeLoss(plan)) {
  solver_.model().set_effects(parameters_.shared.effects,
                              parameters_.shared.friction_varies);
  for (std::size_t k = 0; k < parameters_.free().size(); ++k) {
    column_of_.emplace(parameters_.FreeParameter(k).block, static_cast<int>(k));
  }
}

bool FrameLinearizer::FitsSurface(const CalibrationFrame& frame,
                                  const CalibrationParameters& parameters) {
  if (frame.IsBench() || !frame.pins.empty()) return false;
  const RowFriction row = parameters.FrictionOf(frame);
  return row.offset == 0 && row.slope == 1;
}

void FrameLinearizer::Prepare(const CalibrationFrame& frame, Model* model) {
  if (!frame.IsBench()) {
    const RowFriction row = parameters_.FrictionOf(frame);
    const bool usual = FitsSurface(frame, parameters_);
    auto& evaluation = usual ? usual_[frame.contact] : unusual_;
    if (!usual || !evaluation) {
      evaluation.emplace(solver_.model(), EquilibriumForm::kReduced,
                         frame.contact ? 1 : 0, friction_, !frame.pins.empty(),
                         movable_gauges_, row);
    }
    model->evaluation = &*evaluation;
  }
  model->blocks = blocks_.Of(frame, model->evaluation, model->contact.data());
}

bool FrameLinearizer::Linearize(const CalibrationFrame& frame,
                                const std::array<double, 2>& contact,
                                const StartState& start, LinearizedFrame* out) {
  Model model{start};
  Prepare(frame, &model);
  if (!Evaluate(contact, true, &model, out)) return false;
  out->Eliminate();
  return true;
}

bool FrameLinearizer::Solve(const std::array<double, 2>& contact,
                            Model* model) {
  if (!model->near) {
    model->near = model->start();
    // The solver drops the mesh that another frame has refined. Otherwise
    // results would depend on which thread had which frame. A state of the
    // table brings its mesh along.
    if (model->near->q.size() == 0) solver_.Reset();
  }
  model->evaluation->set_state(model->near->q.size() > 0
                                   ? *model->near
                                   : LadderState::Undeformed(solver_.model()));
  const SharedParameters& shared = parameters_.shared;
  model->evaluation->PlaceGauges(shared.gauge_starts_mm.data(),
                                 shared.gauge_lengths_mm.data());
  model->evaluation->Update(
      contact.data(), shared.ln_front_stiffness, shared.ln_back_stiffness,
      shared.rib_lengths_mm.data(), shared.effect_values.data(), &solver_);
  if (!model->evaluation->valid()) return false;
  model->reached = model->evaluation->state();
  return true;
}

bool FrameLinearizer::TakeFromSurface(const std::array<double, 2>& contact,
                                      bool all, FrameEvaluation* evaluation) {
  if (surface_ == nullptr || !evaluation->FitsSurface()) return false;
  const Finger& finger = solver_.model().finger();
  auto [arc_mm, normal_N] =
      evaluation->contacts() == 1 ? contact : FreeContact(finger);
  arc_mm = std::clamp(arc_mm, 0.0, finger.front_length_mm);
  if (!surface_->Evaluate(arc_mm, normal_N, all, &values_)) return false;
  evaluation->Take(contact.data(), values_.outputs, values_.d_outputs,
                   values_.by_place);
  return true;
}

bool FrameLinearizer::Evaluate(const std::array<double, 2>& contact, bool all,
                               Model* model, LinearizedFrame* out) {
  model->contact = contact;
  if (model->evaluation) {
    model->by_surface = TakeFromSurface(contact, all, model->evaluation);
    if (!model->by_surface && !Solve(contact, model)) return false;
  }
  all |= !model->by_surface;
  int rows = 0;
  for (const FrameBlock& block : model->blocks) {
    rows += block.cost->num_residuals();
  }
  out->rows.clear();
  out->residuals.resize(rows);
  out->weights.resize(rows);
  if (all) {
    out->by_parameter.setZero(
        rows, static_cast<Eigen::Index>(parameters_.free().size()));
  }
  out->by_contact.setZero(rows, 2);
  out->cost = 0;
  std::size_t index = 0;
  for (const FrameBlock& block : model->blocks) {
    AddBlock(block, ColumnsOf(block, index++), model->contact.data(), all, out);
  }
  return out->residuals.allFinite();
}

// Blocks of the frame before most often have the same parameters.
const std::vector<int>& FrameLinearizer::ColumnsOf(const FrameBlock& block,
                                                   std::size_t index) {
  if (known_.size() <= index) known_.resize(index + 1);
  KnownColumns& known = known_[index];
  if (known.parameters == block.parameters) return known.columns;
  known.parameters = block.parameters;
  known.columns.clear();
  for (const double* parameter : block.parameters) {
    const auto at = column_of_.find(parameter);
    known.columns.push_back(at == column_of_.end() ? kNowhere : at->second);
  }
  return known.columns;
}

void FrameLinearizer::AddBlock(const FrameBlock& block,
                               const std::vector<int>& columns,
                               const double* contact, bool all,
                               LinearizedFrame* out) {
  const int size = block.cost->num_residuals();
  const int first_row = static_cast<int>(out->rows.size());
  const auto& sizes = block.cost->parameter_block_sizes();
  scratch_.resize(std::max(scratch_.size(), sizes.size()));
  jacobians_.assign(sizes.size(), nullptr);
  columns_.assign(sizes.size(), kNowhere);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (block.parameters[k] == contact) {
      columns_[k] = kContact;
    } else if (all) {
      columns_[k] = columns[k];
    }
    if (columns_[k] == kNowhere) continue;
    if (size == 1 && columns_[k] != kContact) {
      jacobians_[k] = &out->by_parameter(first_row, columns_[k]);
      continue;
    }
    scratch_[k].resize(size * sizes[k]);
    jacobians_[k] = scratch_[k].data();
  }
  double* residuals = out->residuals.data() + first_row;
  if (!block.cost->Evaluate(block.parameters.data(), residuals,
                            jacobians_.data())) {
    out->residuals[first_row] = std::numeric_limits<double>::quiet_NaN();
  }
  const double square = out->residuals.segment(first_row, size).squaredNorm();
  double weight = 1;
  if (loss_ && std::isfinite(square)) {
    double rho[3];
    loss_->Evaluate(square, rho);
    weight = std::sqrt(rho[1]);
    out->cost += rho[0] / 2;
  } else {
    out->cost += square / 2;
  }
  for (int i = 0; i < size; ++i) {
    out->rows.push_back({block.family, block.gauge, block.std_V});
    out->weights[first_row + i] = weight;
  }
  if (all && size == 1 && weight != 1) {
    out->by_parameter.row(first_row) *= weight;
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (jacobians_[k] == nullptr) continue;
    const Eigen::Map<const LinearizedFrame::Rows> jacobian(jacobians_[k], size,
                                                           sizes[k]);
    if (columns_[k] == kContact) {
      out->by_contact.middleRows(first_row, size) = weight * jacobian;
    } else if (size > 1) {
      out->by_parameter.block(first_row, columns_[k], size, sizes[k]) =
          weight * jacobian;
    }
  }
}

bool FrameLinearizer::FitContact(const CalibrationFrame& frame,
                                 std::array<double, 2>* contact,
                                 const StartState& start,
                                 LinearizedFrame* out) {
  Model model{start};
  Prepare(frame, &model);
  if (!Evaluate(*contact, settled_, &model, out)) {
    out->rows.clear();
    return false;
  }
  model.Stay();
  const Finger& finger = solver_.model().finger();
  const Eigen::Vector2d unit(finger.front_length_mm, ForceUnit(finger));
  // The surface leaves the derivatives by the parameters to the last step.
  bool complete = settled_ || !model.by_surface;
  settled_ = true;
  double damping = 0;
  for (int step = 0; frame.contact && step < kMostSteps; ++step) {
    const Eigen::Matrix<double, Eigen::Dynamic, 2> slopes =
        out->by_contact * unit.asDiagonal();
    const ContactEquations equations{
        slopes.transpose() * slopes,
        slopes.transpose() * out->WeightedResiduals(), 2 * out->cost};
    const ContactVector x =
        Eigen::Vector2d((*contact)[0], (*contact)[1]).cwiseQuotient(unit);
    const ContactVector change = BoundedChange(
        equations, x, std::numeric_limits<double>::infinity(), damping);
    const double expected =
        -equations.gradient.dot(change) -
        0.5 * change.dot(ContactVector(equations.normal * change));
    if (!(expected > kSmallDecrease)) break;
    const std::array<double, 2> moved = {
        std::clamp(unit[0] * (x[0] + change[0]), 0.0, unit[0]),
        std::max(0.0, unit[1] * (x[1] + change[1]))};
    settled_ = false;
    const bool all = expected < kNearlyThere;
    if (Evaluate(moved, all, &model, &tried_) && tried_.cost < out->cost) {
      *contact = moved;
      model.Stay();
      std::swap(*out, tried_);
      complete = all || !model.by_surface;
      damping /= 10;
      if (damping < 1e-6) damping = 0;
      continue;
    }
    damping = std::max(1e-3, 10 * damping);
    if (damping > kMostDamping) break;  // as good as rounding allows
  }
  if (!complete && !Evaluate(*contact, true, &model, out)) {
    out->rows.clear();
    return false;
  }
  out->Eliminate();
  return true;
}

}  // namespace finray

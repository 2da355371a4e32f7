#include "finray/fit/frame_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/fit/contact_step.h"

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

bool FrameFit::Linearize(const Frame& frame, const StartState& start,
                         LinearizedFrame* out) {
  Solves solves{start, Eigen::Map<Eigen::Vector2d>(frame.contact)};
  if (!Evaluate(frame, true, &solves, out)) return false;
  out->Eliminate();
  return true;
}

bool FrameFit::Fit(const Frame& frame, const StartState& start,
                   LinearizedFrame* out) {
  Eigen::Map<Eigen::Vector2d> contact(frame.contact);
  Solves solves{start, contact};
  if (!Evaluate(frame, settled_, &solves, out)) {
    out->rows.clear();
    return false;
  }
  solves.Stay(frame);
  const Finger& finger = solver_.model().finger();
  const Eigen::Vector2d unit(finger.front_length_mm, ForceUnit(finger));
  const bool touches =
      frame.evaluation != nullptr && frame.evaluation->contacts() > 0;
  // The surface leaves the derivatives by the parameters to the last step.
  bool complete = settled_ || !solves.by_surface;
  settled_ = true;
  double damping = 0;
  for (int step = 0; touches && step < kMostSteps; ++step) {
    const Eigen::Matrix<double, Eigen::Dynamic, 2> slopes =
        out->by_contact * unit.asDiagonal();
    const ContactEquations equations{
        slopes.transpose() * slopes,
        slopes.transpose() * out->WeightedResiduals(), 2 * out->cost};
    const ContactVector x = solves.best.cwiseQuotient(unit);
    const ContactVector change = BoundedChange(
        equations, x, std::numeric_limits<double>::infinity(), damping);
    const double expected =
        -equations.gradient.dot(change) -
        0.5 * change.dot(ContactVector(equations.normal * change));
    if (!(expected > kSmallDecrease)) break;
    contact << std::clamp(unit[0] * (x[0] + change[0]), 0.0, unit[0]),
        std::max(0.0, unit[1] * (x[1] + change[1]));
    settled_ = false;
    const bool all = expected < kNearlyThere;
    if (Evaluate(frame, all, &solves, &tried_) && tried_.cost < out->cost) {
      solves.best = contact;
      solves.Stay(frame);
      std::swap(*out, tried_);
      complete = all || !solves.by_surface;
      damping /= 10;
      if (damping < 1e-6) damping = 0;
      continue;
    }
    damping = std::max(1e-3, 10 * damping);
    if (damping > kMostDamping) break;  // as good as rounding allows
  }
  contact = solves.best;
  if (!complete && !Evaluate(frame, true, &solves, out)) {
    out->rows.clear();
    return false;
  }
  out->Eliminate();
  return true;
}

bool FrameFit::Solve(const Frame& frame, Solves* solves) {
  if (!solves->near) {
    solves->near = solves->start(solves->best[0], solves->best[1]);
    // The solver drops the mesh that another frame has refined. Otherwise
    // results would depend on which thread had which frame. A state of the
    // table brings its mesh along.
    if (solves->near->q.size() == 0) solver_.Reset();
  }
  FrameEvaluation& evaluation = *frame.evaluation;
  evaluation.set_state(solves->near->q.size() > 0
                           ? *solves->near
                           : LadderState::Undeformed(solver_.model()));
  const SharedParameters& at = *shared_.parameters;
  evaluation.PlaceGauges(at.gauge_starts_mm.data(), at.gauge_lengths_mm.data());
  evaluation.Update(frame.contact, at.ln_front_stiffness, at.ln_back_stiffness,
                    at.rib_lengths_mm.data(), at.effect_values.data(),
                    &solver_);
  if (!evaluation.valid()) return false;
  solves->reached = evaluation.state();
  return true;
}

bool FrameFit::TakeFromSurface(const Frame& frame, bool all) {
  FrameEvaluation& evaluation = *frame.evaluation;
  if (shared_.surface == nullptr || !evaluation.FitsSurface()) return false;
  const Finger& finger = solver_.model().finger();
  auto [arc_mm, normal_N] =
      evaluation.contacts() == 1
          ? std::array<double, 2>{frame.contact[0], frame.contact[1]}
          : FreeContact(finger);
  arc_mm = std::clamp(arc_mm, 0.0, finger.front_length_mm);
  if (!shared_.surface->Evaluate(arc_mm, normal_N, all, &values_)) return false;
  evaluation.Take(frame.contact, values_.outputs, values_.d_outputs,
                  values_.by_place);
  return true;
}

bool FrameFit::Evaluate(const Frame& frame, bool all, Solves* solves,
                        LinearizedFrame* out) {
  if (frame.evaluation != nullptr) {
    solves->by_surface = TakeFromSurface(frame, all);
    if (!solves->by_surface && !Solve(frame, solves)) return false;
  }
  all |= !solves->by_surface;
  int rows = 0;
  for (const FrameBlock& block : frame.blocks) {
    rows += block.cost->num_residuals();
  }
  out->rows.clear();
  out->residuals.resize(rows);
  out->weights.resize(rows);
  if (all) {
    out->by_parameter.setZero(rows, shared_.columns);
  }
  out->by_contact.setZero(rows, 2);
  out->cost = 0;
  std::size_t index = 0;
  for (const FrameBlock& block : frame.blocks) {
    AddBlock(block, ColumnsOf(block, index++), frame.contact, all, out);
  }
  return out->residuals.allFinite();
}

// Blocks of the frame before most often have the same parameters.
const std::vector<int>& FrameFit::ColumnsOf(const FrameBlock& block,
                                            std::size_t index) {
  if (known_.size() <= index) known_.resize(index + 1);
  KnownColumns& known = known_[index];
  if (known.parameters == block.parameters) return known.columns;
  known.parameters = block.parameters;
  known.columns.clear();
  for (const double* parameter : block.parameters) {
    const auto at = shared_.column_of.find(parameter);
    known.columns.push_back(at == shared_.column_of.end() ? kNowhere
                                                          : at->second);
  }
  return known.columns;
}

void FrameFit::AddBlock(const FrameBlock& block,
                        const std::vector<int>& columns, const double* contact,
                        bool all, LinearizedFrame* out) {
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
  if (shared_.loss != nullptr && std::isfinite(square)) {
    double rho[3];
    shared_.loss->Evaluate(square, rho);
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

}  // namespace finray

#include "finray/fit/frame_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/fit/contact_step.h"

namespace finray {
namespace {

constexpr double kMostDamping = 1e8;
// A step that lowers the cost by less is most often the last one, as the next
// one lowers it by a thousandth of that.
constexpr double kNearlyThere = 0.03;
constexpr int kNowhere = -1;
// A contact is on a bound if it is nearer, in l_0 or in the largest force.
constexpr double kAtEnd = 1e-6;

int ContactsOf(const FrameFit::Frame& frame) {
  return frame.evaluation == nullptr ? 0 : frame.evaluation->contacts();
}

// S' r in these units, with the slopes of one linearisation and the residuals
// of another.
ContactVector GradientOf(const LinearizedFrame& slopes,
                         const LinearizedFrame& residuals,
                         const ContactVector& unit) {
  ContactVector gradient = ContactVector::Zero(unit.size());
  for (Eigen::Index i = 0; i < residuals.residuals.size(); ++i) {
    const double off = residuals.weights[i] * residuals.residuals[i];
    for (Eigen::Index k = 0; k < unit.size(); ++k) {
      gradient[k] += off * slopes.by_contact(i, k);
    }
  }
  gradient.array() *= unit.array();
  return gradient;
}

// The equations for a step of the contacts in these units.
ContactEquations EquationsOf(const LinearizedFrame& at,
                             const ContactVector& unit) {
  ContactEquations equations{at.Information(), GradientOf(at, at, unit),
                             2 * at.cost};
  equations.normal.array().colwise() *= unit.array();
  equations.normal.array().rowwise() *= unit.transpose().array();
  return equations;
}

// A step within the bounds, and by how much it lowers the cost.
struct Step {
  ContactVector change;
  double decrease;
};
Step StepOf(const ContactEquations& equations, const ContactVector& x,
            const ContactBounds& bounds, double damping) {
  const ContactVector change = BoundedChange(equations, x, bounds, damping);
  ContactVector bent = equations.normal * change;
  if (equations.curvature.size() > 0) bent += equations.curvature * change;
  return {change, -equations.gradient.dot(change) - 0.5 * change.dot(bent)};
}

bool IsPositive(const ContactMatrix& matrix) {
  return matrix.llt().info() == Eigen::Success;
}

// The next step, with `curvature` if the equations stay positive with it, and
// whether it is the last one. A step that is small only because B is wrong is
// not; B begins anew then.
Step NextStep(ContactEquations equations, const ContactVector& x,
              const ContactBounds& bounds, double damping,
              const FrameFit::Ending& ending, ContactMatrix* curvature,
              bool* last) {
  const auto is_small = [&](const Step& step) {
    return !(step.decrease > ending.small_decrease) &&
           LargestChange(step.change, x) < ending.small_change;
  };
  // Where the way there does not matter, a zero keeps the step from staying
  // near, as it does where B is unknown.
  if (ending.takes_last_step) {
    equations.curvature.setZero(x.size(), x.size());
  }
  const Step straight = StepOf(equations, x, bounds, damping);
  *last = is_small(straight);
  if (curvature->isZero(0) || !IsPositive(equations.normal + *curvature)) {
    return straight;
  }
  equations.curvature = *curvature;
  const Step curved = StepOf(equations, x, bounds, damping);
  if (*last || !is_small(curved)) return curved;
  curvature->setZero();
  return straight;
}

// A contact that is as good as on a bound is there.
ContactVector OnBounds(ContactVector contacts, const ContactVector& unit,
                       const ContactBounds& bounds) {
  for (int k = 0; k < contacts.size(); k += 2) {
    const double near = kAtEnd * unit[k];
    if (contacts[k] < bounds.low[k] + near) contacts[k] = bounds.low[k];
    if (contacts[k] > bounds.high[k] - near) contacts[k] = bounds.high[k];
    if (contacts[k + 1] > (1 - kAtEnd) * bounds.high[k + 1]) {
      contacts[k + 1] = bounds.high[k + 1];
    }
  }
  return contacts;
}

}  // namespace

bool FrameFit::Linearize(const Frame& frame, const StartState& start,
                         LinearizedFrame* out) {
  model_.Begin(start);
  evaluations_ = 0;
  return Evaluate(frame, true, out);
}

bool FrameFit::Fit(const Frame& frame, const StartState& start,
                   LinearizedFrame* out, const Ending& ending) {
  model_.Begin(start);
  evaluations_ = 0;
  const bool wants_all = !ending.takes_last_step;
  bool complete = wants_all && settled_;
  converged_ = false;
  if (!Evaluate(frame, complete, out)) {
    out->rows.clear();
    return false;
  }
  if (frame.evaluation != nullptr) model_.Stay(*frame.evaluation);
  // The surface leaves the derivatives by the parameters to the last step.
  complete |= !by_surface();
  settled_ = true;
  Descend(frame, ending, &complete, out);
  if (!wants_all) return true;
  if (!complete && !Evaluate(frame, true, out)) {
    out->rows.clear();
    return false;
  }
  out->Eliminate();
  return true;
}

void FrameFit::Descend(const Frame& frame, const Ending& ending, bool* complete,
                       LinearizedFrame* out) {
  const int unknowns = 2 * ContactsOf(frame);
  const bool wants_all = !ending.takes_last_step;
  Eigen::Map<Eigen::VectorXd> contacts(frame.contacts, unknowns);
  ContactVector best = contacts;
  const ContactVector unit = UnitOf(unknowns);
  const ContactBounds bounds =
      frame.bounds != nullptr ? *frame.bounds : Bounds(unknowns);
  const ContactBounds in_units{bounds.low.cwiseQuotient(unit),
                               bounds.high.cwiseQuotient(unit)};
  ContactMatrix curvature = ContactMatrix::Zero(unknowns, unknowns);
  double damping = 0;
  // The last trial was, and one since the last step had no values.
  bool rejected = false, failed = false;
  for (converged_ = unknowns == 0; !converged_;) {
    const ContactVector x = best.cwiseQuotient(unit);
    const ContactEquations equations = EquationsOf(*out, unit);
    const Step step = NextStep(equations, x, in_units, damping, ending,
                               &curvature, &converged_);
    if (converged_ && wants_all) break;
    for (int k = 0; k < unknowns; ++k) {
      const bool arc = k % 2 == 0;
      const double share = arc ? ArcShare(x[k + 1], step.change[k + 1]) : 1;
      contacts[k] = std::clamp(unit[k] * (x[k] + share * step.change[k]),
                               bounds.low[k], bounds.high[k]);
    }
    if (converged_) {
      out->cost = std::max(0.0, out->cost - step.decrease);
      best = contacts;
      break;
    }
    // One is kept for the end if the last one was rejected.
    if (evaluations_ + (rejected && !wants_all) >= ending.most_evaluations) {
      converged_ = step.decrease < ending.creeping;
      break;
    }
    settled_ = false;
    const bool all = wants_all && step.decrease < kNearlyThere;
    const bool evaluated = Evaluate(frame, all, &tried_);
    if (evaluated && tried_.cost < out->cost) {
      UpdateCurvature((contacts - best).cwiseQuotient(unit), equations.gradient,
                      GradientOf(*out, tried_, unit),
                      GradientOf(tried_, tried_, unit), &curvature);
      best = contacts;
      model_.Stay(*frame.evaluation);
      std::swap(*out, tried_);
      *complete = all || !by_surface();
      rejected = failed = false;
      damping /= 10;
      if (damping < 1e-6) damping = 0;
      continue;
    }
    rejected = true;
    failed |= !evaluated;
    damping = std::max(1e-3, 10 * damping);
    if (damping > kMostDamping) {
      converged_ = !failed;  // as good as rounding allows
      break;
    }
  }
  contacts = best;
  if (wants_all) return;
  // The evaluation is that of the contacts or of a step before.
  if (rejected && evaluations_ < ending.most_evaluations) {
    Evaluate(frame, false, &tried_);
  }
  contacts = OnBounds(best, unit, bounds);
}

ContactVector FrameFit::UnitOf(int unknowns) const {
  const Finger& finger = model_.finger();
  ContactVector unit(unknowns);
  for (int k = 0; k < unknowns; ++k) {
    unit[k] = k % 2 == 0 ? finger.front_length_mm : ForceUnit(finger);
  }
  return unit;
}

ContactBounds FrameFit::Bounds(int unknowns) const {
  ContactBounds bounds{ContactVector::Zero(unknowns), ContactVector(unknowns)};
  for (int k = 0; k < unknowns; ++k) {
    bounds.high[k] =
        k % 2 == 0 ? model_.finger().front_length_mm : shared_.most_force_N;
  }
  return bounds;
}

bool FrameFit::Evaluate(const Frame& frame, bool all, LinearizedFrame* out) {
  ++evaluations_;
  const bool modelled = frame.evaluation != nullptr;
  if (modelled && !model_.Evaluate(frame.contacts, all, frame.evaluation)) {
    return false;
  }
  all = shared_.columns > 0 && (all || !modelled || !by_surface());
  int rows = 0;
  for (const FrameBlock& block : *frame.blocks) {
    rows += block.cost->num_residuals();
  }
  out->rows.clear();
  out->residuals.resize(rows);
  out->weights.resize(rows);
  if (all || shared_.columns == 0) {
    out->by_parameter.setZero(rows, shared_.columns);
  }
  out->by_contact.setZero(rows, 2 * std::max(1, ContactsOf(frame)));
  out->cost = 0;
  for (std::size_t i = 0; i < frame.blocks->size(); ++i) {
    AddBlock((*frame.blocks)[i], all, &Known(frame, i), out);
  }
  return out->residuals.allFinite();
}

// Blocks of the frame before most often have the same parameters.
FrameFit::KnownBlock& FrameFit::Known(const Frame& frame, std::size_t index) {
  if (known_.size() <= index) known_.resize(index + 1);
  KnownBlock& known = known_[index];
  const std::vector<double*>& parameters = (*frame.blocks)[index].parameters;
  if (known.parameters == parameters) return known;
  known.parameters = parameters;
  known.columns.clear();
  known.contacts = kNowhere;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto at = shared_.column_of.find(parameters[k]);
    known.columns.push_back(at == shared_.column_of.end() ? kNowhere
                                                          : at->second);
    if (parameters[k] == frame.contacts) known.contacts = static_cast<int>(k);
  }
  known.jacobians.assign(parameters.size(), nullptr);
  known.scratch.resize(std::max(known.scratch.size(), parameters.size()));
  return known;
}

void FrameFit::AddBlock(const FrameBlock& block, bool all, KnownBlock* known,
                        LinearizedFrame* out) {
  const int size = block.cost->num_residuals();
  const auto first_row = static_cast<Eigen::Index>(out->rows.size());
  const auto& sizes = block.cost->parameter_block_sizes();
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    double*& jacobian = known->jacobians[k];
    jacobian = nullptr;
    if (static_cast<int>(k) == known->contacts) {
      jacobian = &out->by_contact(first_row, 0);
    } else if (all && known->columns[k] != kNowhere) {
      known->scratch[k].resize(static_cast<std::size_t>(size * sizes[k]));
      jacobian = size == 1 ? &out->by_parameter(first_row, known->columns[k])
                           : known->scratch[k].data();
    }
  }
  if (!block.cost->Evaluate(block.parameters.data(),
                            out->residuals.data() + first_row,
                            known->jacobians.data())) {
    out->residuals[first_row] = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t k = 0; all && size > 1 && k < sizes.size(); ++k) {
    if (known->columns[k] == kNowhere || known->jacobians[k] == nullptr ||
        static_cast<int>(k) == known->contacts) {
      continue;
    }
    out->by_parameter.block(first_row, known->columns[k], size, sizes[k]) =
        Eigen::Map<const LinearizedFrame::Rows>(known->jacobians[k], size,
                                                sizes[k]);
  }
  const double square = out->residuals.segment(first_row, size).squaredNorm();
  double weight = 1;
  if (shared_.loss != nullptr && std::isfinite(square)) {
    double rho[3];
    shared_.loss->Evaluate(square, rho);
    weight = std::sqrt(rho[1]);
    out->cost += rho[0] / 2;
    out->by_contact.middleRows(first_row, size) *= weight;
    if (all) out->by_parameter.middleRows(first_row, size) *= weight;
  } else {
    out->cost += square / 2;
  }
  for (int i = 0; i < size; ++i) {
    out->rows.push_back({block.family, block.gauge, block.std_V});
    out->weights[first_row + i] = weight;
  }
}

}  // namespace finray

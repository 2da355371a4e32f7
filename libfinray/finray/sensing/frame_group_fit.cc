#include "finray/sensing/frame_group_fit.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Frames that take longer are fitted alone, without three others waiting.
constexpr int kMostIterations = 6;

}  // namespace

FrameGroupFit::FrameGroupFit(const Finger& finger,
                             const Discretization& discretization,
                             double friction)
    : lanes_(finger, discretization, friction),
      alone_(finger, discretization),
      friction_(friction),
      adaptive_(discretization.adaptive()),
      contact_(1) {
  const int gauges = lanes_.model().gauges();
  reading_.resize(gauges);
  for (auto& slope : slopes_) slope.resize(gauges);
  kept_state_.resize(lanes_.state_size());
  angles_.resize(gauges);
  weights_.resize(gauges);
}

void FrameGroupFit::set_tolerance(double relative) {
  tolerance_ = relative;
  alone_.set_tolerance(relative);
}

void FrameGroupFit::set_most_force(double force_N) {
  most_force_N_ = force_N;
  alone_.set_most_force(force_N);
}

void FrameGroupFit::Start(const LadderState& state,
                          const PointContact& contact) {
  one_by_one_ = false;
  for (int lane = 0; lane < kFrameLanes; ++lane) {
    one_by_one_ |= !lanes_.Load(state, lane);
  }
  arc_mm_.fill(contact.arc_mm);
  normal_N_.fill(contact.normal_N);
  linearised_ = 0;
  newton_ = FourFrames{};
  state_ = state;
  contact_[0] = {contact.arc_mm, contact.normal_N, friction_};
  alone_.set_state(state);
}

void FrameGroupFit::Fit(const Columns& angles_rad,
                        const Columns& weights_per_rad, FrameFit* fits) {
  const int count = static_cast<int>(angles_rad.cols());
  for (int first = 0; first < count; first += kFrameLanes) {
    const int frames = std::min(kFrameLanes, count - first);
    if (!one_by_one_) {
      FitGroup(angles_rad.middleCols(first, frames),
               weights_per_rad.middleCols(first, frames), fits + first);
      continue;
    }
    for (int i = first; i < first + frames; ++i) {
      FitAlone(angles_rad, weights_per_rad, i, fits + i);
    }
  }
}

// Where there are less frames than lanes, the last one fills them.
void FrameGroupFit::FitGroup(const Columns& angles_rad,
                             const Columns& weights_per_rad, FrameFit* fits) {
  const int frames = static_cast<int>(angles_rad.cols());
  const double length = lanes_.workspace().length_unit();
  const double force = lanes_.workspace().force_unit();
  const BeamMesh& mesh = lanes_.model().mesh(Side::kFront);
  Keep();
  LaneSet active = kAllFrameLanes, converged = 0;
  const auto give_up = [&](int lane) {
    active &= ~(1u << lane);
    RestoreLane(lane);
  };
  Numbers last_cost, last_change;
  last_cost.fill(std::numeric_limits<double>::infinity());
  last_change.fill(1);
  const bool predict = linearised_ == kAllFrameLanes;
  for (int iteration = predict ? 0 : 1;
       iteration <= kMostIterations && active != 0; ++iteration) {
    const bool predicts = iteration == 0;
    if (!predicts) {
      // Lanes that have converged come along to be where the next group starts.
      linearised_ =
          lanes_.Place(arc_mm_, normal_N_, active | converged, active);
      active &= linearised_;
      if (active == 0) break;
      if (!lanes_.Linearize()) {
        linearised_ = active = 0;
        break;
      }
      newton_ = FourFrames{} + 1.0;
      ReadGauges();
    }
    FourFrames newton{}, share{}, steps[2] = {};
    ContactEquations equations[kFrameLanes];
    ContactVector x[kFrameLanes], change[kFrameLanes];
    for (int lane = 0; lane < kFrameLanes; ++lane) {
      if (!Has(active, lane)) continue;
      const int frame = std::min(lane, frames - 1);
      equations[lane] = EquationsOf(lane, angles_rad.col(frame).data(),
                                    weights_per_rad.col(frame).data());
      const double cost = equations[lane].chi2;
      // Written so that a NaN fails.
      if (!(cost <= kMostRise * last_cost[lane] + 1)) {
        give_up(lane);
        continue;
      }
      last_cost[lane] = cost;
      x[lane].resize(2);
      x[lane] << arc_mm_[lane] / length, normal_N_[lane] / force;
      change[lane] =
          BoundedChange(equations[lane], x[lane], most_force_N_ / force, 0);
      newton[lane] = newton_[lane];
      for (int k = 0; k < 2; ++k) steps[k][lane] = change[lane][k];
    }
    lanes_.Step(newton, steps);
    FourFrames size;
    lanes_.Size(&size);
    for (int lane = 0; lane < kFrameLanes; ++lane) {
      if (!Has(active, lane)) continue;
      share[lane] = 1;
      newton_[lane] = 0;
    }
    lanes_.Move(share);
    for (int lane = 0; lane < kFrameLanes; ++lane) {
      if (Has(active, lane) && !(size[lane] <= kMaxTurn_rad)) give_up(lane);
    }
    for (std::size_t j = 0; j < reading_.size(); ++j) {
      reading_[j] += slopes_[0][j] * steps[0] + slopes_[1][j] * steps[1];
    }
    for (int lane = 0; lane < kFrameLanes; ++lane) {
      if (!Has(active, lane)) continue;
      const double moved = LargestChange(change[lane], x[lane], size[lane]);
      const int before = mesh.Locate(arc_mm_[lane]).element;
      arc_mm_[lane] =
          std::clamp(arc_mm_[lane] + change[lane][0] * length, 0.0, length);
      normal_N_[lane] =
          std::max(0.0, normal_N_[lane] + change[lane][1] * force);
      const bool crossed = mesh.Locate(arc_mm_[lane]).element != before;
      const bool last = !predicts && IsLastChange(moved, last_change[lane],
                                                  crossed, tolerance_);
      last_change[lane] = moved;
      if (!last) continue;
      active &= ~(1u << lane);
      if (!IsResolved(lane)) continue;
      converged |= 1u << lane;
      if (lane >= frames) continue;
      fits[lane].iterations = iteration;
      Record(lane, angles_rad.col(lane).data(),
             weights_per_rad.col(lane).data(), change[lane],
             equations[lane].normal, fits + lane);
    }
  }
  for (int lane = 0; lane < kFrameLanes; ++lane) {
    if (Has(converged, lane)) continue;
    RestoreLane(lane);
    if (lane >= frames) continue;
    if (one_by_one_) {
      FitAlone(angles_rad, weights_per_rad, lane, fits + lane);
    } else {
      FitLane(angles_rad, weights_per_rad, lane, fits + lane);
    }
  }
}

// Of the state at the end of Newton's step, in all lanes.
void FrameGroupFit::ReadGauges() {
  const LadderFrame<FourFrames>& f = lanes_.frame();
  for (std::vector<FourFrames>* of : {&reading_, &slopes_[0], &slopes_[1]}) {
    std::fill(of->begin(), of->end(), FourFrames{});
  }
  for (int i = 0; i < f.readout_count; ++i) {
    const int j = f.readouts[i].gauge;
    const double sign = f.readouts[i].sign;
    const FourFrames* tap = f.taps + f.readout_tap(i) * f.stride + f.affine;
    reading_[j] += sign * (f.readout_map[kReadoutValues * i] + tap[0]);
    for (int k = 0; k < 2; ++k) slopes_[k][j] += sign * tap[1 + k];
  }
}

ContactEquations FrameGroupFit::EquationsOf(int lane, const double* angle,
                                            const double* weight) const {
  double normal[2][2] = {}, gradient[2] = {}, chi2 = 0;
  for (std::size_t j = 0; j < reading_.size(); ++j) {
    const double residual = weight[j] * (reading_[j][lane] - angle[j]);
    const double slope[2] = {weight[j] * slopes_[0][j][lane],
                             weight[j] * slopes_[1][j][lane]};
    chi2 += residual * residual;
    for (int k = 0; k < 2; ++k) {
      gradient[k] += slope[k] * residual;
      for (int l = 0; l < 2; ++l) normal[k][l] += slope[k] * slope[l];
    }
  }
  ContactEquations equations{ContactMatrix(2, 2), ContactVector(2), chi2};
  equations.normal << normal[0][0], normal[0][1], normal[1][0], normal[1][1];
  equations.gradient << gradient[0], gradient[1];
  return equations;
}

// Whether the series of the last linearisation had converged.
bool FrameGroupFit::IsResolved(int lane) const {
  if (!adaptive_) return true;
  const LadderFrame<FourFrames>& f = lanes_.frame();
  double worst = 0;
  for (int slot = 0; slot < f.slots(); ++slot) {
    worst = std::max(worst, f.truncation[slot][lane]);
  }
  return worst < kRefinedTruncation_rad;
}

// What was linear in the last change is brought to its end.
void FrameGroupFit::Record(int lane, const double* angle, const double* weight,
                           const ContactVector& change,
                           const ContactMatrix& normal, FrameFit* fit) const {
  const LadderFrame<FourFrames>& f = lanes_.frame();
  const double length = lanes_.workspace().length_unit();
  const double force = lanes_.workspace().force_unit();
  fit->converged = fit->in_lanes = true;
  fit->arc_mm = arc_mm_[lane];
  fit->normal_N = normal_N_[lane];
  fit->information << normal(0, 0) / (length * length),
      normal(0, 1) / (length * force), normal(1, 0) / (length * force),
      normal(1, 1) / (force * force);
  fit->chi2 = 0;
  for (std::size_t j = 0; j < reading_.size(); ++j) {
    const double residual = weight[j] * (reading_[j][lane] - angle[j]);
    fit->chi2 += residual * residual;
  }
  const auto moved = [&](const FourFrames& from, int tap) {
    const FourFrames* row = f.taps + tap * f.stride + f.affine;
    return from[lane] + row[0][lane] + row[1][lane] * change[0] +
           row[2][lane] * change[1];
  };
  const int contact = lanes_.contact_of(lane), slot = f.elements + contact;
  const int at = f.contact_tap(contact), tip = f.tip_tap();
  fit->contact_pose << length * moved(f.slot_x[slot], at),
      length * moved(f.slot_y[slot], at + 1), moved(f.slot_theta[slot], at + 2);
  fit->tip_pose << length * moved(f.tip[0], tip),
      length * moved(f.tip[1], tip + 1), moved(f.tip[2], tip + 2);
  fit->rib_tension_N.resize(f.ribs);
  for (int i = 0; i < f.ribs; ++i) {
    fit->rib_tension_N[i] = f.state.q[6 + i][lane] * force;
  }
}

void FrameGroupFit::Keep() {
  const FourFrames* state = lanes_.frame().state.q;
  std::copy(state, state + lanes_.state_size(), kept_state_.begin());
  kept_arc_mm_ = arc_mm_;
  kept_normal_N_ = normal_N_;
}

// Back to where the group started from.
void FrameGroupFit::RestoreLane(int lane) {
  FourFrames* state = lanes_.frame().state.q;
  for (std::size_t i = 0; i < kept_state_.size(); ++i) {
    state[i][lane] = kept_state_[i][lane];
  }
  arc_mm_[lane] = kept_arc_mm_[lane];
  normal_N_[lane] = kept_normal_N_[lane];
  linearised_ &= ~(1u << lane);
}

// A lane's frame without the others, from where the lane stands.
void FrameGroupFit::FitLane(const Columns& angles_rad,
                            const Columns& weights_per_rad, int lane,
                            FrameFit* fit) {
  lanes_.Save(&state_, lane);
  alone_.set_state(state_);
  contact_[0] = {arc_mm_[lane], normal_N_[lane], friction_};
  FitAlone(angles_rad, weights_per_rad, lane, fit);
  if (!fit->converged) return;
  one_by_one_ = !lanes_.Load(state_, lane);
  arc_mm_[lane] = fit->arc_mm;
  normal_N_[lane] = fit->normal_N;
}

// From the last frame that was fitted so.
void FrameGroupFit::FitAlone(const Columns& angles_rad,
                             const Columns& weights_per_rad, int frame,
                             FrameFit* fit) {
  const PointContact before = contact_[0];
  angles_ = angles_rad.col(frame);
  weights_ = weights_per_rad.col(frame);
  fit->in_lanes = false;
  fit->converged = alone_.Follow(angles_, weights_, &contact_);
  fit->iterations = alone_.iterations();
  if (!fit->converged) {
    alone_.set_state(state_);
    contact_[0] = before;
    return;
  }
  alone_.SaveState(&state_);
  fit->arc_mm = contact_[0].arc_mm;
  fit->normal_N = contact_[0].normal_N;
  fit->information = alone_.information();
  fit->chi2 = alone_.chi2();
  fit->contact_pose = alone_.contact_pose(0);
  fit->tip_pose = alone_.tip_pose();
  fit->rib_tension_N.resize(lanes_.model().ribs());
  for (int i = 0; i < lanes_.model().ribs(); ++i) {
    fit->rib_tension_N[i] = alone_.rib_tension(i);
  }
}

}  // namespace finray

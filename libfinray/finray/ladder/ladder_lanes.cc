#include "finray/ladder/ladder_lanes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "finray/finger/geometry.h"

namespace finray {

template <class T>
LadderLanes<T>::LadderLanes(const Finger& finger,
                            const Discretization& discretization,
                            double friction)
    : model_(finger, discretization),
      workspace_(model_),
      kernel_(FindFramesKernel<T>(discretization.scheme, Stretches(finger))),
      friction_(friction) {
  if (kernel_ == nullptr) {
    throw std::invalid_argument("this machine has no kernel with " +
                                std::to_string(kLanes) + " lanes");
  }
  // Takes memory for kMostContacts contacts and for the columns of one.
  workspace_.SetContacts(model_, std::vector<PointContact>(kMostContacts));
  workspace_.SetContacts(model_, {PointContact()}, 1, SweepColumns::kContacts);
  workspace_.Load(LadderState::Undeformed(model_));
}

template <class T>
bool LadderLanes<T>::Load(const LadderState& state, int lane) {
  if (!state.IsOnMeshOf(model_)) return false;
  workspace_.Load(state, lane);
  return true;
}

template <class T>
LaneSet LadderLanes<T>::Place(const std::array<double, kLanes>& arc_mm,
                              const std::array<double, kLanes>& normal_N,
                              LaneSet wanted, LaneSet first) {
  LadderFrame<T>& f = workspace_.frame();
  const BeamMesh& mesh = model_.mesh(Side::kFront);
  LaneSet placed = 0;
  int count = 0, leader = -1;
  int element[kLanes] = {};
  for (const LaneSet set : {wanted & first, wanted & ~first}) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!Has(set, lane)) continue;
      element[lane] = mesh.Locate(arc_mm[lane]).element;
      int c = 0;
      while (c < count && f.contacts[c].element != element[lane]) ++c;
      if (c == kMostContacts) continue;
      if (c == count) f.contacts[count++].element = element[lane];
      if (leader < 0) leader = lane;
      placed |= 1u << lane;
    }
  }
  if (placed == 0) return 0;
  if (count == 2 && f.contacts[0].element > f.contacts[1].element) {
    std::swap(f.contacts[0].element, f.contacts[1].element);
  }
  f.contact_count = count;
  for (int c = 0; c < count; ++c) {
    LadderContact<T>& contact = f.contacts[c];
    const double start = mesh.nodes_mm[contact.element];
    const double length = mesh.nodes_mm[contact.element + 1] - start;
    const auto offset = [&](int lane) {
      return std::clamp(arc_mm[lane] - start, 0.0, length) /
             workspace_.length_unit();
    };
    // All lanes must read a gauge on the same side of the contact.
    for (int i = 0; i < f.readout_count; ++i) {
      if (f.readouts[i].element != contact.element) continue;
      const double at = f.readouts[i].offset[0];
      for (int lane = 0; lane < kLanes; ++lane) {
        if ((offset(lane) <= at) != (offset(leader) <= at)) {
          placed &= ~(1u << lane);
        }
      }
    }
    contact.side = 0;
    contact.index = c;
    contact.columns = 0;
    contact.d_normal = T{};
    contact.lift = f.lift[0];
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool present =
          Has(placed, lane) && element[lane] == contact.element;
      if (present) contact_of_[lane] = c;
      contact.offset[lane] = offset(Has(placed, lane) ? lane : leader);
      contact.normal[lane] =
          present ? normal_N[lane] / workspace_.force_unit() : 0;
      contact.friction[lane] = friction_;
      contact.present[lane] = present;
    }
  }
  return placed;
}

template <class T>
bool LadderLanes<T>::Linearize() {
  LadderFrame<T>& f = workspace_.frame();
  kernel_->evaluate(f);
  return std::isfinite(LargestLane(f.residual)) && kernel_->sweep(f);
}

template <class T>
void LadderLanes<T>::Step(const T& newton, const T change[2]) {
  LadderFrame<T>& f = workspace_.frame();
  f.newton = newton;
  f.change[0] = change[0];
  f.change[1] = change[1];
  kernel_->step(f);
}

template class LadderLanes<FourFrames>;
template class LadderLanes<EightFrames>;

}  // namespace finray

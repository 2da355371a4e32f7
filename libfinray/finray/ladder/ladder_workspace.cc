#include "finray/ladder/ladder_workspace.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/ladder/instruction_set.h"
#include "finray/ladder/round_up.h"

namespace finray {
namespace {

// The width of the kernel's vectors in T.
template <class T>
int VectorWidth() {
  return VectorBytes() / static_cast<int>(sizeof(T));
}

double ScaledFlexibility(double axial_stiffness_N, double force_unit) {
  return force_unit / axial_stiffness_N;  // 0 for an infinite one
}

}  // namespace

template <class T>
LadderWorkspace<T>::LadderWorkspace(const LadderModel& model)
    : length_unit_(model.finger().front_length_mm),
      force_unit_(ForceUnit(model.finger())) {
  frame_.ribs = model.ribs();
  SetMesh(model);
}

template <class T>
LadderWorkspace<T>::LadderWorkspace(const LadderWorkspace& other)
    : length_unit_(other.length_unit_),
      force_unit_(other.force_unit_),
      frame_(other.frame_),
      contact_capacity_(other.contact_capacity_),
      stride_capacity_(other.stride_capacity_),
      readouts_(other.readouts_),
      nominal_mm_(other.nominal_mm_) {
  Allocate();
  std::copy(other.cells_.begin(), other.cells_.end(), cells_.begin());
  std::copy(other.integers_.begin(), other.integers_.end(), integers_.begin());
  std::copy(other.contacts_.begin(), other.contacts_.end(), contacts_.begin());
}

// Names every array with its length. It runs once to count and once to hand out
// memory.
template <class T>
template <class Take>
void LadderWorkspace<T>::LayOut(Take&& take) {
  LadderFrame<T>& f = frame_;
  const int width = VectorWidth<T>();
  const int elements = f.elements, ribs = f.ribs, q = 6 + ribs;
  const int slots = RoundUp(elements + contact_capacity_, width);
  const int stride = stride_capacity_;
  for (LadderNodes<T>* z : {&f.state, &f.step, &f.by_load}) {
    take(&z->q, q);
    for (T** field : {&z->x, &z->y, &z->theta, &z->moment}) {
      take(field, elements);
    }
  }
  for (T** field : {&f.length, &f.stiffness, &f.stiffness_ratio,
                    &f.axial_flexibility, &f.piece_step}) {
    take(field, elements);
  }
  for (T** field :
       {&f.rib_length, &f.rib_flexibility, &f.d_rib_length,
        &f.hinge_stiffness[0], &f.hinge_stiffness[1], &f.rib_bending,
        &f.bending_ratio, &f.rib_end[0], &f.rib_end[1], &f.rest_ux, &f.rest_uy,
        &f.rib_ux, &f.rib_uy, &f.rib_distance}) {
    take(field, ribs);
  }
  take(&f.joints, kJointValues * ribs);
  for (T** field : {&f.slot_x, &f.slot_y, &f.slot_theta, &f.slot_moment,
                    &f.slot_fx, &f.slot_fy, &f.slot_length, &f.slot_stiffness,
                    &f.slot_axial, &f.truncation}) {
    take(field, slots);
  }
  take(&f.maps, slots * kMapValues);
  take(&f.gap, 4 * elements);
  take(&f.closure, q);
  take(&f.readout_map, kReadoutValues * f.readout_count);
  const int taps = 3 * contact_capacity_ + 3 + f.readout_count + q;
  // All six parameters may be exchanged after every kGrowthCheckEvery elements.
  const int pivots = 6 * (elements / kGrowthCheckEvery) + ribs + 6;
  take(&f.taps, taps * stride);
  take(&f.q_step, q * stride);
  take(&f.rows, 4 * stride);
  take(&f.tip_rows, 6 * stride);
  take(&f.node_rows, 4 * stride * (elements + 4));
  take(&f.pivots, pivots * stride);
  take(&f.parameters, 6 * stride);
  take(&f.pivot_flexibility, pivots);
  const int moving = f.moves ? elements : 0, moving_ribs = f.moves ? ribs : 0;
  for (int i = 0; i < 2; ++i) {
    take(&f.start_moves[i], moving);
    take(&f.end_moves[i], moving);
    take(&f.moved_by[i], moving);
    take(&f.hinge_effect[i], moving_ribs);
  }
  for (T*& turn : f.rest_turn) take(&turn, moving_ribs);
  take(&f.piece, elements);
  take(&f.rib_element[0], ribs);
  take(&f.rib_element[1], ribs);
  take(&f.first_readout, slots);
  take(&f.end_readout, slots);
  take(&f.pivot_column, pivots);
  take(&f.pivot_rib, pivots);
  take(&f.events, elements + taps + pivots);
}

template <class T>
void LadderWorkspace<T>::Allocate() {
  struct Count {
    std::size_t numbers = 0, integers = 0;
    void operator()(T** /*to*/, int n) { numbers += n; }
    void operator()(int** /*to*/, int n) { integers += n; }
  } count;
  LayOut(count);
  constexpr std::size_t kInCell = sizeof(Cell) / sizeof(T);
  std::vector<Cell> cells((count.numbers + kInCell - 1) / kInCell);
  std::vector<int> integers(count.integers);
  struct Hand {
    T* number;
    int* integer;
    void operator()(T** to, int n) {
      *to = number;
      number += n;
    }
    void operator()(int** to, int n) {
      *to = integer;
      integer += n;
    }
  } hand{cells.data()->numbers, integers.data()};
  LayOut(hand);
  cells_ = std::move(cells);
  integers_ = std::move(integers);
  contacts_.resize(contact_capacity_);
  frame_.contacts = contacts_.data();
  frame_.readouts = readouts_.data();
}

template <class T>
void LadderWorkspace<T>::SetMesh(const LadderModel& model) {
  frame_.front_elements = model.mesh(Side::kFront).elements();
  frame_.elements = frame_.front_elements + model.mesh(Side::kBack).elements();
  frame_.moves = model.moves_nodes();
  PlaceReadouts(model);
  Allocate();

  for (const Side side : {Side::kFront, Side::kBack}) {
    const int beam = LadderModel::Index(side), first = frame_.first(beam);
    const BeamMesh& mesh = model.mesh(side);
    const double flexibility =
        ScaledFlexibility(AxialStiffness(model.finger(), side), force_unit_);
    for (int k = 0; k < mesh.elements(); ++k) {
      frame_.stiffness_ratio[first + k] = mesh.stiffness_ratio[k];
      frame_.axial_flexibility[first + k] = flexibility;
    }
    for (int i = 0; i < frame_.ribs; ++i) {
      frame_.rib_element[beam][i] = first + mesh.rib_node[i];
    }
  }
  PlaceNodes(model);
  SetFinger(model);
}

template <class T>
void LadderWorkspace<T>::PlaceReadouts(const LadderModel& model) {
  readouts_.clear();
  for (int j = 0; j < model.gauges(); ++j) {
    const Gauge& gauge = model.finger().gauges[j];
    const int first = frame_.first(LadderModel::Index(gauge.beam));
    for (const int sign : {-1, 1}) {
      const MeshPoint at =
          model.mesh(gauge.beam)
              .Locate(gauge.start_mm + (sign > 0 ? gauge.length_mm : 0));
      readouts_.push_back({j, sign, first + at.element,
                           static_cast<T>(at.offset_mm / length_unit_)});
    }
  }
  std::sort(readouts_.begin(), readouts_.end(),
            [](const LadderReadout<T>& a, const LadderReadout<T>& b) {
              return std::make_pair(a.element, a.offset) <
                     std::make_pair(b.element, b.offset);
            });
  frame_.readout_count = static_cast<int>(readouts_.size());
}

// The undeformed finger: lengths of elements and ribs, and the bases.
template <class T>
void LadderWorkspace<T>::PlaceNodes(const LadderModel& model) {
  const Finger& finger = model.finger();
  nominal_mm_.clear();
  for (const Rib& rib : finger.ribs) {
    nominal_mm_.push_back(NominalRibLength(finger, rib));
  }
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side), first = frame_.first(i);
    frame_.base_x[i] = BeamBase(finger, side).x() / length_unit_;
    frame_.base_angle[i] = BeamAngle(finger, side);
    const BeamMesh& mesh = model.mesh(side);
    for (int k = 0; k < mesh.elements(); ++k) {
      frame_.length[first + k] =
          (mesh.nodes_mm[k + 1] - mesh.nodes_mm[k]) / length_unit_;
    }
  }
}

template <class T>
void LadderWorkspace<T>::SetFinger(const LadderModel& model, double fraction) {
  if (frame_.moves) {
    PlaceReadouts(model);
    PlaceNodes(model);
    SetMotion(model);
  }
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const T stiffness =
        BendingStiffness(model.finger(), side) / stiffness_unit();
    for (int e = frame_.first(i); e < frame_.end(i); ++e) {
      frame_.stiffness[e] = stiffness * frame_.stiffness_ratio[e];
    }
  }
  for (int i = 0; i < frame_.ribs; ++i) {
    const Rib& rib = model.finger().ribs[i];
    const double slope = rib.length_mm - nominal_mm_[i];
    const double length = rib.length_mm - (1 - fraction) * slope;
    frame_.rib_length[i] = length / length_unit_;
    frame_.d_rib_length[i] = slope / length_unit_;
    frame_.rib_flexibility[i] =
        ScaledFlexibility(rib.axial_stiffness_N, force_unit_);
  }
  SetEffects(model);
}

template <class T>
bool LadderWorkspace<T>::SetContacts(const LadderModel& model,
                                     const std::vector<PointContact>& contacts,
                                     double fraction, SweepColumns columns,
                                     bool open) {
  const int count = static_cast<int>(contacts.size());
  frame_.contact_count = count;
  frame_.effects = model.effect_columns();
  SetColumns(columns, open);
  if (count > contact_capacity_ || frame_.stride > stride_capacity_ ||
      model.moves_nodes() != frame_.moves) {
    contact_capacity_ = std::max(contact_capacity_, count);
    stride_capacity_ = std::max(stride_capacity_, frame_.stride);
    // Takes memory anew for the same mesh and keeps the state.
    const std::vector<T> kept(frame_.state.q,
                              frame_.state.q + frame_.state_size());
    SetMesh(model);
    std::copy(kept.begin(), kept.end(), frame_.state.q);
  }
  for (int i = 0; i < count; ++i) {
    const PointContact& contact = contacts[i];
    const BeamMesh& mesh = model.mesh(contact.side);
    // Written so that a NaN fails.
    if (!(contact.arc_mm >= 0 && contact.arc_mm <= mesh.nodes_mm.back()) ||
        !std::isfinite(contact.normal_N) || !std::isfinite(contact.friction)) {
      return false;
    }
    const MeshPoint at = mesh.Locate(contact.arc_mm);
    const double normal = contact.normal_N / force_unit_;
    LadderContact<T> placed{};
    placed.side = LadderModel::Index(contact.side);
    placed.element = frame_.first(placed.side) + at.element;
    placed.index = i;
    placed.is_mark = contact.is_mark;
    placed.offset = at.offset_mm / length_unit_;
    placed.normal = fraction * normal;
    placed.friction = contact.friction;
    placed.d_normal = normal;
    const double lift =
        contact.is_mark ? 0 : SurfaceOffset(model.finger(), contact.side);
    placed.lift = (placed.side == 0 ? lift : -lift) / length_unit_;
    // Insertion keeps the order of contacts at one place.
    int k = i;
    for (; k > 0; --k) {
      const LadderContact<T>& before = contacts_[k - 1];
      if (before.element < placed.element ||
          (before.element == placed.element &&
           before.offset <= placed.offset)) {
        break;
      }
      contacts_[k] = before;
    }
    contacts_[k] = placed;
  }
  return true;
}

template <class T>
void LadderWorkspace<T>::SetColumns(SweepColumns columns, bool open) {
  const int contacts = 2 * frame_.contact_count;
  const int derivatives = columns == SweepColumns::kParameters
                              ? contacts + 2 + frame_.ribs + frame_.effects
                          : columns == SweepColumns::kContacts ? contacts
                                                               : 1;
  frame_.affine = open ? 6 + frame_.ribs : 6;
  frame_.stride = std::max(
      kNodeColumns, RoundUp(frame_.affine + 1 + derivatives, VectorWidth<T>()));
  frame_.node_columns = columns == SweepColumns::kContacts && !open
                            ? frame_.stride
                            : kNodeColumns;
}

template <class T>
void LadderWorkspace<T>::Load(const LadderState& state) {
  const LadderNodes<T>& z = frame_.state;
  for (int i = 0; i < 6 + frame_.ribs; ++i) {
    const bool moment = i == 0 || i == 3;
    z.q[i] = state.q[i] / (moment ? moment_unit() : force_unit_);
  }
  for (int side = 0; side < 2; ++side) {
    const int first = frame_.first(side);
    for (int k = 0; k < frame_.end(side) - first; ++k) {
      const auto node = state.nodes[side].col(k);
      z.x[first + k] = node[1] / length_unit_;
      z.y[first + k] = node[2] / length_unit_;
      z.theta[first + k] = node[3];
      z.moment[first + k] = node[4] / moment_unit();
    }
  }
  SetBases();
}

template <class T>
void LadderWorkspace<T>::Save(const LadderModel& model,
                              LadderState* state) const {
  const LadderNodes<T>& z = frame_.state;
  state->q.resize(6 + frame_.ribs);
  for (int i = 0; i < 6 + frame_.ribs; ++i) {
    const bool moment = i == 0 || i == 3;
    state->q[i] = z.q[i] * (moment ? moment_unit() : force_unit_);
  }
  for (const Side side : {Side::kFront, Side::kBack}) {
    const BeamMesh& mesh = model.mesh(side);
    const int i = LadderModel::Index(side), first = frame_.first(i);
    LadderState::Nodes& nodes = state->nodes[i];
    nodes.resize(5, mesh.elements());
    state->rib_node[i] = mesh.rib_node;
    state->length_mm[i] = mesh.nodes_mm.back();
    for (int k = 0; k < mesh.elements(); ++k) {
      nodes.col(k) << mesh.nodes_mm[k], z.x[first + k] * length_unit_,
          z.y[first + k] * length_unit_, z.theta[first + k],
          z.moment[first + k] * moment_unit();
    }
  }
}

template class LadderWorkspace<double>;
template class LadderWorkspace<float>;

}  // namespace finray

#include "finray/statics/ladder.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/statics/scheme_element.h"

namespace finray {
namespace {

// Rows of a cursor: the state that is carried along a beam.
enum Row { kX, kY, kTheta, kMoment, kForceX, kForceY, kRows };

template <class Element>
class Marcher {
 public:
  Marcher(const LadderModel& model, const std::vector<PointContact>& contacts,
          MarchMode mode, bool sensitivities, LadderState* state,
          LadderLinearization* out, std::array<std::vector<BeamSpan>, 2>* spans)
      : model_(model),
        contacts_(contacts),
        mode_(mode),
        sensitivities_(sensitivities),
        state_(state),
        out_(out),
        spans_(spans),
        columns_(out->columns()),
        moment_unit_(model.stiffness(Side::kFront) /
                     model.finger().front_length_mm),
        length_unit_(model.finger().front_length_mm),
        front_{Side::kFront, out->scratch.carried[0]},
        back_{Side::kBack, out->scratch.carried[1]},
        across_(out->scratch.across_rib),
        order_(out->scratch.contact_order) {}

  void Run() {
    out_->defect = 0;
    out_->outputs.setZero();
    out_->d_outputs.setZero();
    SortContacts();
    Begin(&front_);
    Begin(&back_);
    for (int rib = 0; rib < model_.ribs(); ++rib) {
      MarchTo(&front_, model_.mesh(Side::kFront).rib_node[rib]);
      MarchTo(&back_, model_.mesh(Side::kBack).rib_node[rib]);
      PassRib(rib);
    }
    MarchTo(&front_, model_.mesh(Side::kFront).elements());
    MarchTo(&back_, model_.mesh(Side::kBack).elements());
    CloseTip();
  }

 private:
  using RowMatrix =
      Eigen::Matrix<double, kRows, Eigen::Dynamic, Eigen::RowMajor>;

  struct Cursor {
    Cursor(Side beam, RowMatrix& carried) : side(beam), d(carried) {}

    const Side side;
    RowMatrix& d;
    int node = 0;
    std::size_t next_gauge_end = 0;
    double value[kRows];
  };

  int ContactColumn(int contact) const {
    return sensitivities_ ? out_->unknowns + 2 * contact : -1;
  }
  int StiffnessColumn(Side side) const {
    return sensitivities_
               ? out_->unknowns + 2 * static_cast<int>(contacts_.size()) +
                     LadderModel::Index(side)
               : -1;
  }
  int DefectColumn() const { return columns_ - 1; }

  void SortContacts() {
    order_.resize(contacts_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      order_[i] = static_cast<int>(i);
    }
    std::stable_sort(order_.begin(), order_.end(), [this](int a, int b) {
      return contacts_[a].arc_mm < contacts_[b].arc_mm;
    });
    next_contact_ = 0;
  }

  void Begin(Cursor* beam) {
    const Finger& finger = model_.finger();
    const int first = 3 * LadderModel::Index(beam->side);
    const Eigen::Vector2d base = BeamBase(finger, beam->side);
    beam->value[kX] = base.x();
    beam->value[kY] = base.y();
    beam->value[kTheta] = BeamAngle(finger, beam->side);
    beam->d.setZero(kRows, columns_);
    for (int i = 0; i < 3; ++i) {
      beam->value[kMoment + i] = state_->q[first + i];
      beam->d(kMoment + i, first + i) = 1;
    }
    StoreNode(beam);
    if (spans_) (*spans_)[LadderModel::Index(beam->side)].clear();
  }

  Eigen::Matrix4Xd& Nodes(Side side) {
    return state_->nodes[LadderModel::Index(side)];
  }

  void StoreNode(Cursor* beam) {
    for (int i = 0; i < 4; ++i) {
      Nodes(beam->side)(i, beam->node) = beam->value[i];
    }
    SaveNodeColumns(*beam);
  }

  void SaveNodeColumns(const Cursor& beam) {
    out_->d_nodes[LadderModel::Index(beam.side)].middleRows(4 * beam.node, 4) =
        beam.d.template topRows<4>();
  }

  void MarchTo(Cursor* beam, int node) {
    const BeamMesh& mesh = model_.mesh(beam->side);
    while (beam->node < node) {
      PassElement(beam);
      ++beam->node;
      if (beam->node < mesh.elements()) ArriveAtNode(beam);
    }
  }

  // Takes up the stored state of a node and books the gap to it as a defect.
  void ArriveAtNode(Cursor* beam) {
    if (mode_ == MarchMode::kPropagate) {
      StoreNode(beam);
      return;
    }
    const double unit[4] = {length_unit_, length_unit_, 1, moment_unit_};
    for (int i = 0; i < 4; ++i) {
      const double stored = Nodes(beam->side)(i, beam->node);
      const double gap = beam->value[i] - stored;
      beam->d(i, DefectColumn()) += gap;
      beam->value[i] = stored;
      // The negated form lets a NaN through to the caller.
      if (!(std::abs(gap) <= out_->defect * unit[i])) {
        out_->defect = std::abs(gap) / unit[i];
      }
    }
    SaveNodeColumns(*beam);
  }

  void PassElement(Cursor* beam) {
    const BeamMesh& mesh = model_.mesh(beam->side);
    const double start = mesh.nodes_mm[beam->node];
    const double end = mesh.nodes_mm[beam->node + 1];
    const bool last = beam->node + 1 == mesh.elements();
    double from = start;
    int moving_end = -1;  // the contact whose l_c bounds the piece
    if (beam->side == Side::kFront) {
      while (next_contact_ < order_.size()) {
        const int contact = order_[next_contact_];
        const double arc = contacts_[contact].arc_mm;
        if (arc > end || (arc == end && !last)) break;
        PassPiece(beam, from, arc, moving_end, contact);
        PassContact(beam, contact);
        moving_end = contact;
        from = arc;
        ++next_contact_;
      }
    }
    PassPiece(beam, from, end, moving_end, -1);
  }

  // Carries the cursor over [from, to]. A piece that begins (ends) at a contact
  // becomes shorter (longer) when that contact moves towards the tip.
  void PassPiece(Cursor* beam, double from, double to, int begins_at,
                 int ends_at) {
    const ElementStart start{beam->value[kTheta], beam->value[kMoment],
                             beam->value[kForceX], beam->value[kForceY]};
    element_.Compute(start, model_.stiffness(beam->side), to - from);
    if (spans_) {
      (*spans_)[LadderModel::Index(beam->side)].push_back(
          {from, to - from, beam->value[kX], beam->value[kY], start});
    }
    ReadGauges(beam, from, to, begins_at, ends_at);

    const ElementMap& map = element_.map();
    double* __restrict x = beam->d.row(kX).data();
    double* __restrict y = beam->d.row(kY).data();
    double* __restrict theta = beam->d.row(kTheta).data();
    double* __restrict moment = beam->d.row(kMoment).data();
    const double* __restrict fx = beam->d.row(kForceX).data();
    const double* __restrict fy = beam->d.row(kForceY).data();
    const auto& a = map.d_start;
    for (int j = 0; j < columns_; ++j) {
      const double t = theta[j], m = moment[j], u = fx[j], v = fy[j];
      x[j] += a[0][0] * t + a[0][1] * m + a[0][2] * u + a[0][3] * v;
      y[j] += a[1][0] * t + a[1][1] * m + a[1][2] * u + a[1][3] * v;
      theta[j] = a[2][0] * t + a[2][1] * m + a[2][2] * u + a[2][3] * v;
      moment[j] = a[3][0] * t + a[3][1] * m + a[3][2] * u + a[3][3] * v;
    }
    if (sensitivities_) {
      AddColumn(beam, StiffnessColumn(beam->side), 1, map.d_stiffness);
      if (begins_at >= 0) {
        AddColumn(beam, ContactColumn(begins_at), -1, map.d_length);
      }
      if (ends_at >= 0) {
        AddColumn(beam, ContactColumn(ends_at), 1, map.d_length);
      }
    }
    beam->value[kX] += map.end[0];
    beam->value[kY] += map.end[1];
    beam->value[kTheta] = map.end[2];
    beam->value[kMoment] = map.end[3];
  }

  static void AddColumn(Cursor* beam, int column, double sign,
                        const double by[4]) {
    for (int i = 0; i < 4; ++i) beam->d(i, column) += sign * by[i];
  }

  // Reads the gauge ends that lie in [from, to); at the tip also at `to`.
  void ReadGauges(Cursor* beam, double from, double to, int begins_at,
                  int ends_at) {
    const BeamMesh& mesh = model_.mesh(beam->side);
    const auto& ends = model_.gauge_ends(beam->side);
    const double tip = mesh.nodes_mm.back();
    while (beam->next_gauge_end < ends.size()) {
      const LadderModel::GaugeEnd& end = ends[beam->next_gauge_end];
      const double arc = mesh.nodes_mm[end.point.element] + end.point.offset_mm;
      if (end.point.element > beam->node || (arc >= to && to < tip)) break;
      const AngleReadout readout = element_.AngleAt(arc - from);
      out_->outputs[end.gauge] += end.sign * readout.theta_rad;
      auto row = out_->d_outputs.row(end.gauge);
      for (int i = 0; i < 4; ++i) {
        row += end.sign * readout.d_start[i] * beam->d.row(kTheta + i);
      }
      if (sensitivities_) {
        row[StiffnessColumn(beam->side)] += end.sign * readout.d_stiffness;
        if (begins_at >= 0) {
          row[ContactColumn(begins_at)] -=
              end.sign * (readout.d_offset + readout.d_length);
        }
        if (ends_at >= 0) {
          row[ContactColumn(ends_at)] += end.sign * readout.d_length;
        }
      }
      ++beam->next_gauge_end;
    }
  }

  // N+ = N- - f (n + mu t), with dn = t dtheta and dt = -n dtheta.
  void PassContact(Cursor* beam, int index) {
    const PointContact& contact = contacts_[index];
    const int row = model_.gauges() + 3 * index;
    for (int i = 0; i < 3; ++i) {
      out_->outputs[row + i] = beam->value[i];
      out_->d_outputs.row(row + i) = beam->d.row(i);
    }
    const double c = std::cos(beam->value[kTheta]);
    const double s = std::sin(beam->value[kTheta]);
    const double f = contact.normal_N, mu = contact.friction;
    const double unit_x = s + mu * c, unit_y = -c + mu * s;
    beam->value[kForceX] -= f * unit_x;
    beam->value[kForceY] -= f * unit_y;
    beam->d.row(kForceX) -= f * (c - mu * s) * beam->d.row(kTheta);
    beam->d.row(kForceY) -= f * (s + mu * c) * beam->d.row(kTheta);
    if (sensitivities_) {
      const int column = ContactColumn(index) + 1;
      beam->d(kForceX, column) -= unit_x;
      beam->d(kForceY, column) -= unit_y;
    }
  }

  void PassRib(int index) {
    const Rib& rib = model_.finger().ribs[index];
    const double dx = back_.value[kX] - front_.value[kX];
    const double dy = back_.value[kY] - front_.value[kY];
    const double length = std::hypot(dx, dy);
    const double ux = dx / length, uy = dy / length;
    const double tension = state_->q[6 + index];
    const double compliance = rib.length_mm / rib.axial_stiffness_N;

    out_->closure[index] = length - rib.length_mm - compliance * tension;
    const auto ddx = back_.d.row(kX) - front_.d.row(kX);
    const auto ddy = back_.d.row(kY) - front_.d.row(kY);
    out_->d_closure.row(index) = ux * ddx + uy * ddy;
    // T du = T / |r| (-u_y, u_x) times the motion across the rib
    const double swing = tension / length;
    across_ = uy * ddx - ux * ddy;
    for (Cursor* beam : {&front_, &back_}) {
      const double sign = beam == &front_ ? -1 : 1;
      beam->value[kForceX] += sign * tension * ux;
      beam->value[kForceY] += sign * tension * uy;
      beam->d.row(kForceX) += sign * swing * uy * across_;
      beam->d.row(kForceY) -= sign * swing * ux * across_;
      beam->d(kForceX, 6 + index) += sign * ux;
      beam->d(kForceY, 6 + index) += sign * uy;
    }
    out_->d_closure(index, 6 + index) -= compliance;
  }

  void CloseTip() {
    const Finger& finger = model_.finger();
    const int first = model_.ribs();
    const double cap_angle =
        BeamAngle(finger, Side::kFront) - BeamAngle(finger, Side::kBack);
    for (int i = 0; i < kRows; ++i) {
      // Geometry must agree; moments and forces must cancel.
      const double sign = i < kMoment ? -1 : 1;
      out_->closure[first + i] =
          front_.value[i] + sign * back_.value[i] - (i == kTheta) * cap_angle;
      out_->d_closure.row(first + i) = front_.d.row(i) + sign * back_.d.row(i);
    }
    const int tip = model_.gauges() + 3 * static_cast<int>(contacts_.size());
    for (int i = 0; i < 3; ++i) {
      out_->outputs[tip + i] = front_.value[i];
      out_->d_outputs.row(tip + i) = front_.d.row(i);
    }
  }

  const LadderModel& model_;
  const std::vector<PointContact>& contacts_;
  const MarchMode mode_;
  const bool sensitivities_;
  LadderState* state_;
  LadderLinearization* out_;
  std::array<std::vector<BeamSpan>, 2>* spans_;
  const int columns_;
  const double moment_unit_, length_unit_;

  Cursor front_, back_;
  Eigen::RowVectorXd& across_;
  std::vector<int>& order_;
  std::size_t next_contact_ = 0;
  Element element_;
};

}  // namespace

LadderModel::LadderModel(const Finger& finger,
                         const Discretization& discretization)
    : finger_(finger) {
  for (const Side side : {Side::kFront, Side::kBack}) {
    mesh_[Index(side)] =
        MakeBeamMesh(finger, side, EffectiveResolution(discretization));
    auto& ends = gauge_ends_[Index(side)];
    for (int j = 0; j < gauges(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      if (gauge.beam != side) continue;
      ends.push_back({j, -1, mesh(side).Locate(gauge.start_mm)});
      ends.push_back(
          {j, 1, mesh(side).Locate(gauge.start_mm + gauge.length_mm)});
    }
    std::sort(ends.begin(), ends.end(),
              [](const GaugeEnd& a, const GaugeEnd& b) {
                return std::make_pair(a.point.element, a.point.offset_mm) <
                       std::make_pair(b.point.element, b.point.offset_mm);
              });
  }
}

LadderState LadderState::Undeformed(const LadderModel& model) {
  LadderState state;
  state.q.setZero(model.unknowns());
  for (const Side side : {Side::kFront, Side::kBack}) {
    const BeamMesh& mesh = model.mesh(side);
    auto& nodes = state.nodes[LadderModel::Index(side)];
    nodes.setZero(4, mesh.elements());
    for (int k = 0; k < mesh.elements(); ++k) {
      nodes.col(k).head<2>() =
          UndeformedPoint(model.finger(), side, mesh.nodes_mm[k]);
      nodes(2, k) = BeamAngle(model.finger(), side);
    }
  }
  return state;
}

void March(const LadderModel& model, const std::vector<PointContact>& contacts,
           Scheme scheme, MarchMode mode, bool sensitivities,
           LadderState* state, LadderLinearization* out,
           std::array<std::vector<BeamSpan>, 2>* spans) {
  const int n_contacts = static_cast<int>(contacts.size());
  const int outputs = model.gauges() + 3 * n_contacts + 3;
  out->unknowns = model.unknowns();
  out->parameters = sensitivities ? 2 * n_contacts + 2 : 0;
  out->closure.resize(out->unknowns);
  out->d_closure.resize(out->unknowns, out->columns());
  out->outputs.resize(outputs);
  out->d_outputs.resize(outputs, out->columns());
  for (const Side side : {Side::kFront, Side::kBack}) {
    out->d_nodes[LadderModel::Index(side)].resize(
        4 * model.mesh(side).elements(), out->columns());
  }
  VisitElement(scheme, [&](auto element) {
    Marcher<decltype(element)>(model, contacts, mode, sensitivities, state, out,
                               spans)
        .Run();
  });
}

}  // namespace finray

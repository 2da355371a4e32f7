#include "finray/ladder/mesh_refinement.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/ladder/scheme_element.h"

namespace finray {
namespace {

// The most elements of both beams, not counting their pieces. Loads to 300 000
// EI / l_0^2 take 400; a path that asks for more leads to forces that no finger
// bears.
constexpr int kMostElements = 1000;
// The most parts that one refinement makes of an element.
constexpr int kMostParts = 8;

// The order of a scheme that is refined.
int Order(Scheme scheme) { return scheme == Scheme::kTaylor12 ? 12 : 16; }

// (x, y, theta, M) at a point inside a slot, in the workspace's units, from the
// slot's series.
Eigen::Vector4d PointInSlot(const LadderFrame<double>& f, Scheme scheme,
                            int slot, double offset) {
  return VisitElement(scheme, [&](auto element) -> Eigen::Vector4d {
    element.Solve({f.slot_theta[slot], f.slot_moment[slot], f.slot_fx[slot],
                   f.slot_fy[slot]},
                  f.slot_stiffness[slot], f.slot_axial[slot],
                  f.slot_length[slot]);
    constexpr int kDegree = decltype(element)::kDegree;
    double series[kDegree + 1][4];
    element.DenseOutput(series);
    Eigen::Vector4d at = Eigen::Vector4d::Zero();
    for (int i = kDegree; i >= 0; --i) {
      at = at * offset + Eigen::Map<const Eigen::Vector4d>(series[i]);
    }
    at.head<2>() += Eigen::Vector2d(f.slot_x[slot], f.slot_y[slot]);
    return at;
  });
}

}  // namespace

bool IsResolved(const LadderFrame<double>& f) {
  double worst = 0;
  for (int slot = 0; slot < f.slots(); ++slot) {
    worst = std::max(worst, f.truncation[slot]);
  }
  return worst < kRefinedTruncation_rad;
}

bool RefineToSeries(const LadderModel& model,
                    const LadderWorkspace<double>& workspace, Scheme scheme,
                    std::array<BeamMesh, 2>* finer, LadderState* state) {
  const LadderFrame<double>& f = workspace.frame();
  workspace.Save(model, state);
  std::size_t elements = 0, most = kMostElements;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const BeamMesh& mesh = model.mesh(side);
    std::vector<double> nodes_mm;
    std::vector<Eigen::Matrix<double, 5, 1>> states;
    for (int k = 0; k < mesh.elements(); ++k) {
      const int e = f.first(i) + k;
      double truncation = f.truncation[e];
      for (int c = 0; c < f.contact_count; ++c) {
        if (f.contacts[c].element == e) {
          truncation = std::max(truncation, f.truncation[f.elements + c]);
        }
      }
      // The truncation counts two terms; the lower one falls as h to the power
      // order - 1.
      const double parts = 1.05 * std::pow(truncation / kRefinedTruncation_rad,
                                           1.0 / (Order(scheme) - 1));
      const int count =
          std::clamp(static_cast<int>(std::ceil(parts)), 1, kMostParts);
      nodes_mm.push_back(mesh.nodes_mm[k]);
      states.push_back(state->nodes[i].col(k));
      for (int part = 1; part < count; ++part) {
        const double offset = f.length[e] * part / count;
        int slot = e;
        double from = 0;
        for (int c = 0; c < f.contact_count; ++c) {
          if (f.contacts[c].element == e && f.contacts[c].offset <= offset) {
            slot = f.elements + c;
            from = f.contacts[c].offset;
          }
        }
        const Eigen::Vector4d at = PointInSlot(f, scheme, slot, offset - from);
        nodes_mm.push_back(mesh.nodes_mm[k] +
                           (mesh.nodes_mm[k + 1] - mesh.nodes_mm[k]) * part /
                               count);
        states.emplace_back();
        states.back() << nodes_mm.back(), at[0] * workspace.length_unit(),
            at[1] * workspace.length_unit(), at[2],
            at[3] * workspace.moment_unit();
      }
    }
    elements += nodes_mm.size();
    most += Pieces(model.finger(), side).size();
    if (elements > most) return false;
    state->nodes[i].resize(5, static_cast<Eigen::Index>(states.size()));
    for (std::size_t k = 0; k < states.size(); ++k) {
      state->nodes[i].col(static_cast<Eigen::Index>(k)) = states[k];
    }
    nodes_mm.push_back(mesh.nodes_mm.back());
    (*finer)[i] = MakeBeamMesh(model.finger(), side, std::move(nodes_mm));
    state->rib_node[i] = (*finer)[i].rib_node;
  }
  return true;
}

bool MeshOfState(const LadderModel& model, const LadderState& state,
                 std::array<BeamMesh, 2>* mesh) {
  const Finger& finger = model.finger();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const auto& nodes = state.nodes[i];
    std::vector<double> nodes_mm(nodes.cols());
    for (Eigen::Index k = 0; k < nodes.cols(); ++k) nodes_mm[k] = nodes(0, k);
    nodes_mm.push_back(state.length_mm[i]);
    const std::vector<int>& hinges = state.rib_node[i];
    bool moved = state.length_mm[i] != model.mesh(side).nodes_mm.back();
    for (std::size_t rib = 0; rib < hinges.size(); ++rib) {
      moved |= nodes_mm[hinges[rib]] != HingePlace(finger.ribs[rib], side);
    }
    (*mesh)[i] = MakeBeamMesh(finger, side, std::move(nodes_mm));
    if (!moved) continue;
    (*mesh)[i].rib_node = hinges;
    if (!MoveNodes(finger, side, &(*mesh)[i])) return false;
  }
  return true;
}

}  // namespace finray

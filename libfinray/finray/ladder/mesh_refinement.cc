#include "finray/ladder/mesh_refinement.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/ladder/scheme_element.h"

namespace finray {
namespace {

// Of both beams, beside their pieces. Loads to 300 000 EI / l_0^2 take 400; a
// path that asks for more than this leads to forces no finger bears.
constexpr int kMostElements = 1000;
constexpr int kMostParts = 8;  // of an element in one refinement

// Of the schemes that are refined.
int Order(Scheme scheme) { return scheme == Scheme::kTaylor12 ? 12 : 16; }

// The mesh with other nodes, which include those of the ribs and pieces.
BeamMesh WithNodes(const Finger& finger, Side side,
                   const std::vector<double>& nodes_mm) {
  BeamMesh mesh;
  mesh.nodes_mm = nodes_mm;
  for (const Rib& rib : finger.ribs) {
    const double hinge = side == Side::kFront ? rib.front_mm : rib.back_mm;
    mesh.rib_node.push_back(static_cast<int>(
        std::lower_bound(nodes_mm.begin(), nodes_mm.end(), hinge) -
        nodes_mm.begin()));
  }
  const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
  std::size_t piece = 0;
  for (int k = 0; k < mesh.elements(); ++k) {
    while (piece + 1 < pieces.size() && pieces[piece].end_mm <= nodes_mm[k]) {
      ++piece;
    }
    mesh.stiffness_ratio.push_back(
        pieces.empty() ? 1.0 : pieces[piece].stiffness_ratio);
  }
  return mesh;
}

// A point inside a slot, in the workspace's units, from its series.
Eigen::Vector4d PointInSlot(const LadderFrame<double>& f, Scheme scheme,
                            int slot, double offset) {
  const BeamPoint at = VisitElement(scheme, [&](auto element) {
    element.Solve({f.slot_theta[slot], f.slot_moment[slot], f.slot_fx[slot],
                   f.slot_fy[slot]},
                  f.slot_stiffness[slot], f.slot_axial[slot],
                  f.slot_length[slot]);
    return element.PointAt(offset);
  });
  return {f.slot_x[slot] + at.x_mm, f.slot_y[slot] + at.y_mm, at.theta_rad,
          at.moment_N_mm};
}

}  // namespace

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
      const int e = (i == 0 ? 0 : f.front_elements) + k;
      double truncation = f.truncation[e];
      for (int c = 0; c < f.contact_count; ++c) {
        if (f.contacts[c].element == e) {
          truncation = std::max(truncation, f.truncation[f.elements + c]);
        }
      }
      // The smaller of the two terms counted goes as h to the order less one.
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
    (*finer)[i] = WithNodes(model.finger(), side, nodes_mm);
  }
  return true;
}

std::array<BeamMesh, 2> MeshOfState(const LadderModel& model,
                                    const LadderState& state) {
  std::array<BeamMesh, 2> mesh;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const auto& nodes = state.nodes[LadderModel::Index(side)];
    std::vector<double> nodes_mm(nodes.cols());
    for (Eigen::Index k = 0; k < nodes.cols(); ++k) nodes_mm[k] = nodes(0, k);
    nodes_mm.push_back(model.mesh(side).nodes_mm.back());
    mesh[LadderModel::Index(side)] = WithNodes(model.finger(), side, nodes_mm);
  }
  return mesh;
}

}  // namespace finray

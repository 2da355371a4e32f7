// The effects of real fingers in a LadderWorkspace.

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/ladder/ladder_workspace.h"
#include "finray/ladder/rib_law.h"

namespace finray {

template <class T>
void LadderWorkspace<T>::SetEffects(const LadderModel& model) {
  const Finger& finger = model.finger();
  frame_.by_friction =
      model.by_friction() ? static_cast<int>(model.effects().size()) : -1;
  frame_.by_hinge_stiffness =
      model.EffectOf(FingerParameterKind::kHingeStiffness);
  SetPieces(model);
  SetBeamEffects(model);
  frame_.by_rib_bending = model.EffectOf(FingerParameterKind::kRibBending);
  frame_.joined = frame_.by_hinge_stiffness >= 0;
  for (const Rib& rib : finger.ribs) frame_.joined |= rib.HasMoments();
  if (!frame_.joined) return;
  frame_.react = ReactInFrame<T>;
  const Rib* const bending = FirstBendingRib(finger);
  for (int i = 0; i < frame_.ribs; ++i) {
    const Rib& rib = finger.ribs[i];
    frame_.hinge_stiffness[0][i] = rib.front_hinge_N_mm_per_rad / moment_unit();
    frame_.hinge_stiffness[1][i] = rib.back_hinge_N_mm_per_rad / moment_unit();
    const double stiffness = rib.Bends() ? rib.bending_stiffness_N_mm2 : 0;
    frame_.rib_bending[i] = stiffness / stiffness_unit();
    frame_.bending_ratio[i] =
        bending ? stiffness / bending->bending_stiffness_N_mm2 : 0;
    frame_.rib_end[0][i] = rib.front_rigid_mm / length_unit_;
    frame_.rib_end[1][i] = rib.back_rigid_mm / length_unit_;
    const Eigen::Vector2d along =
        (UndeformedPoint(finger, Side::kBack, rib.back_mm) -
         UndeformedPoint(finger, Side::kFront, rib.front_mm))
            .normalized();
    frame_.rest_ux[i] = along.x();
    frame_.rest_uy[i] = along.y();
  }
}

// Clamps, surfaces and the bases.
template <class T>
void LadderWorkspace<T>::SetBeamEffects(const LadderModel& model) {
  const Finger& finger = model.finger();
  frame_.by_clamp[0] = model.EffectOf(FingerParameterKind::kFrontClamp);
  frame_.by_clamp[1] = model.EffectOf(FingerParameterKind::kBackClamp);
  frame_.by_surface = model.EffectOf(FingerParameterKind::kSurfaceOffset);
  frame_.clamps = frame_.by_clamp[0] >= 0 || frame_.by_clamp[1] >= 0;
  frame_.lifted = frame_.by_surface >= 0;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const double clamp = ClampCompliance(finger, side);
    const double lift = SurfaceOffset(finger, side);
    frame_.clamps |= clamp != 0;
    frame_.lifted |= lift != 0;
    frame_.clamp[i] = clamp * moment_unit();
    frame_.lift[i] = (i == 0 ? lift : -lift) / length_unit_;
  }
  if (frame_.clamps || frame_.moves) SetBases();
}

template <class T>
void LadderWorkspace<T>::SetBases() {
  const LadderNodes<T>& z = frame_.state;
  for (int side = 0; side < 2; ++side) {
    const int base = frame_.first(side);
    z.moment[base] = z.q[3 * side];
    if (!frame_.clamps && !frame_.moves) continue;
    z.x[base] = frame_.base_x[side];
    z.theta[base] =
        frame_.base_angle[side] + frame_.clamp[side] * z.q[3 * side];
  }
}

// What moves with the places of hinges and with the back angle.
template <class T>
void LadderWorkspace<T>::SetMotion(const LadderModel& model) {
  const Finger& finger = model.finger();
  frame_.by_back_angle = model.EffectOf(FingerParameterKind::kBackAngle);
  const double angle = finger.back_angle_rad;
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const double shift =
      finger.front_length_mm / std::pow(std::sin(angle), 2);  // mm per rad
  frame_.base_x_by_angle = shift / length_unit_;
  for (int i = 0; i < frame_.ribs; ++i) {
    const Rib& rib = finger.ribs[i];
    frame_.hinge_effect[0][i] =
        model.EffectOf({FingerParameterKind::kFrontHinge, i});
    frame_.hinge_effect[1][i] =
        model.EffectOf({FingerParameterKind::kBackHinge, i});
    const Eigen::Vector2d from =
        UndeformedPoint(finger, Side::kBack, rib.back_mm) -
        UndeformedPoint(finger, Side::kFront, rib.front_mm);
    const Eigen::Vector2d across =
        Eigen::Vector2d(-from.y(), from.x()) / from.squaredNorm();
    const Eigen::Vector2d swing =
        Eigen::Vector2d(shift, 0) +
        rib.back_mm * Eigen::Vector2d(-along.y(), along.x());
    frame_.rest_turn[0][i] = -across.y() * length_unit_;
    frame_.rest_turn[1][i] = across.dot(along) * length_unit_;
    frame_.rest_turn[2][i] = across.dot(swing);
  }
  SetBayMotion(model, Side::kFront);
  SetBayMotion(model, Side::kBack);
}

// Inner nodes move by their share of the motion of the ends of their bay.
template <class T>
void LadderWorkspace<T>::SetBayMotion(const LadderModel& model, Side side) {
  const int i = LadderModel::Index(side), first = frame_.first(i);
  const BeamMesh& mesh = model.mesh(side);
  const double angle = model.finger().back_angle_rad;
  const auto mover = [&](int node) {
    const auto rib =
        std::find(mesh.rib_node.begin(), mesh.rib_node.end(), node);
    if (rib != mesh.rib_node.end()) {
      return frame_.hinge_effect[i][rib - mesh.rib_node.begin()];
    }
    return node == mesh.elements() && i == 1 ? frame_.by_back_angle : -1;
  };
  for (std::size_t bay = 1; bay < mesh.bay_node.size(); ++bay) {
    const int start = mesh.bay_node[bay - 1], end = mesh.bay_node[bay];
    const double from = mesh.nodes_mm[start],
                 length = mesh.nodes_mm[end] - from;
    // The length of the back beam is l_0 / sin(phi_0).
    const double rate = end == mesh.elements()
                            ? -std::cos(angle) / std::pow(std::sin(angle), 2) *
                                  model.finger().front_length_mm / length_unit_
                            : 1;
    for (int k = start; k < end; ++k) {
      const double before = (mesh.nodes_mm[k] - from) / length,
                   after = (mesh.nodes_mm[k + 1] - from) / length;
      frame_.moved_by[0][first + k] = mover(start);
      frame_.moved_by[1][first + k] = mover(end);
      frame_.start_moves[0][first + k] = 1 - before;
      frame_.end_moves[0][first + k] = 1 - after;
      frame_.start_moves[1][first + k] = rate * before;
      frame_.end_moves[1][first + k] = rate * after;
    }
  }
}

template <class T>
void LadderWorkspace<T>::SetPieces(const LadderModel& model) {
  const Finger& finger = model.finger();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side), first = frame_.first(i);
    const auto kind = i == 0 ? FingerParameterKind::kFrontPiece
                             : FingerParameterKind::kBackPiece;
    frame_.by_piece[i] = model.EffectOf(kind);
    if (frame_.by_piece[i] < 0) continue;
    const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
    for (int p = 1; p < static_cast<int>(pieces.size()); ++p) {
      frame_.piece_step[first + p] = ParameterValue(finger, {kind, p});
    }
    const std::vector<double>& nodes_mm = model.mesh(side).nodes_mm;
    int piece = 0;
    for (int e = first; e < frame_.end(i); ++e) {
      while (piece + 1 < static_cast<int>(pieces.size()) &&
             pieces[piece].end_mm <= nodes_mm[e - first]) {
        ++piece;
      }
      frame_.piece[e] = piece;
      const T ratio = pieces[piece].stiffness_ratio;
      frame_.stiffness[e] *= ratio / frame_.stiffness_ratio[e];
      frame_.stiffness_ratio[e] = ratio;
    }
  }
}

template void LadderWorkspace<double>::SetEffects(const LadderModel&);
template void LadderWorkspace<double>::SetMotion(const LadderModel&);
template void LadderWorkspace<double>::SetBases();
template void LadderWorkspace<float>::SetEffects(const LadderModel&);
template void LadderWorkspace<float>::SetMotion(const LadderModel&);
template void LadderWorkspace<float>::SetBases();

}  // namespace finray

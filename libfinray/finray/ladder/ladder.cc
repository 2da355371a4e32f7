#include "finray/ladder/ladder.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

void CheckMoments(const Rib& rib, const std::string& name) {
  for (const double stiffness :
       {rib.front_hinge_N_mm_per_rad, rib.back_hinge_N_mm_per_rad}) {
    const bool clamped = rib.Bends() && stiffness > 0;
    if (!std::isfinite(stiffness) && !clamped) {
      throw InputError(name + " has a hinge stiffness that is not finite");
    }
  }
  // Written so that a NaN fails.
  if (!(rib.bending_stiffness_N_mm2 > 0)) {
    throw InputError(name + " has no bending stiffness");
  }
  if (rib.Bends() &&
      !(rib.front_rigid_mm >= 0 && rib.back_rigid_mm >= 0 &&
        rib.front_rigid_mm + rib.back_rigid_mm < rib.length_mm)) {
    throw InputError(name + " is shorter than its rigid ends");
  }
}

// Ribs must lie inside both beams and in the same order on them, as the march
// meets them.
void CheckRibs(const Finger& finger) {
  const double front_length = BeamLength(finger, Side::kFront);
  const double back_length = BeamLength(finger, Side::kBack);
  double front = 0, back = 0;
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    const Rib& rib = finger.ribs[i];
    const std::string name = "rib " + std::to_string(i + 1);
    // Written so that a NaN fails.
    if (!(rib.front_mm > 0 && rib.front_mm < front_length && rib.back_mm > 0 &&
          rib.back_mm < back_length)) {
      throw InputError(name + " does not join the beams between base and tip");
    }
    if (!(rib.front_mm > front && rib.back_mm > back)) {
      throw InputError("ribs " + std::to_string(i) + " and " +
                       std::to_string(i + 1) +
                       " cross or are not listed from base to tip");
    }
    if (!(rib.length_mm > 0 && std::isfinite(rib.length_mm))) {
      throw InputError(name + " has no length");
    }
    if (!(rib.axial_stiffness_N > 0)) {
      throw InputError(name + " has no axial stiffness");
    }
    CheckMoments(rib, name);
    front = rib.front_mm;
    back = rib.back_mm;
  }
}

}  // namespace

LadderModel::LadderModel(const Finger& finger,
                         const Discretization& discretization)
    : finger_(finger) {
  if (discretization.scheme == Scheme::kRigidChain && Stretches(finger)) {
    throw InputError(
        "--scheme rigid_chain: rigid links do not stretch, but the finger has "
        "an axial_stiffness_N of its beams; use a taylor scheme");
  }
  CheckRibs(finger);
  const int resolution = EffectiveResolution(discretization);
  set_mesh({MakeBeamMesh(finger, Side::kFront, resolution),
            MakeBeamMesh(finger, Side::kBack, resolution)});
}

int LadderModel::EffectOf(FingerParameterKind kind) const {
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    if (effects_[i].kind == kind) return static_cast<int>(i);
  }
  return -1;
}

int LadderModel::EffectOf(const FingerParameter& effect) const {
  const auto at = std::find(effects_.begin(), effects_.end(), effect);
  return at == effects_.end() ? -1 : static_cast<int>(at - effects_.begin());
}

bool LadderModel::set_effect(int effect, double value) {
  const FingerParameterKind kind = effects_[effect].kind;
  if (MovesNodes(kind)) return MoveTo(effects_[effect], value);
  const bool piece = kind == FingerParameterKind::kFrontPiece ||
                     kind == FingerParameterKind::kBackPiece;
  const bool positive = piece || kind == FingerParameterKind::kRibBending;
  if (!std::isfinite(value) || (positive && !(value > 0))) return false;
  if (piece && value == ParameterValue(finger_, effects_[effect])) return true;
  SetParameter(effects_[effect], value, &finger_);
  if (piece) {
    const Side side =
        kind == FingerParameterKind::kFrontPiece ? Side::kFront : Side::kBack;
    BeamMesh& mesh = mesh_[Index(side)];
    mesh = MakeBeamMesh(finger_, side, std::move(mesh.nodes_mm));
  }
  return true;
}

bool LadderModel::MoveTo(const FingerParameter& effect, double value) {
  const double before = ParameterValue(finger_, effect);
  if (value == before) return true;
  const bool angle = effect.kind == FingerParameterKind::kBackAngle;
  if (angle && !(value > 90 && value < 180)) return false;
  SetParameter(effect, value, &finger_);
  const Side side = effect.kind == FingerParameterKind::kFrontHinge
                        ? Side::kFront
                        : Side::kBack;
  if (MoveNodes(finger_, side, &mesh_[Index(side)])) return true;
  SetParameter(effect, before, &finger_);
  return false;
}

bool LadderState::IsOnMeshOf(const LadderModel& model) const {
  for (const Side side : {Side::kFront, Side::kBack}) {
    const Nodes& saved = nodes[LadderModel::Index(side)];
    const std::vector<double>& mesh = model.mesh(side).nodes_mm;
    if (saved.cols() + 1 != static_cast<Eigen::Index>(mesh.size()) ||
        length_mm[LadderModel::Index(side)] != mesh.back()) {
      return false;
    }
    for (Eigen::Index k = 0; k < saved.cols(); ++k) {
      if (saved(0, k) != mesh[k]) return false;
    }
  }
  return true;
}

LadderState LadderState::Undeformed(const LadderModel& model) {
  LadderState state;
  state.q.setZero(model.unknowns());
  for (const Side side : {Side::kFront, Side::kBack}) {
    const BeamMesh& mesh = model.mesh(side);
    auto& nodes = state.nodes[LadderModel::Index(side)];
    nodes.setZero(5, mesh.elements());
    state.rib_node[LadderModel::Index(side)] = mesh.rib_node;
    state.length_mm[LadderModel::Index(side)] = mesh.nodes_mm.back();
    for (int k = 0; k < mesh.elements(); ++k) {
      nodes(0, k) = mesh.nodes_mm[k];
      nodes.col(k).segment<2>(1) =
          UndeformedPoint(model.finger(), side, mesh.nodes_mm[k]);
      nodes(3, k) = BeamAngle(model.finger(), side);
    }
  }
  return state;
}

}  // namespace finray

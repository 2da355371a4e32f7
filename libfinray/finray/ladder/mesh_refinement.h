#ifndef FINRAY_LADDER_MESH_REFINEMENT_H_
#define FINRAY_LADDER_MESH_REFINEMENT_H_

#include <array>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

/// Returns true if the series of the last evaluation had converged.
bool IsResolved(const LadderFrame<double>& f);

/// Divides every element whose series leaves out about kRefinedTruncation_rad
/// or more at the last evaluation in `workspace`. The order of the scheme tells
/// how many parts are needed. The state at the new nodes is read from the
/// series. False if the mesh would become unreasonably fine.
bool RefineToSeries(const LadderModel& model,
                    const LadderWorkspace<double>& workspace, Scheme scheme,
                    std::array<BeamMesh, 2>* finer, LadderState* state);

/// The mesh that a state was saved on. If hinges or the tip have moved since,
/// its nodes move with them; false if they cannot.
bool MeshOfState(const LadderModel& model, const LadderState& state,
                 std::array<BeamMesh, 2>* mesh);

}  // namespace finray

#endif  // FINRAY_LADDER_MESH_REFINEMENT_H_

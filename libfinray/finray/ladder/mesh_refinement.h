#ifndef FINRAY_LADDER_MESH_REFINEMENT_H_
#define FINRAY_LADDER_MESH_REFINEMENT_H_

#include <array>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

/// Divides every element whose series, as last evaluated in `workspace`, leaves
/// out about kRefinedTruncation_rad or more, into as many as its order promises
/// to need, and reads the state at the new nodes from the series. False if the
/// mesh would become unreasonably fine.
bool RefineToSeries(const LadderModel& model,
                    const LadderWorkspace<double>& workspace, Scheme scheme,
                    std::array<BeamMesh, 2>* finer, LadderState* state);

/// The mesh on whose nodes a state was saved.
std::array<BeamMesh, 2> MeshOfState(const LadderModel& model,
                                    const LadderState& state);

}  // namespace finray

#endif  // FINRAY_LADDER_MESH_REFINEMENT_H_

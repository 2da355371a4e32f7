#ifndef FINRAY_MODEL_FINGER_MODEL_H_
#define FINRAY_MODEL_FINGER_MODEL_H_

#include <array>
#include <functional>
#include <utility>

#include "finray/model/frame_evaluation.h"
#include "finray/model/model_surface.h"
#include "finray/model/shared_parameters.h"

namespace finray {

/// A finger under load: fills a FrameEvaluation for the contacts that a fit
/// tries one after the other,
///
///   (contacts, parameters) -> gauge angles, poses, pins, tip,
///
/// with derivatives. It is exact, on the statics, or within the error of a
/// piecewise Chebyshev approximation, ModelSurface, where there is one that
/// serves the frame. Sequences of contacts near each other allocate nothing.
class FingerModel {
 public:
  /// The parameters and the surface must stay in place. Without a surface every
  /// evaluation solves an equilibrium; if it `solves` none, frames that the
  /// surface does not serve have no values. Without `by_parameter` only the
  /// derivatives by the contacts are computed.
  struct Source {
    const SharedParameters* parameters = nullptr;
    const ModelSurface* surface = nullptr;
    bool solves = true;
    bool by_parameter = true;
  };
  /// Gives the state that the first solve of a sequence starts from, near the
  /// contacts where it has come to; an empty one for the undeformed finger. It
  /// is not called where the surface gives all values.
  using StartState =
      std::function<void(const double* contacts, LadderState* state)>;

  /// The effects of `solver` must be those of the parameters.
  FingerModel(EquilibriumSolver solver, const Source& source)
      : solver_(std::move(solver)), source_(source) {}

  /// Wherever it is, a contact without force is the free finger.
  static std::array<double, 2> FreeContact(const Finger& finger) {
    return {finger.front_length_mm / 2, 0};
  }

  /// Begins a sequence of contacts near each other. `start` must stay in place.
  void Begin(const StartState& start);
  /// Evaluates the frame at (l_c, f_c) of each contact. With `all` false the
  /// derivatives by the parameters may be left undefined. Returns false if the
  /// model cannot be evaluated there.
  bool Evaluate(const double* contacts, bool all, FrameEvaluation* frame);
  /// The sequence goes on from the last evaluation, which filled `frame`.
  /// Otherwise the next solve starts where the one before did.
  void Stay(const FrameEvaluation& frame);

  /// The last evaluation needed no solve. Then error() says about how far its
  /// outputs may be off, in units of the surface's resolution.
  bool by_surface() const { return by_surface_; }
  double error() const { return values_.error; }

  EquilibriumSolver& solver() { return solver_; }
  const EquilibriumSolver& solver() const { return solver_; }
  const Finger& finger() const { return solver_.model().finger(); }

 private:
  bool TakeFromSurface(const double* contacts, bool all,
                       FrameEvaluation* frame);
  bool Solve(const double* contacts, FrameEvaluation* frame);

  EquilibriumSolver solver_;
  Source source_;
  // near_ is where the next solve starts, if is_near_.
  const StartState* start_ = nullptr;
  bool is_near_ = false, by_surface_ = false;
  bool solver_is_near_ = false;  // the solver is at near_
  LadderState near_;
  ModelSurface::Values values_;
};

}  // namespace finray

#endif  // FINRAY_MODEL_FINGER_MODEL_H_

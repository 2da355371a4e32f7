#ifndef FINRAY_ESTIMATION_ROW_FIT_H_
#define FINRAY_ESTIMATION_ROW_FIT_H_

#include "finray/estimation/contact_solution.h"
#include "finray/fit/row_frames.h"

namespace finray {

/// Fits none, one or two contacts to the rows of a log: FrameFit on the blocks
/// that calibration uses too (FrameBlocks), with all parameters of the finger
/// constant. Another row exchanges the numbers of the blocks. One contact is
/// fitted on a ModelSurface where there is one, else on equilibria.
class RowFit {
 public:
  /// How exact the surface of an estimate is, in std: it serves a row whose
  /// measurements are off by no more.
  static constexpr double kExact_std = 1e-5;
  /// Returns a surface for the rows of a scene, with forces up to `heaviest_N`.
  static ModelSurface SurfaceFor(const Finger& finger, const Scene& scene,
                                 const Discretization& discretization,
                                 double heaviest_N);

  /// `surface` must stay in place; null: every fit solves equilibria. Forces
  /// end at `most_force_N`.
  RowFit(const Finger& finger, const Scene& scene,
         const Discretization& discretization, const ModelSurface* surface,
         double most_force_N);
  RowFit(const RowFit&) = delete;

  /// The friction of the contacts; the scene's at first.
  void set_friction(double friction) { frames_.set_friction(friction); }
  double friction() const { return frames_.friction(); }
  const Finger& finger() const { return frames_.solver().model().finger(); }
  /// The bounds of so many contacts, in mm and N.
  ContactBounds Bounds(int contacts) const {
    return on_equilibria_.Bounds(2 * contacts);
  }
  /// Sets the row of the fits that follow. It must stay in place.
  void set_row(const Measurements& row) { row_ = &row; }
  const Measurements& row() const { return *row_; }

  /// chi2 of a row without a contact; infinite if the finger has no
  /// equilibrium.
  double FreeChi2(const Measurements& row);

  enum class Model {
    kSurface,
    kEquilibria,  ///< Exact to a small part of the gauges' noise.
    kRounding,    ///< Exact to every digit, for readings without noise.
  };
  static constexpr int kMostEvaluations = 60;
  /// Minimises chi2 from a start. With kSurface, returns false where the
  /// surface does not serve. Returns false if there is no equilibrium near the
  /// start or the fit takes more than `most_evaluations`; the solution is then
  /// undefined.
  bool Fit(const ContactStart& start, Model model, int most_evaluations,
           ContactSolution* solution);
  /// Minimises chi2 in equilibrium from contacts that are close.
  bool FitFrom(const std::vector<PointContact>& contacts,
               EquilibriumSolver* solver, ContactSolution* solution);
  /// Minimises chi2 in equilibrium within narrower bounds, in mm and N, from
  /// contacts within. The fit ends where another step would lower chi2 by less
  /// than `small_decrease`, or after `most_evaluations`. Fills in contacts and
  /// chi2. Returns false if there is no equilibrium near the start.
  bool FitWithin(const ContactBounds& bounds, double small_decrease,
                 int most_evaluations, ContactStart* start);
  // Results of the last call of FitWithin(). Information and state belong to
  // the last evaluation.
  /// Returns true if the fit ended before most_evaluations.
  bool converged() const { return on_equilibria_.converged(); }
  ContactMatrix information() const { return at_.Information(); }
  const LadderState& state() const { return evaluation_->state(); }
  /// Evaluations of the model by the last fit.
  int evaluations() const { return evaluations_; }

 private:
  bool Read(const ContactStart& start, const FrameFit::Frame& frame,
            const FrameFit& fit, ContactSolution* solution);

  const ModelSurface* surface_;
  RowFrames frames_;   // without the calibration's effects
  double tolerance_;   // of equilibria
  double coarseness_;  // of the surface
  FrameFit on_surface_, on_equilibria_;
  const Measurements* row_ = nullptr;
  LinearizedFrame at_;
  const FrameEvaluation* evaluation_ = nullptr;  // of the last FitWithin
  const LadderState* start_ = nullptr;
  FrameFit::StartState from_start_;
  int evaluations_ = 0;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_ROW_FIT_H_

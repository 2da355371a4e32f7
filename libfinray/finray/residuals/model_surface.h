#ifndef FINRAY_RESIDUALS_MODEL_SURFACE_H_
#define FINRAY_RESIDUALS_MODEL_SURFACE_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "finray/residuals/frame_set.h"
#include "finray/statics/load_surface.h"

namespace finray {

/// The outputs of FrameEvaluation with one contact, and their derivatives by
/// all parameters, as functions of (l_c, f_c) (load_surface.h). The shared
/// parameters have fixed values. Where thousands of frames are evaluated at the
/// same values, this takes a fraction of the time of their equilibria.
class ModelSurface {
 public:
  /// `solver` and `shared` are copied. `resolution` is what the outputs [gauge
  /// angles (m); contact (x, y, theta); tip (x, y, theta)] may leave out. It
  /// may end before the tip, which is then no output.
  ModelSurface(const EquilibriumSolver& solver, const SharedParameters& shared,
               double friction, bool movable_gauges,
               const Eigen::VectorXd& resolution);

  /// These outputs at a contact.
  struct Values {
    Eigen::VectorXd outputs;
    /// By the columns of FrameEvaluation in the reduced form.
    EquilibriumSolver::Matrix d_outputs;
    /// FrameEvaluation::by_place of each gauge, if gauges are movable.
    std::vector<Eigen::Vector2d> by_place;
    std::vector<double> scratch;
  };
  /// With `all` false, only the derivatives by (l_c, f_c) are set. Returns
  /// false off the surface or where it is not exact enough.
  bool Evaluate(double arc_mm, double normal_N, bool all, Values* values) const;

  /// LoadSurface::MakeFor
  void MakeFor(const std::vector<std::array<double, 2>>& contacts) const {
    surface_.MakeFor(contacts);
  }

 private:
  struct Model;
  ModelSurface(std::shared_ptr<const Model> model,
               const Eigen::VectorXd& resolution);

  int outputs_, parameters_, places_;
  LoadSurface surface_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_MODEL_SURFACE_H_

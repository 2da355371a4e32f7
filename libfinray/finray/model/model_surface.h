#ifndef FINRAY_MODEL_MODEL_SURFACE_H_
#define FINRAY_MODEL_MODEL_SURFACE_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "finray/model/frame_evaluation.h"
#include "finray/model/load_surface.h"

namespace finray {

/// The outputs of FrameEvaluation with one contact, and their derivatives by
/// all parameters, as functions of (l_c, f_c) (load_surface.h). The shared
/// parameters have fixed values. Where thousands of frames are evaluated at the
/// same values, this takes a fraction of the time of their equilibria.
class ModelSurface {
 public:
  /// The groups of values of a surface, and how exact they are.
  struct Content {
    /// The errors that the outputs [gauge angles (m); contact (x, y, theta);
    /// tip (x, y, theta)] may have. The vector may end before the contact or
    /// before the tip, which are then no outputs.
    Eigen::VectorXd resolution;
    /// The derivatives by the parameters.
    bool by_parameter = true;
    /// The poses and tensions that ShapeAt returns.
    bool shape = false;
    /// No load is heavier; empty for 40 EI / l_0^2.
    std::optional<double> heaviest_N = {};
  };
  /// `solver` and `shared` are copied.
  ModelSurface(const EquilibriumSolver& solver, const SharedParameters& shared,
               double friction, bool movable_gauges, const Content& content);

  /// These outputs at a contact.
  struct Values {
    Eigen::VectorXd outputs;
    /// By the columns of FrameEvaluation in the reduced form.
    EquilibriumSolver::Matrix d_outputs;
    /// FrameEvaluation::by_place of each gauge, if gauges are movable.
    std::vector<Eigen::Vector2d> by_place;
    /// About how far the outputs may be off, in units of their resolution.
    double error = 0;
    std::vector<double> scratch;
  };
  /// With `all` false, only the derivatives by (l_c, f_c) are set. Returns
  /// false off the surface or where it is not exact enough.
  bool Evaluate(double arc_mm, double normal_N, bool all, Values* values) const;

  /// The poses (x, y, theta) of the contact and of the tip in mm and rad, and
  /// the tensions of the ribs in N. Returns false off the surface.
  bool ShapeAt(double arc_mm, double normal_N, Eigen::Vector3d* contact,
               Eigen::Vector3d* tip, std::vector<double>* rib_tension_N) const;

  /// Makes all cells, for those who cannot wait later.
  void MakeAll() const { surface_.MakeAll(); }

  /// LoadSurface::MakeFor
  void MakeFor(const std::vector<std::array<double, 2>>& contacts) const {
    surface_.MakeFor(contacts);
  }

 private:
  struct Model;
  ModelSurface(std::shared_ptr<const Model> model, const Content& content);
  std::vector<int> GroupSizes(const Content& content) const;

  int outputs_, parameters_, places_, ribs_;
  bool by_parameter_;
  LoadSurface surface_;
};

}  // namespace finray

#endif  // FINRAY_MODEL_MODEL_SURFACE_H_

#ifndef FINRAY_RESIDUALS_FRAME_EVALUATION_H_
#define FINRAY_RESIDUALS_FRAME_EVALUATION_H_

#include <Eigen/Core>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// How a frame keeps its equilibrium.
enum class EquilibriumForm {
  kReduced,   ///< Solved exactly inside; derivatives by the implicit function
              ///< theorem. Frame unknowns: l_c, f_c of each contact.
  kWeighted,  ///< Base wrenches and rib tensions are frame unknowns too, held
              ///< by EquilibriumResidual and RibLengthResidual.
};

/// The model of one frame at the present parameter values, shared by all
/// residual blocks of the frame so that it is computed once per evaluation.
///
/// The pins of the ribs are outputs where they are asked for. A pin is then a
/// contact without force at the rib's place, which bends nothing and whose pose
/// the equilibrium tells with its derivatives.
///
/// Columns of the derivatives, in the order of the parameter blocks of
/// FrameResidual: [frame unknowns | ln EI front | ln EI back | rib lengths
/// (r)], where the frame unknowns are [l_c, f_c of each contact], preceded by q
/// of ladder.h (6 + r) in the weighted form.
class FrameEvaluation {
 public:
  using Matrix = EquilibriumSolver::Matrix;

  FrameEvaluation(const LadderModel& model, EquilibriumForm form, int contacts,
                  double friction, bool pins = false);

  /// Evaluates at frame unknowns and shared parameters (pointers may be null
  /// where their size is 0). `solver` is scratch: any solver of the same finger
  /// and discretization will do. Afterwards valid() says whether the model
  /// could be evaluated.
  void Update(const double* frame, double ln_front_stiffness,
              double ln_back_stiffness, const double* rib_lengths_mm,
              EquilibriumSolver* solver);

  bool valid() const { return valid_; }
  /// Not to be evaluated at the present values.
  void Invalidate() { valid_ = false; }
  int frame_size() const {
    return 2 * contacts() +
           (form_ == EquilibriumForm::kWeighted ? 6 + ribs_ : 0);
  }
  int contacts() const { return contact_count_; }
  int ribs() const { return ribs_; }
  int gauges() const { return gauges_; }
  int columns() const { return frame_size() + 2 + ribs_; }
  /// Position of (l_c, f_c) of a contact among the frame unknowns.
  int contact_offset(int contact) const {
    return frame_size() - 2 * contacts() + 2 * contact;
  }
  /// Row of x_c (then y_c, theta_c) in outputs().
  int contact_row(int contact) const { return gauges_ + 3 * contact; }
  /// Row of x (then y, theta) of a rib's pin in outputs(); only with pins.
  int pin_row(int rib, Side side) const {
    return contact_row(contacts() + 2 * rib + LadderModel::Index(side));
  }
  /// Row of x_tip (then y, theta) in outputs().
  int tip_row() const { return static_cast<int>(outputs_.size()) - 3; }
  const PointContact& contact(int i) const { return loads_[i]; }

  /// [gauge angles (m); contact (x, y, theta) each; pins (x, y, theta), front
  /// and back of each rib, if asked for; tip (x, y, theta)].
  const Eigen::VectorXd& outputs() const { return outputs_; }
  const Matrix& d_outputs() const { return d_outputs_; }
  /// Closure equations of ladder.h; weighted form only.
  const Eigen::VectorXd& closure() const { return closure_; }
  const Matrix& d_closure() const { return d_closure_; }

  /// The equilibrium found last and next started from.
  const LadderState& state() const { return state_; }
  void set_state(const LadderState& state) { state_ = state; }

 private:
  void UpdateReduced(EquilibriumSolver* solver);
  void UpdateWeighted(const double* frame, EquilibriumSolver* solver);
  void SetWithoutPins(const Matrix& derivatives, Matrix* target) const;

  EquilibriumForm form_;
  int ribs_, gauges_, contact_count_;
  std::vector<PointContact> loads_;  // contacts, then pins
  double length_mm_;
  bool valid_ = false;
  LadderState state_;
  Eigen::VectorXd outputs_, closure_;
  Matrix d_outputs_, d_closure_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_FRAME_EVALUATION_H_

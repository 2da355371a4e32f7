#ifndef FINRAY_MODEL_FRAME_EVALUATION_H_
#define FINRAY_MODEL_FRAME_EVALUATION_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "finray/model/shared_parameters.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// How a frame is held in equilibrium.
enum class EquilibriumForm {
  kReduced,   ///< Solved exactly inside; derivatives by the implicit function
              ///< theorem. Frame unknowns: l_c, f_c of each contact.
  kWeighted,  ///< Base wrenches and rib tensions are frame unknowns too, held
              ///< by EquilibriumResidual and RibLengthResidual.
};

/// The tangential share q of a row's contacts as a function of the friction
/// coefficient, q = offset + slope mu. A row whose object slides has a slope of
/// +-1, one whose object sticks an offset and hardly a slope (SlidingFriction).
/// Where nothing tells how the object moves, q = mu.
struct RowFriction {
  double offset = 0, slope = 1;
  double At(double coefficient) const { return offset + slope * coefficient; }
};

/// The model of one frame at the present parameter values. All residual blocks
/// of the frame share it, so it is computed once per evaluation.
///
/// Rib pins are outputs only on request. A pin is then modelled as a contact
/// without force at the rib's place. It bends nothing, and the equilibrium
/// yields its pose with derivatives. Where gauges can be moved, so are their
/// ends: Update puts them anywhere, and the gauges' angles are read there.
///
/// The derivatives have one column for each parameter of FrameResidual, in its
/// order: [frame unknowns | ln EI front | ln EI back | rib lengths (r) |
/// effects of the model (LadderModel::effects)]. The frame unknowns are [l_c,
/// f_c of each contact] in the reduced form; the weighted form puts the 6 + r
/// unknowns q of ladder.h before them.
class FrameEvaluation {
 public:
  using Matrix = EquilibriumSolver::Matrix;

  FrameEvaluation(const LadderModel& model, EquilibriumForm form, int contacts,
                  double friction, bool pins = false,
                  bool movable_gauges = false, RowFriction row = {});

  /// Evaluates the model at frame unknowns and shared parameters, with movable
  /// gauges where these say. A pointer may be null where its size is 0.
  /// `solver` is scratch memory: any solver of the same finger, effects and
  /// discretization will do. Afterwards valid() says whether the evaluation
  /// succeeded.
  void Update(const double* frame, const SharedParameters& shared,
              EquilibriumSolver* solver);
  /// The same, with gauges where the last call put them.
  void Update(const double* frame, double ln_front_stiffness,
              double ln_back_stiffness, const double* rib_lengths_mm,
              const double* effects, EquilibriumSolver* solver);

  /// Says whether ModelSurface can take the place of Update: the reduced form
  /// with one contact or none, without pins and without friction of its own.
  bool FitsSurface() const;
  /// Takes the rows of a ModelSurface::Values in place of Update. A frame
  /// without contact takes those of a contact without force. Rows of gauges'
  /// ends are left undefined, and those of a contact and a tip that are no
  /// outputs are NaN. The friction must be that of the constructor.
  void Take(const double* frame, const Eigen::VectorXd& outputs,
            const Matrix& d_outputs,
            const std::vector<Eigen::Vector2d>& by_place);

  /// With false, Update() in the reduced form, without pins and movable gauges,
  /// leaves out the derivatives by anything but the frame unknowns; they are
  /// NaN.
  void set_by_parameter(bool by_parameter) { by_parameter_ = by_parameter; }

  /// Exchanges the friction of the contacts, for rows whose object slides
  /// another way; the arguments are those of the constructor.
  void set_friction(double friction, RowFriction row);

  bool valid() const { return valid_; }
  /// Marks the model as not evaluated at the present values.
  void Invalidate() { valid_ = false; }
  int frame_size() const {
    return 2 * contacts() +
           (form_ == EquilibriumForm::kWeighted ? 6 + ribs_ : 0);
  }
  int contacts() const { return contact_count_; }
  int ribs() const { return ribs_; }
  int gauges() const { return gauges_; }
  int effects() const { return effects_; }
  /// The place of the friction coefficient among the effects; -1 if it is not
  /// varied.
  int friction_effect() const { return by_friction_ ? effects_ - 1 : -1; }
  /// How the contacts' friction follows from the coefficient.
  const RowFriction& row_friction() const { return row_friction_; }
  /// The column of the first effect.
  int effect_column() const { return frame_size() + 2 + ribs_; }
  int columns() const { return frame_size() + 2 + ribs_ + effects_; }
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
  int tip_row() const { return contact_row(static_cast<int>(loads_.size())); }
  const PointContact& contact(int i) const { return loads_[i]; }
  bool movable_gauges() const { return ends_ > 0; }
  /// The derivatives of a gauge's angle by its start and by its length, rad/mm;
  /// only if gauges are movable.
  const Eigen::Vector2d& by_place(int gauge) const { return by_place_[gauge]; }

  /// The outputs: [gauge angles (m, rad); contacts (x, y, theta each); pins (x,
  /// y, theta), front and back of each rib, on request; tip (x, y, theta)].
  const Eigen::VectorXd& outputs() const { return outputs_; }
  const Matrix& d_outputs() const { return d_outputs_; }
  /// Closure equations of ladder.h; weighted form only.
  const Eigen::VectorXd& closure() const { return closure_; }
  const Matrix& d_closure() const { return d_closure_; }

  /// The last equilibrium found. The next evaluation starts from it; if it is
  /// empty, from where the solver is.
  const LadderState& state() const { return state_; }
  void set_state(const LadderState& state) {
    state_ = state;
    from_solver_ = false;
  }
  /// The next evaluation starts from where its solver is.
  void StartFromSolver() { from_solver_ = true; }

 private:
  // Moves the gauges, if they are movable. on_beam_ is false afterwards if a
  // gauge is off its beam.
  void PlaceGauges(const double* starts_mm, const double* lengths_mm);
  void UpdateReduced(EquilibriumSolver* solver);
  void UpdateWeighted(const double* frame, EquilibriumSolver* solver);
  void SetWithoutPins(const Matrix& derivatives, Matrix* target) const;
  void MovePins(const Finger& finger);
  void ReadMovedGauges(const Matrix& derivatives);

  EquilibriumForm form_;
  int ribs_, effects_, gauges_, contact_count_;
  bool by_friction_, by_parameter_ = true;
  RowFriction row_friction_;
  int ends_ = 0;  // of movable gauges
  // Contacts, then pins, then the start and the end of each movable gauge.
  std::vector<PointContact> loads_;
  // Pins that move with an effect: the load and the effect.
  std::vector<std::array<int, 2>> moved_pins_;
  bool on_beam_ = true;  // all gauges
  bool from_solver_ = false;
  double length_mm_, back_length_mm_;
  bool valid_ = false;
  LadderState state_;
  std::vector<Eigen::Vector2d> by_place_;
  Eigen::VectorXd outputs_, closure_;
  Matrix d_outputs_, d_closure_;
};

}  // namespace finray

#endif  // FINRAY_MODEL_FRAME_EVALUATION_H_

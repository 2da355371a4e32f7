#ifndef FINRAY_FIT_ROW_FRAMES_H_
#define FINRAY_FIT_ROW_FRAMES_H_

#include <array>
#include <memory>
#include <vector>

#include "finray/fit/frame_fit.h"
#include "finray/scene/scene.h"

namespace finray {

/// The frames of a row with none, one or two contacts, for FrameFit: their
/// blocks with the parameters of the finger as they are. Another row exchanges
/// the numbers of the blocks.
class RowFrames {
 public:
  /// The measurements are those that the scene gives a std for. The finger's
  /// calibration says which effects and places of gauges have derivatives.
  RowFrames(const Finger& finger, const Scene& scene,
            const Discretization& discretization);
  RowFrames(const RowFrames&) = delete;

  /// Sets the friction of the contacts; the scene's at first.
  void set_friction(double friction);
  double friction() const { return row_friction_.At(friction_); }

  /// Returns the frame of a row with these contacts. It is good until the next
  /// call with as many.
  FrameFit::Frame Of(const Measurements& row, const PointContact* contacts,
                     int count);

  /// How exact a surface must be to serve such rows: what the outputs of
  /// ModelSurface may leave out for an error of `exact_std`, in std of the
  /// gauges and of a place that is measured no better than to a micrometre.
  static Eigen::VectorXd Resolution(const Finger& finger, const Scene& scene,
                                    double exact_std);
  /// By how much a surface of this resolution is less exact: 1, or more where
  /// rounding forbids it.
  static double Coarseness(const Finger& finger, double exact_std);

  /// The angle of a gauge in the frame of the last call of Of, in rad.
  double GaugeAngle(int gauge) const { return last_->outputs()[gauge]; }

  /// A solver of the finger with its effects.
  const EquilibriumSolver& solver() const { return solver_; }
  FingerParameters& parameters() { return parameters_; }

 private:
  struct Frame {
    Frame(FrameEvaluation with_contacts, const MeasurementModel& model,
          const FrameParameters& parameters, const std::vector<Gauge>& gauges)
        : evaluation(std::move(with_contacts)),
          blocks(&model, &parameters, &gauges, &evaluation, contacts.data()) {}

    FrameEvaluation evaluation;
    std::array<double, 2 * kFittedContacts> contacts{};
    FrameBlocks blocks;
  };

  Finger finger_;
  MeasurementModel model_;
  double friction_;
  bool pins_;
  FingerParameters parameters_;
  EquilibriumSolver solver_;
  RowFriction row_friction_;
  // By the number of contacts; made when needed.
  std::array<std::unique_ptr<Frame>, kFittedContacts + 1> frames_;
  const FrameEvaluation* last_ = nullptr;
};

}  // namespace finray

#endif  // FINRAY_FIT_ROW_FRAMES_H_

#ifndef FINRAY_CONTROL_MODEL_CONTROLLER_H_
#define FINRAY_CONTROL_MODEL_CONTROLLER_H_

#include <optional>
#include <vector>

#include "finray/control/controller.h"
#include "finray/control/mechanism.h"
#include "finray/control/object_filter.h"
#include "finray/control/push_model.h"

namespace finray {

/// Force control with the finger's own model. In each period of length T
///
///  1. the present drive u is measured or follows from the commands so far;
///  2. the estimated force F tells the place of the object, z = X(F; u): the
///  mean
///     of PushModel over the fingers, at the mean of the estimated heights;
///  3. ObjectFilter predicts the object at the time h = delay + T, when this
///     period's command will have had its effect;
///  4. the wanted drive u* gives the force of the set-point there,
///     X(F_ref; u*) = o(h) - c F_ref;
///  5. the command takes the drive to u* (Actuator::CommandFor), with the
///  commands
///     in flight taken into account.
///
/// Like Smith's predictor the loop acts on predicted errors, so with a right
/// model it contains no delay. It has no gain to tune: ObjectPrior and the
/// estimator's std decide how much one reading counts. With `preview` F_ref is
/// the set-point at the time h from now, otherwise the present one.
class ModelController : public Controller {
 public:
  /// `models` has one entry for each finger.
  ModelController(std::vector<PushModel> models, const Mechanism& mechanism,
                  const ObjectPrior& prior, double period_s, bool preview);

  double Next(double time_s, const std::vector<ContactEstimate>& contacts,
              const Trajectory& set_point, const Actuator& drive) override;
  void Skip() override { filter_.Predict(); }
  void Lost() override;

  const ObjectFilter& filter() const { return filter_; }

 private:
  struct MeanPush {
    double object_x_mm = 0, compliance_mm_per_N = 0;
    double variance_mm2 = 0;  // of object_x_mm, from those of the forces
  };

  bool SeeHeights(double drive, const std::vector<ContactEstimate>& contacts);
  // The mean push of all fingers under these forces.
  std::optional<MeanPush> PushAt(double drive,
                                 const std::vector<ContactEstimate>& contacts);
  double PlaceStd(const MeanPush& push, double drive, double way) const;
  std::optional<double> DriveFor(double force_N, double place_mm, double drive);

  std::vector<PushModel> models_;
  Mechanism mechanism_;
  ObjectFilter filter_;
  double period_s_, timing_std_s_;
  bool preview_;
  // Height of the object in each finger's world and the last contact there.
  std::vector<double> y_mm_, arc_mm_;
  int seen_ = 0;  // number of estimates in the mean height
  std::optional<double> last_drive_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_MODEL_CONTROLLER_H_

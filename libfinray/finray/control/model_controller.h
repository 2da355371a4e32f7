#ifndef FINRAY_CONTROL_MODEL_CONTROLLER_H_
#define FINRAY_CONTROL_MODEL_CONTROLLER_H_

#include <optional>
#include <vector>

#include "finray/control/controller.h"
#include "finray/control/mechanism.h"
#include "finray/control/object_filter.h"
#include "finray/control/push_model.h"

namespace finray {

/// Force control by the finger's own model. In each period, T long,
///
///  1. where the drive is now, u, is measured or follows from the commands so
///     far;
///  2. the estimated force tells where the object is: z = X(F; u), the mean of
///     PushModel over the fingers, at the object's y (a mean of what estimates
///     say);
///  3. ObjectFilter predicts the object to the time h = delay + T at which this
///     period's command will have had its effect;
///  4. the drive has to be where the set-point's force is felt there,
///     X(F_ref; u*) = o(h) - c F_ref;
///  5. the command is the one that takes the drive there (Actuator::
///     CommandFor), commands in flight included.
///
/// So the loop acts on predicted errors, like Smith's predictor, and no delay
/// is left in it as far as the model is right. There is no gain to tune; what
/// is assumed of the object (ObjectPrior) and the estimator's std decide how
/// far it trusts one reading. `preview`: F_ref is that at the time h from now,
/// for a set-point that is known beforehand; else that of now.
class ModelController : public Controller {
 public:
  /// `models`: one for each finger.
  ModelController(std::vector<PushModel> models, const Mechanism& mechanism,
                  const ObjectPrior& prior, double period_s, bool preview);

  double Next(double time_s, const std::vector<SeenContact>& contacts,
              const Trajectory& set_point, const Actuator& drive) override;
  void Skip() override { filter_.Predict(); }
  void Lost() override;

  const ObjectFilter& filter() const { return filter_; }

 private:
  struct MeanPush {
    double object_x_mm = 0, compliance_mm_per_N = 0;
    double variance_mm2 = 0;  // of object_x_mm, from those of the forces
  };

  bool SeeHeights(double drive, const std::vector<SeenContact>& contacts);
  // Of all fingers, under the force of each; std may be empty.
  std::optional<MeanPush> PushAt(double drive,
                                 const std::vector<SeenContact>& contacts);
  double PlaceStd(const MeanPush& push, double drive, double way) const;
  std::optional<double> DriveFor(double force_N, double place_mm, double drive);

  std::vector<PushModel> models_;
  Mechanism mechanism_;
  ObjectFilter filter_;
  double period_s_, timing_std_s_;
  bool preview_;
  // Of the object in each finger's world, and how many estimates are in it.
  std::vector<double> y_mm_, arc_mm_;
  int seen_ = 0;
  std::optional<double> last_drive_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_MODEL_CONTROLLER_H_

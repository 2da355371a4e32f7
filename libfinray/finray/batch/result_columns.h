#ifndef FINRAY_BATCH_RESULT_COLUMNS_H_
#define FINRAY_BATCH_RESULT_COLUMNS_H_

#include <string>
#include <vector>

#include "finray/sensing/frame_estimator.h"

namespace finray {

/// The numeric columns that an estimate fills in, in this order: contact_<c>_*,
/// normal_<c>_*, friction_<c>, gauge angles, ribs, gauge offsets where
/// they wander, tip, chi2, chi2_p_value, iterations, alternative_*. They depend
/// only on the finger and the scene. The second contact has columns if
/// FrameEstimator may find one: contacts 2, or auto with at least four gauges
/// and no object_std_mm.
class ResultColumns {
 public:
  ResultColumns(const Finger& finger, const Scene& scene);

  const std::vector<std::string>& names() const { return names_; }
  /// Writes their values to values[0 .. names().size() - 1], NaN where there is
  /// none.
  void Values(const Measurements& readings, const FrameEstimate& estimate,
              double* values) const;

 private:
  template <class Column>
  void ForEach(const Measurements& readings, const FrameEstimate& estimate,
               Column column) const;

  std::vector<Gauge> gauges_;
  std::size_t ribs_;
  int contacts_ = 1;
  bool alternative_;
  double friction_;
  std::vector<std::string> names_;
};

}  // namespace finray

#endif  // FINRAY_BATCH_RESULT_COLUMNS_H_

#include "finray/calib/solve/modelled_readings.h"

#include <cmath>
#include <memory>
#include <utility>

namespace finray {

bool KeepHistory(const Linearization& at, CalibrationProblem* problem) {
  auto signals_V = std::make_shared<Eigen::MatrixXd>(Eigen::MatrixXd::Constant(
      static_cast<Eigen::Index>(problem->finger().gauges.size()),
      static_cast<Eigen::Index>(problem->logs().frames.size()), std::nan("")));
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const ResidualInfo& row = at.rows[i];
    if (row.family != ResidualFamily::kGauge) continue;
    const CalibrationFrame& frame = problem->frame(row.frame);
    (*signals_V)(row.gauge, row.frame) =
        frame.gauges_V[row.gauge] + at.residuals[i] * row.std_V -
        problem->parameters().OfHistory(frame, row.gauge);
  }
  return problem->KeepHistory(std::move(signals_V));
}

}  // namespace finray

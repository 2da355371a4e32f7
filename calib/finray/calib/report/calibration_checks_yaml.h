#ifndef FINRAY_CALIB_REPORT_CALIBRATION_CHECKS_YAML_H_
#define FINRAY_CALIB_REPORT_CALIBRATION_CHECKS_YAML_H_

#include "finray/calib/report/calibration_result.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Emits the keys errors, residual_correlation, leave_one_log_out and next of
/// calibration.yaml into a mapping that has begun.
void EmitChecks(CalibrationProblem& problem, const CalibrationResult& result,
                YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_CALIBRATION_CHECKS_YAML_H_

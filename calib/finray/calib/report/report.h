#ifndef FINRAY_CALIB_REPORT_REPORT_H_
#define FINRAY_CALIB_REPORT_REPORT_H_

#include <string>

namespace finray {

/// Renders report.html from calibration.yaml, calibration.frames.csv and
/// calibration.shape.csv of a result folder. It runs calib/report/render.py
/// with /usr/bin/python3. Returns an empty string, or why there is no report.
std::string RenderReport(const std::string& out_dir);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_REPORT_H_

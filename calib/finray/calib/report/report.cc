#include "finray/calib/report/report.h"

#include "finray/io/python_script.h"

namespace finray {

std::string RenderReport(const std::string& out_dir) {
  return RunPythonScript(FINRAY_REPORT_DIR "/render.py", {out_dir},
                         "python3-matplotlib, python3-jinja2 and python3-yaml");
}

}  // namespace finray

#include <filesystem>

#include "finray/calib/report/calibration_result.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "finray/io/message_text.h"
#include "finray/io/python_script.h"

namespace finray {

std::string WriteCalibration(CalibrationProblem& problem,
                             const CalibrationResult& result,
                             const CalibrationInputs& inputs,
                             const std::string& out_dir, bool report) {
  const auto path = [&](const char* name) {
    return (std::filesystem::path(out_dir) / name).string();
  };
  MakeFolder(out_dir);
  WriteFileAtomically(path("calibration.yaml"),
                      CalibrationYaml(problem, result, inputs));
  CalibrationFrames(problem, result).Write(path("calibration.frames.csv"));
  CalibrationShape(problem, result).Write(path("calibration.shape.csv"));
  std::string origin = "Calibrated from";
  for (const std::string& log : problem.logs().paths)
    origin += " " + OneLine(log);
  WriteFileAtomically(
      path("finger.yaml"),
      FingerToYaml(result.finger, origin +
                                      "\nStandard deviations and checks: "
                                      "calibration.yaml beside this file."));
  if (!report) return "";
  return RunPythonScript("calib/report/render.py", {out_dir},
                         "python3-matplotlib, python3-jinja2 and python3-yaml");
}

}  // namespace finray

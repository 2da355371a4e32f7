#include "finger_picture.h"

#include "app.h"
#include "finray/io/number_text.h"
#include "finray/io/python_script.h"

namespace finray {

bool DrawFinger(const Finger& finger, const std::string& path,
                const std::vector<Eigen::Vector2d>& places) {
  Finger drawn = finger;
  drawn.calibration.reset();  // nothing of it is drawn, and it may be long
  std::vector<std::string> arguments = {path, FingerToYaml(drawn)};
  for (const Eigen::Vector2d& place : places) {
    arguments.push_back(FormatText("%.4g,%.4g", place.x(), place.y()));
  }
  const std::string why_not =
      RunPythonScript("calib/report/draw_finger.py", arguments,
                      "python3-jinja2 and python3-yaml");
  if (!why_not.empty()) Warn("no " + path, why_not);
  return why_not.empty();
}

}  // namespace finray

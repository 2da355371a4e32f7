// What a camera's view of the rib pins says of the model, on the real steel
// finger pressed on a circle (docs/evidence/calibration_accuracy.md). Argument:
// the folder of the measurements.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "finray/calib/report/calibration_result.h"
#include "finray/finger/finger_yaml.h"
#include "finray/scene/frame_columns.h"
#include "temp_file.h"

namespace finray {
namespace {

constexpr double kPinStd_mm = 0.6;

// The series with its pins: the circle's centre was at -20 mm before the base
// advanced.
std::string JoinedLog(const std::string& data, const TempFolder& folder) {
  FrameTable log =
      FrameTable::Read(data + "steel_finger_contact_circle_r20.csv");
  FrameTable pins =
      FrameTable::Read(data + "steel_finger_rib_pins_circle_r20.csv");
  const auto number = [](FrameTable& table, const char* name, std::size_t row) {
    return std::stod(table.MutableText(name)[row]);
  };
  for (std::size_t k = 0; k < pins.rows(); ++k) {
    const double at = number(pins, "base_advance_mm", k) - 20;
    const int rib = std::stoi(pins.MutableText("rib")[k]) - 1;
    const std::string beam = pins.MutableText("beam")[k];
    for (std::size_t i = 0; i < log.rows(); ++i) {
      if (std::abs(log.Numbers("object_x_mm")[i] - at) > 0.5) continue;
      log.MutableNumbers(RibPin(rib, beam, "x"))[i] = number(pins, "x_mm", k);
      log.MutableNumbers(RibPin(rib, beam, "y"))[i] = number(pins, "y_mm", k);
    }
  }
  log.Write(folder.Path("r20_with_pins.csv"));
  return folder.Path("r20_with_pins.csv");
}

struct Case {
  const char* name;
  bool pins, camera, origin, ribs;
};

void Run(const Case& which, const Finger& finger, const std::string& log) {
  Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/two_gauges_circle_r20.yaml");
  const auto free = [&](ParameterFamily family, double prior) {
    plan.families[static_cast<int>(family)].free = true;
    plan.families[static_cast<int>(family)].prior_std = prior;
  };
  if (which.pins) plan.pin_std_mm = kPinStd_mm;
  if (which.camera) free(ParameterFamily::kCameraOrigin, 3);
  if (which.origin) free(ParameterFamily::kObjectOrigin, 2);
  if (which.ribs) free(ParameterFamily::kRibLength, 0.5);
  CalibrationProblem problem(finger, plan,
                             ReadCalibrationLogs({log}, finger, plan), {}, 2);
  const CalibrationResult result = Calibrate(&problem);
  std::printf("\n%s%s\n chi2/dof", which.name,
              result.solution.solve.converged ? "" : " (not converged)");
  for (int i = 0; i < kResidualFamilies; ++i) {
    const auto& noise = result.identifiability.noise[i];
    if (noise.residuals == 0) continue;
    std::printf(" %s %.2f", ResidualFamilyName(static_cast<ResidualFamily>(i)),
                noise.chi2 / noise.dof);
  }
  std::printf("; force from gauges %.2f N rms before, %.2f after\n",
              result.forces.fitted.force_before_N().rms(),
              result.forces.fitted.force_after_N().rms());
  const auto& parameters = problem.parameters();
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    std::printf(" %s %.4g +- %.2g (from %.4g)\n", p.name.c_str(),
                p.Value(*p.variable),
                p.ValueStd(*p.variable, result.identifiability.std[i]),
                p.Value(p.initial));
  }
  if (!which.pins) return;
  // Model less camera, by advance and pin.
  const auto& at = result.solution.at;
  const auto& frames = problem.logs().frames;
  std::printf(" model - camera, mm (x, y) of pins front 1-4, back 1-4\n");
  for (std::size_t row = 0; row < at.rows.size();) {
    if (at.rows[row].family != ResidualFamily::kPin) {
      ++row;
      continue;
    }
    const int frame = at.rows[row].frame;
    const std::size_t count = frames[frame].pins.size();
    std::printf(" advance %2.0f:", frames[frame].object_mm.x() + 20);
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (std::size_t k = 0; k < count; ++k) {
        if (frames[frame].pins[k].side != side) continue;
        const std::size_t first = row + 2 * k;
        std::printf(" (%+.1f %+.1f)", kPinStd_mm * at.residuals[first],
                    kPinStd_mm * at.residuals[first + 1]);
      }
    }
    std::printf("\n");
    row += 2 * count;
  }
}

int Main(const std::string& data) {
  if (!std::filesystem::exists(data + "steel_finger.yaml")) {
    std::printf("%s: the measurements are not here\n", data.c_str());
    return 0;
  }
  const TempFolder folder;
  const std::string log = JoinedLog(data, folder);
  const Finger finger = ReadFinger(data + "steel_finger.yaml");
  for (const Case& which :
       {Case{"without pins", false, false, false, false},
        Case{"with pins", true, false, false, false},
        Case{"with pins, camera origin free", true, true, false, false},
        Case{"with pins, both origins free", true, true, true, false},
        Case{"with pins, both origins and ribs free", true, true, true,
             true}}) {
    Run(which, finger, log);
  }
  return 0;
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  return finray::Main(argc > 1 ? std::string(argv[1]) + "/"
                               : FINRAY_SOURCE_DIR "/../shared/data/");
}

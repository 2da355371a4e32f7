#include "design_start.h"

#include <gflags/gflags.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "app.h"
#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"
#include "finray/io/python_script.h"
#include "number_flags.h"

DECLARE_string(finger);
DECLARE_string(dxf);
DECLARE_double(front_length_mm);
DECLARE_double(back_angle_deg);
DECLARE_string(ribs);
DECLARE_double(thickness_mm);
DECLARE_double(width_mm);
DECLARE_double(youngs_modulus_GPa);

namespace finray {
namespace {

double PlateStiffness() {
  return PositiveFlag("youngs_modulus_GPa", FLAGS_youngs_modulus_GPa) * 1e3 *
         PositiveFlag("width_mm", FLAGS_width_mm) *
         std::pow(PositiveFlag("thickness_mm", FLAGS_thickness_mm), 3) / 12;
}

Finger FingerOfDimensions() {
  Finger finger;
  finger.name = FormatText("strip_%gmm", FLAGS_front_length_mm);
  finger.front_length_mm =
      PositiveFlag("front_length_mm", FLAGS_front_length_mm);
  if (!(FLAGS_back_angle_deg > 90 && FLAGS_back_angle_deg < 180)) {
    throw UsageError("--back_angle_deg: expected between 90 and 180, found " +
                     NumberText(FLAGS_back_angle_deg));
  }
  finger.back_angle_rad = FLAGS_back_angle_deg * kDegree;
  finger.front_stiffness_N_mm2 = finger.back_stiffness_N_mm2 = PlateStiffness();
  for (const std::string& item : SplitList(FLAGS_ribs)) {
    const std::size_t colon = item.find(':');
    const auto front = ParseNumber(item.substr(0, colon));
    const auto angle = colon == std::string::npos
                           ? std::nullopt
                           : ParseNumber(item.substr(colon + 1));
    if (!front || !angle) {
      throw UsageError(
          "--ribs: expected front_mm:angle_deg, such as 17:10, found " + item);
    }
    if (!(*front > 0 && *front < FLAGS_front_length_mm)) {
      throw UsageError(FormatText(
          "--ribs: the rib %s leaves the front beam, which is %g mm long",
          item.c_str(), FLAGS_front_length_mm));
    }
    Rib rib;
    rib.front_mm = *front;
    rib.back_mm = RibBackArc(finger, *front, *angle * kDegree);
    if (!(rib.back_mm > 0 && rib.back_mm < BeamLength(finger, Side::kBack))) {
      throw UsageError("--ribs: the rib " + item + " misses the back beam");
    }
    rib.length_mm = NominalRibLength(finger, rib);
    finger.ribs.push_back(rib);
  }
  return finger;
}

Start StartOfFile(const std::string& yaml) {
  return {ReadFinger(yaml), ReadPlates(yaml)};
}

Start StartOfDimensions() {
  return {FingerOfDimensions(),
          {{Side::kFront, "both beams", FLAGS_width_mm, FLAGS_thickness_mm,
            FLAGS_youngs_modulus_GPa}}};
}

Start StartOfDrawing() {
  PositiveFlag("youngs_modulus_GPa", FLAGS_youngs_modulus_GPa);
  PositiveFlag("width_mm", FLAGS_width_mm);
  std::string folder =
      (std::filesystem::temp_directory_path() / "finray_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) {
    throw InputError(folder + ": cannot be created");
  }
  const std::string yaml = folder + "/finger.yaml";
  const int status = RunPython("calib/report/dxf_finger.py",
                               {FLAGS_dxf, yaml, NumberText(FLAGS_width_mm),
                                NumberText(FLAGS_youngs_modulus_GPa)});
  std::optional<Start> start;
  try {
    if (status == 0) start = StartOfFile(yaml);
  } catch (...) {
    std::filesystem::remove_all(folder);
    throw;
  }
  std::filesystem::remove_all(folder);
  if (!start) throw DrawingFailed();
  for (WrittenPlate& plate : start->plates) {  // their file is no more
    plate.name = FLAGS_dxf + ": " + SideName(plate.side) + " beam";
  }
  return *start;
}

}  // namespace

Start StartFinger() {
  const int given =
      !FLAGS_finger.empty() + !FLAGS_dxf.empty() + IsGiven("front_length_mm");
  if (given != 1) {
    throw UsageError(
        "expected one of --finger, --dxf and --front_length_mm to start from");
  }
  if (!FLAGS_finger.empty()) return StartOfFile(FLAGS_finger);
  return FLAGS_dxf.empty() ? StartOfDimensions() : StartOfDrawing();
}

}  // namespace finray

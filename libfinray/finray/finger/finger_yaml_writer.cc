#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "finray/finger/finger_yaml.h"
#include "finray/finger/finger_yaml_numbers.h"
#include "finray/finger/geometry.h"
#include "finray/finger/parameter_covariance_yaml.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

// The shortest text of a number near `value` for which `reads_back` holds.
template <typename ReadsBack>
std::string TextThat(const ReadsBack& reads_back, long double value) {
  const auto rounded = static_cast<double>(value);
  std::string shortest;
  for (const double near :
       {rounded, std::nextafter(rounded, 0.0),
        std::nextafter(rounded, std::numeric_limits<double>::infinity())}) {
    const std::string text = NumberText(near);
    if (reads_back(text) &&
        (shortest.empty() || text.size() < shortest.size())) {
      shortest = text;
    }
  }
  if (!shortest.empty()) return shortest;
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// Degrees that read back as the same radians.
std::string DegreesText(double rad) {
  return TextThat(
      [rad](const std::string& text) { return RadFromDegrees(text) == rad; },
      rad / kLongDegree);
}

std::string BeamToYaml(const Finger& finger, Side side) {
  std::ostringstream yaml;
  const double stiffness = BendingStiffness(finger, side);
  const double axial = AxialStiffness(finger, side);
  const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
  if (pieces.empty()) {
    yaml << "    bending_stiffness_N_mm2: " << NumberText(stiffness) << "\n";
  }
  if (std::isfinite(axial)) {
    yaml << "    axial_stiffness_N: " << NumberText(axial) << "\n";
  }
  // No finger has a negative compliance.
  if (const double clamp = ClampCompliance(finger, side); clamp > 0) {
    const auto reads_back = [clamp](const std::string& text) {
      return ComplianceOf(text) == clamp;
    };
    yaml << "    " << kClampStiffness << ": "
         << TextThat(reads_back, 1 / static_cast<long double>(clamp)) << "\n";
  }
  if (const double surface = SurfaceOffset(finger, side); surface != 0) {
    yaml << "    " << kSurfaceOffset << ": " << NumberText(surface) << "\n";
  }
  if (pieces.empty()) return yaml.str();
  yaml << "    pieces:\n";
  // In the file the first piece stands for the stiffness of the beam.
  const double first_ratio = pieces[0].stiffness_ratio;
  const std::string first = NumberText(stiffness * first_ratio);
  const long double reference = LongNumber(first);
  for (const StiffnessPiece& piece : pieces) {
    const double ratio = piece.stiffness_ratio / first_ratio;
    const auto reads_back = [&](const std::string& text) {
      return StiffnessRatio(LongNumber(text), reference) == ratio;
    };
    yaml << "      - {end_mm: " << NumberText(piece.end_mm)
         << ", bending_stiffness_N_mm2: "
         << (&piece == &pieces[0] ? first
                                  : TextThat(reads_back, ratio * reference))
         << "}\n";
  }
  return yaml.str();
}

std::string PairToYaml(double front, double back) {
  return "[" + NumberText(front) + ", " + NumberText(back) + "]";
}

// Nothing for hinges that turn freely and for clamped ends. One clamped end
// beside a spring is written as the stiffest one.
std::string HingesToYaml(const Rib& rib) {
  const double front =
      std::min(rib.front_hinge_N_mm_per_rad, kLargestYamlNumber);
  const double back = std::min(rib.back_hinge_N_mm_per_rad, kLargestYamlNumber);
  const bool clamped = std::isinf(rib.front_hinge_N_mm_per_rad) &&
                       std::isinf(rib.back_hinge_N_mm_per_rad);
  if (!rib.HasMoments() || clamped) return "";
  return std::string(", ") + kHingeStiffness + ": " +
         (front == back ? NumberText(front) : PairToYaml(front, back));
}

std::string BendingToYaml(const Rib& rib) {
  if (!rib.Bends()) return "";
  std::string yaml = std::string(", ") + kBendingStiffness + ": " +
                     NumberText(rib.bending_stiffness_N_mm2);
  if (rib.front_rigid_mm != 0 || rib.back_rigid_mm != 0) {
    yaml += std::string(", ") + kRigidEnds + ": " +
            PairToYaml(rib.front_rigid_mm, rib.back_rigid_mm);
  }
  return yaml;
}

}  // namespace

std::string FingerToYaml(const Finger& finger, const std::string& comment) {
  std::ostringstream yaml;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);)
    yaml << "# " << line << "\n";
  YAML::Emitter name;
  name << finger.name;
  yaml << "schema_version: 1\n"
       << "name: " << name.c_str() << "\n"
       << "geometry: {front_length_mm: " << NumberText(finger.front_length_mm)
       << ", back_angle_deg: " << DegreesText(finger.back_angle_rad) << "}\n"
       << "beams:\n"
       << "  front:\n"
       << BeamToYaml(finger, Side::kFront) << "  back:\n"
       << BeamToYaml(finger, Side::kBack);
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) {
      yaml << ", " << key << ": " << NumberText(value);
    }
  };
  if (!finger.ribs.empty()) yaml << "ribs:\n";
  for (const Rib& rib : finger.ribs) {
    yaml << "  - {front_mm: " << NumberText(rib.front_mm);
    add("back_mm", rib.back_mm);
    add("length_mm", rib.length_mm);
    add("axial_stiffness_N", rib.axial_stiffness_N);
    yaml << HingesToYaml(rib) << BendingToYaml(rib);
    yaml << "}\n";
  }
  const auto add_share = [&](const char* key, double share, const char* scale,
                             double value) {
    if (share == 0) return;
    yaml << ", " << key << ": {share: " << NumberText(share) << ", " << scale
         << ": " << NumberText(value) << "}";
  };
  if (!finger.gauges.empty()) yaml << "gauges:\n";
  for (const Gauge& gauge : finger.gauges) {
    yaml << "  - {beam: " << SideName(gauge.beam);
    add("start_mm", gauge.start_mm);
    add("length_mm", gauge.length_mm);
    add("gain_V_per_rad", gauge.gain_V_per_rad);
    add("offset_V", gauge.offset_V);
    add("noise_V", gauge.noise_V);
    add("min_V", gauge.min_V);
    add("max_V", gauge.max_V);
    if (gauge.curvature_per_rad != 0) {
      add("curvature_per_rad", gauge.curvature_per_rad);
    }
    add_share("flat", gauge.flat_share, "width_rad", gauge.flat_width_rad);
    if (gauge.hysteresis_rad != 0) add("hysteresis_rad", gauge.hysteresis_rad);
    add_share("creep", gauge.creep_share, "time_constant_s",
              gauge.creep_time_constant_s);
    yaml << "}\n";
  }
  if (finger.calibration)
    yaml << ParameterCovarianceToYaml(*finger.calibration);
  return yaml.str();
}

}  // namespace finray

#include "finray/finger/finger_yaml.h"

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <locale>
#include <sstream>
#include <string_view>

#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr long double kLongDegree =
    3.14159265358979323846264338327950288L / 180;

std::string Short(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

// EI, given as such or by a rectangular plate: E w t^3 / 12.
double ReadStiffness(const YamlMap& beam) {
  if (beam.Has("axial_stiffness_N")) {
    beam.Fail("axial_stiffness_N",
              "axial_stiffness_N: beams are taken as inextensible; leave it "
              "out");
  }
  beam.AllowOnly({"bending_stiffness_N_mm2", "width_mm", "thickness_mm",
                  "youngs_modulus_GPa"});
  bool plate = false;
  for (const char* key : {"width_mm", "thickness_mm", "youngs_modulus_GPa"}) {
    if (!beam.Has(key)) continue;
    plate = true;
    if (beam.Has("bending_stiffness_N_mm2")) {
      beam.Fail(key, std::string(key) +
                         ": give either bending_stiffness_N_mm2 or the "
                         "plate's dimensions");
    }
  }
  if (!plate) return beam.PositiveNumber("bending_stiffness_N_mm2");
  constexpr double kGPa = 1e3;  // N / mm^2
  const double thickness = beam.PositiveNumber("thickness_mm");
  const double stiffness = beam.PositiveNumber("youngs_modulus_GPa") * kGPa *
                           beam.PositiveNumber("width_mm") *
                           std::pow(thickness, 3) / 12;
  if (!(stiffness > 0 && std::isfinite(stiffness))) {
    beam.Fail("thickness_mm", "the plate has a bending stiffness of " +
                                  Short(stiffness) +
                                  " N mm^2, expected a number above 0");
  }
  return stiffness;
}

// Where the rib meets the back beam, known to be strictly inside it.
double ReadBackHinge(const YamlMap& yaml, const Finger& finger,
                     double front_mm) {
  const bool by_angle = yaml.Has("angle_deg");
  const char* key = by_angle ? "angle_deg" : "back_mm";
  if (by_angle == yaml.Has("back_mm")) {
    yaml.Fail(key, "a rib needs either angle_deg or back_mm");
  }
  const double number = yaml.Number(key);
  const double back_mm =
      by_angle ? RibBackArc(finger, front_mm, number * kDegree) : number;
  if (std::isnan(back_mm)) {
    yaml.Fail(key, "the rib misses the back beam: it points away from it");
  }
  const double back_length = BeamLength(finger, Side::kBack);
  if (!(back_mm > 0 && back_mm < back_length)) {
    yaml.Fail(key, "the rib misses the back beam: it would meet it at " +
                       Short(back_mm) + " mm, expected between 0 and " +
                       Short(back_length) + " mm");
  }
  return back_mm;
}

Rib ReadRib(const YamlMap& yaml, const Finger& finger) {
  yaml.AllowOnly(
      {"front_mm", "angle_deg", "back_mm", "length_mm", "axial_stiffness_N"});
  Rib rib;
  rib.front_mm = yaml.PositiveNumber("front_mm");
  if (rib.front_mm >= finger.front_length_mm) {
    yaml.Fail("front_mm", "front_mm: the rib leaves the front beam, which is " +
                              Short(finger.front_length_mm) + " mm long");
  }
  rib.back_mm = ReadBackHinge(yaml, finger, rib.front_mm);
  rib.length_mm =
      yaml.PositiveNumber("length_mm", NominalRibLength(finger, rib));
  rib.axial_stiffness_N =
      yaml.PositiveNumber("axial_stiffness_N", rib.axial_stiffness_N);
  return rib;
}

void ReadRibs(const YamlMap& yaml, Finger* finger) {
  for (const YamlMap& entry : yaml.Maps("ribs")) {
    const Rib rib = ReadRib(entry, *finger);
    if (!finger->ribs.empty()) {
      const Rib& before = finger->ribs.back();
      const std::string number = std::to_string(finger->ribs.size() + 1);
      if (rib.front_mm <= before.front_mm) {
        entry.Fail("front_mm",
                   "front_mm: ribs must be listed from base to tip");
      }
      if (rib.back_mm <= before.back_mm) {
        entry.Fail("front_mm", "ribs " + std::to_string(finger->ribs.size()) +
                                   " and " + number +
                                   " cross: they meet the back beam at " +
                                   Short(before.back_mm) + " and " +
                                   Short(rib.back_mm) + " mm");
      }
    }
    finger->ribs.push_back(rib);
  }
}

Gauge ReadGauge(const YamlMap& yaml, const Finger& finger) {
  yaml.AllowOnly({"beam", "start_mm", "length_mm", "gain_V_per_rad", "offset_V",
                  "noise_V"});
  Gauge gauge;
  gauge.beam = yaml.Choice("beam", {"front", "back"}) == "front" ? Side::kFront
                                                                 : Side::kBack;
  gauge.start_mm = yaml.NonNegativeNumber("start_mm");
  gauge.length_mm = yaml.PositiveNumber("length_mm");
  const double beam_length = BeamLength(finger, gauge.beam);
  if (gauge.start_mm + gauge.length_mm > beam_length) {
    yaml.Fail("start_mm", "the gauge ends at " +
                              Short(gauge.start_mm + gauge.length_mm) +
                              " mm, off its beam, which is " +
                              Short(beam_length) + " mm long");
  }
  gauge.gain_V_per_rad = yaml.Number("gain_V_per_rad", gauge.gain_V_per_rad);
  if (gauge.gain_V_per_rad == 0) {
    yaml.Fail("gain_V_per_rad",
              "gain_V_per_rad: expected a number other than 0");
  }
  gauge.offset_V = yaml.Number("offset_V", gauge.offset_V);
  gauge.noise_V = yaml.PositiveNumber("noise_V", gauge.noise_V);
  return gauge;
}

// Radians of an angle in degrees, rounded once. In long double, as a double in
// degrees may be coarser than one in radians: one angle in ten could not be
// written so that it reads back.
double RadFromDegrees(std::string_view text) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  long double degrees = 0;
  std::from_chars(text.data(), text.data() + text.size(), degrees);
  return static_cast<double>(degrees * kLongDegree);
}

// Degrees that read back as the same radians, in as few digits as that takes.
std::string DegreesText(double rad) {
  const double degrees = rad / kDegree;
  std::string shortest;
  for (const double near : {degrees, std::nextafter(degrees, 0.0),
                            std::nextafter(degrees, 360.0)}) {
    const std::string text = NumberText(near);
    if (RadFromDegrees(text) == rad &&
        (shortest.empty() || text.size() < shortest.size())) {
      shortest = text;
    }
  }
  if (!shortest.empty()) return shortest;
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, rad / kLongDegree).ptr;
  return std::string(text, end);
}

}  // namespace

Finger ReadFinger(const std::string& path) {
  const YamlMap yaml = YamlMap::FromFile(path);
  // First, as another version has other keys.
  const int version = yaml.Integer("schema_version");
  if (version != 1) {
    yaml.Fail("schema_version",
              "schema_version: expected 1, found " + std::to_string(version));
  }
  yaml.AllowOnly(
      {"schema_version", "name", "geometry", "beams", "ribs", "gauges"});
  Finger finger;
  finger.name = yaml.Text("name");
  const YamlMap geometry = yaml.Map("geometry");
  geometry.AllowOnly({"front_length_mm", "back_angle_deg"});
  finger.front_length_mm = geometry.PositiveNumber("front_length_mm");
  const double angle = geometry.Number("back_angle_deg");
  if (!(angle > 90 && angle < 180)) {
    geometry.Fail("back_angle_deg",
                  "back_angle_deg: expected an angle between 90 and 180 "
                  "degrees, found " +
                      Short(angle));
  }
  finger.back_angle_rad = RadFromDegrees(geometry.Text("back_angle_deg"));
  const YamlMap beams = yaml.Map("beams");
  beams.AllowOnly({"front", "back"});
  finger.front_stiffness_N_mm2 = ReadStiffness(beams.Map("front"));
  finger.back_stiffness_N_mm2 = ReadStiffness(beams.Map("back"));
  ReadRibs(yaml, &finger);
  for (const YamlMap& entry : yaml.Maps("gauges")) {
    finger.gauges.push_back(ReadGauge(entry, finger));
  }
  return finger;
}

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
       << "  front: {bending_stiffness_N_mm2: "
       << NumberText(finger.front_stiffness_N_mm2) << "}\n"
       << "  back:  {bending_stiffness_N_mm2: "
       << NumberText(finger.back_stiffness_N_mm2) << "}\n";
  if (!finger.ribs.empty()) yaml << "ribs:\n";
  for (const Rib& rib : finger.ribs) {
    yaml << "  - {front_mm: " << NumberText(rib.front_mm)
         << ", back_mm: " << NumberText(rib.back_mm)
         << ", length_mm: " << NumberText(rib.length_mm);
    if (std::isfinite(rib.axial_stiffness_N)) {
      yaml << ", axial_stiffness_N: " << NumberText(rib.axial_stiffness_N);
    }
    yaml << "}\n";
  }
  if (!finger.gauges.empty()) yaml << "gauges:\n";
  for (const Gauge& gauge : finger.gauges) {
    yaml << "  - {beam: " << (gauge.beam == Side::kFront ? "front" : "back")
         << ", start_mm: " << NumberText(gauge.start_mm)
         << ", length_mm: " << NumberText(gauge.length_mm)
         << ", gain_V_per_rad: " << NumberText(gauge.gain_V_per_rad)
         << ", offset_V: " << NumberText(gauge.offset_V)
         << ", noise_V: " << NumberText(gauge.noise_V) << "}\n";
  }
  return yaml.str();
}

}  // namespace finray

#include "finray/finger/finger_yaml.h"

#include <cmath>
#include <sstream>

#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

constexpr double kDegree = M_PI / 180;

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
  if (beam.Has("bending_stiffness_N_mm2")) {
    for (const char* key : {"width_mm", "thickness_mm", "youngs_modulus_GPa"}) {
      if (beam.Has(key)) {
        beam.Fail(key, std::string(key) +
                           ": give either bending_stiffness_N_mm2 or the "
                           "plate's dimensions");
      }
    }
    return beam.PositiveNumber("bending_stiffness_N_mm2");
  }
  constexpr double kGPa = 1e3;  // N / mm^2
  const double thickness = beam.PositiveNumber("thickness_mm");
  return beam.PositiveNumber("youngs_modulus_GPa") * kGPa *
         beam.PositiveNumber("width_mm") * std::pow(thickness, 3) / 12;
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
  const bool by_angle = yaml.Has("angle_deg");
  if (by_angle == yaml.Has("back_mm")) {
    yaml.Fail("angle_deg", "a rib needs either angle_deg or back_mm");
  }
  rib.back_mm = by_angle ? RibBackArc(finger, rib.front_mm,
                                      yaml.Number("angle_deg") * kDegree)
                         : yaml.Number("back_mm");
  const double back_length = BeamLength(finger, Side::kBack);
  if (!(rib.back_mm > 0 && rib.back_mm < back_length)) {
    yaml.Fail(by_angle ? "angle_deg" : "back_mm",
              "the rib misses the back beam: it would meet it at " +
                  Short(rib.back_mm) + " mm, expected between 0 and " +
                  Short(back_length) + " mm");
  }
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
  gauge.start_mm = yaml.NonNegativeNumber("start_mm", 0);
  if (!yaml.Has("start_mm")) yaml.Number("start_mm");  // required
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

// Degrees that read back as the same radians.
std::string DegreesText(double rad) {
  double degrees = rad / kDegree;
  for (int step = 1; degrees * kDegree != rad && step < 20; ++step) {
    const double toward = step % 2 ? 1e9 : -1e9;
    for (int i = 0; i < step; ++i) degrees = std::nextafter(degrees, toward);
  }
  return NumberText(degrees);
}

}  // namespace

Finger ReadFinger(const std::string& path) {
  const YamlMap yaml = YamlMap::FromFile(path);
  yaml.AllowOnly(
      {"schema_version", "name", "geometry", "beams", "ribs", "gauges"});
  if (yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "schema_version: expected 1");
  }
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
  finger.back_angle_rad = angle * kDegree;
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

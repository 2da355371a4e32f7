#include "finray/finger/finger_yaml.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/finger_yaml_numbers.h"
#include "finray/finger/geometry.h"
#include "finray/finger/parameter_covariance_yaml.h"
#include "finray/io/number_text.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

// No finger has more; all unknowns of a finger are solved together.
constexpr std::size_t kMostRibs = 100, kMostPieces = 200, kMostGauges = 500;
// Lengths in mm, far from where rounding hides what a finger does.
constexpr double kShortest_mm = 1e-3, kLongest_mm = 1e6;
// The stiffest part of both beams over the softest. Beyond it the stiff beam
// does not bend where the soft one folds, and no load path ends.
constexpr double kMostStiffnessRatio = 1e6;

std::string Short(double value) { return FormatText("%g", value); }

// Throws if one beam is so much softer than the other, or than a piece.
void CheckStiffnessRatio(const YamlMap& yaml, const Finger& finger) {
  double softest = std::numeric_limits<double>::infinity(), stiffest = 0;
  for (const Side side : {Side::kFront, Side::kBack}) {
    double least = 1, most = 1;
    for (const StiffnessPiece& piece : Pieces(finger, side)) {
      least = std::min(least, piece.stiffness_ratio);
      most = std::max(most, piece.stiffness_ratio);
    }
    const double stiffness = BendingStiffness(finger, side);
    softest = std::min(softest, least * stiffness);
    stiffest = std::max(stiffest, most * stiffness);
  }
  if (stiffest <= kMostStiffnessRatio * softest) return;
  yaml.Fail("beams", "beams: expected bending stiffnesses within a factor of " +
                         Short(kMostStiffnessRatio) + ", found " +
                         Short(softest) + " and " + Short(stiffest) +
                         " N mm^2");
}

constexpr const char* kPlate[] = {"width_mm", "thickness_mm",
                                  "youngs_modulus_GPa"};

// EI, given directly or as a rectangular plate: E w t^3 / 12.
double ReadStiffness(const YamlMap& yaml) {
  bool plate = false;
  for (const char* key : kPlate) {
    if (!yaml.Has(key)) continue;
    plate = true;
    if (yaml.Has(kBendingStiffness)) {
      yaml.Fail(key, std::string(key) +
                         ": give either bending_stiffness_N_mm2 or the "
                         "plate's dimensions");
    }
  }
  if (!plate) return yaml.PositiveNumber(kBendingStiffness);
  constexpr double kGPa = 1e3;  // N / mm^2
  const double thickness = yaml.PositiveNumber("thickness_mm");
  const double stiffness = yaml.PositiveNumber("youngs_modulus_GPa") * kGPa *
                           yaml.PositiveNumber("width_mm") *
                           std::pow(thickness, 3) / 12;
  if (stiffness < 1 / kLargestYamlNumber || stiffness > kLargestYamlNumber) {
    yaml.Fail("thickness_mm", "the plate has a bending stiffness of " +
                                  Short(stiffness) +
                                  " N mm^2, expected one from 1e-30 to 1e30");
  }
  return stiffness;
}

// The end of a piece that starts at `start_mm`.
double ReadPieceEnd(const YamlMap& yaml, bool last, double start_mm,
                    double length_mm) {
  constexpr double kSlack_mm = 1e-6;
  if (last && !yaml.Has("end_mm")) return length_mm;
  const double end_mm = yaml.PositiveNumber("end_mm");
  if (end_mm <= start_mm) {
    yaml.Fail("end_mm",
              "end_mm: pieces must be listed from base to tip, but the one "
              "before ends at " +
                  Short(start_mm) + " mm, this one at " + Short(end_mm) +
                  " mm");
  }
  if (last) {
    if (std::abs(end_mm - length_mm) <= kSlack_mm) return length_mm;
    yaml.Fail("end_mm", "end_mm: the last piece must end at the tip, " +
                            NumberText(length_mm) + " mm, found " +
                            Short(end_mm) + "; without end_mm it does");
  }
  if (end_mm >= length_mm - kSlack_mm) {
    yaml.Fail("end_mm", "end_mm: expected an end before the tip, which is at " +
                            Short(length_mm) +
                            " mm, as this is not the last piece");
  }
  return end_mm;
}

// Returns the stiffness of the first piece.
double ReadPieces(const YamlMap& yaml, double length_mm,
                  std::vector<StiffnessPiece>* pieces) {
  for (const char* key : {kBendingStiffness, kPlate[0], kPlate[1], kPlate[2]}) {
    if (yaml.Has(key)) {
      yaml.Fail(key, std::string(key) +
                         ": give either the stiffness of the beam or pieces");
    }
  }
  const std::vector<YamlMap> entries = yaml.Maps("pieces");
  if (entries.empty()) yaml.Fail("pieces", "pieces: expected at least one");
  yaml.CheckCount("pieces", entries.size(), kMostPieces);
  long double reference = 0;
  double first = 0, end_mm = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const YamlMap& entry = entries[i];
    entry.AllowOnly(
        {"end_mm", kBendingStiffness, kPlate[0], kPlate[1], kPlate[2]});
    end_mm = ReadPieceEnd(entry, i + 1 == entries.size(), end_mm, length_mm);
    const double rounded = ReadStiffness(entry);
    const long double stiffness =
        entry.Has(kBendingStiffness) ? LongNumber(entry.Text(kBendingStiffness))
                                     : rounded;
    if (i == 0) {
      first = rounded;
      reference = stiffness;
    }
    pieces->push_back({end_mm, StiffnessRatio(stiffness, reference)});
  }
  return first;
}

void ReadBeam(const YamlMap& yaml, double length_mm, double* bending_N_mm2,
              double* axial_N, std::vector<StiffnessPiece>* pieces,
              double* clamp_rad_per_N_mm, double* surface_mm) {
  yaml.AllowOnly({kBendingStiffness, kPlate[0], kPlate[1], kPlate[2],
                  "axial_stiffness_N", "pieces", kClampStiffness,
                  kSurfaceOffset});
  if (yaml.Has(kClampStiffness)) {
    yaml.PositiveNumber(kClampStiffness);
    *clamp_rad_per_N_mm = ComplianceOf(yaml.Text(kClampStiffness));
  }
  *surface_mm = yaml.Number(kSurfaceOffset, 0);
  *bending_N_mm2 = yaml.Has("pieces") ? ReadPieces(yaml, length_mm, pieces)
                                      : ReadStiffness(yaml);
  *axial_N = yaml.PositiveNumber("axial_stiffness_N", *axial_N);
}

void ReadBeams(const YamlMap& yaml, Finger* finger) {
  yaml.AllowOnly({"front", "back"});
  ReadBeam(yaml.Map("front"), BeamLength(*finger, Side::kFront),
           &finger->front_stiffness_N_mm2, &finger->front_axial_stiffness_N,
           &finger->front_pieces, &finger->front_clamp_rad_per_N_mm,
           &finger->front_surface_mm);
  ReadBeam(yaml.Map("back"), BeamLength(*finger, Side::kBack),
           &finger->back_stiffness_N_mm2, &finger->back_axial_stiffness_N,
           &finger->back_pieces, &finger->back_clamp_rad_per_N_mm,
           &finger->back_surface_mm);
}

// The place where the rib meets the back beam, strictly inside it.
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

// Springs at both hinges: one number, or that in front and that behind. A
// calibration of free hinges may end a little below 0. A rib that bends is
// clamped without them.
void ReadHinges(const YamlMap& yaml, Rib* rib) {
  if (!yaml.Has(kHingeStiffness)) {
    if (rib->Bends()) {
      rib->front_hinge_N_mm_per_rad = rib->back_hinge_N_mm_per_rad =
          std::numeric_limits<double>::infinity();
    }
    return;
  }
  if (yaml.IsSequence(kHingeStiffness)) {
    const std::vector<double> both = yaml.Numbers(kHingeStiffness);
    if (both.size() != 2) {
      yaml.Fail(kHingeStiffness,
                std::string(kHingeStiffness) +
                    ": expected a number, or two: [front, back]");
    }
    rib->front_hinge_N_mm_per_rad = both[0];
    rib->back_hinge_N_mm_per_rad = both[1];
  } else {
    rib->front_hinge_N_mm_per_rad = rib->back_hinge_N_mm_per_rad =
        yaml.Number(kHingeStiffness);
  }
}

void ReadBending(const YamlMap& yaml, Rib* rib) {
  if (!yaml.Has(kBendingStiffness)) {
    if (yaml.Has(kRigidEnds)) {
      yaml.Fail(kRigidEnds, std::string(kRigidEnds) +
                                ": only a rib with bending_stiffness_N_mm2 "
                                "bends between its ends");
    }
    return;
  }
  rib->bending_stiffness_N_mm2 = yaml.PositiveNumber(kBendingStiffness);
  if (!yaml.Has(kRigidEnds)) return;
  const std::vector<double> ends = yaml.Numbers(kRigidEnds);
  if (ends.size() != 2 || !(ends[0] >= 0 && ends[1] >= 0)) {
    yaml.Fail(kRigidEnds, std::string(kRigidEnds) +
                              ": expected two lengths, none below 0: [front, "
                              "back]");
  }
  if (!(ends[0] + ends[1] < rib->length_mm)) {
    yaml.Fail(kRigidEnds, std::string(kRigidEnds) + ": the rib is " +
                              Short(rib->length_mm) +
                              " mm long, shorter than its rigid ends");
  }
  rib->front_rigid_mm = ends[0];
  rib->back_rigid_mm = ends[1];
}

Rib ReadRib(const YamlMap& yaml, const Finger& finger) {
  yaml.AllowOnly({"front_mm", "angle_deg", "back_mm", "length_mm",
                  "axial_stiffness_N", kHingeStiffness, kBendingStiffness,
                  kRigidEnds});
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
  ReadBending(yaml, &rib);
  ReadHinges(yaml, &rib);
  return rib;
}

void ReadRibs(const YamlMap& yaml, Finger* finger) {
  const std::vector<YamlMap> entries = yaml.Maps("ribs");
  yaml.CheckCount("ribs", entries.size(), kMostRibs);
  for (const YamlMap& entry : entries) {
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
                  "noise_V", "min_V", "max_V", "curvature_per_rad", "flat",
                  "creep", "hysteresis_rad"});
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
  gauge.curvature_per_rad =
      yaml.Number("curvature_per_rad", gauge.curvature_per_rad);
  if (yaml.Has("flat")) {
    const YamlMap flat = yaml.Map("flat");
    flat.AllowOnly({"share", "width_rad"});
    gauge.flat_share = flat.Number("share");
    if (!(gauge.flat_share < 1)) {
      flat.Fail("share", "share: expected a share below 1");
    }
    gauge.flat_width_rad = flat.PositiveNumber("width_rad");
  }
  if (yaml.Has("creep")) {
    const YamlMap creep = yaml.Map("creep");
    creep.AllowOnly({"share", "time_constant_s"});
    gauge.creep_share = creep.Number("share");
    if (!(gauge.creep_share > -1)) {
      creep.Fail("share", "share: expected a share above -1");
    }
    gauge.creep_time_constant_s = creep.PositiveNumber("time_constant_s");
  }
  gauge.hysteresis_rad =
      yaml.NonNegativeNumber("hysteresis_rad", gauge.hysteresis_rad);
  gauge.min_V = yaml.Number("min_V", gauge.min_V);
  gauge.max_V = yaml.Number("max_V", gauge.max_V);
  if (!(gauge.min_V < gauge.max_V)) {
    yaml.Fail("min_V", "min_V: expected less than max_V");
  }
  return gauge;
}

}  // namespace

Finger ReadFinger(const std::string& path) {
  return ReadFinger(YamlMap::FromFile(path));
}

Finger ReadFinger(const YamlMap& yaml) {
  // Checked first, as another version has other keys.
  const int version = yaml.Integer("schema_version");
  if (version != 1) {
    yaml.Fail("schema_version",
              "schema_version: expected 1, found " + std::to_string(version));
  }
  yaml.AllowOnly({"schema_version", "name", "geometry", "beams", "ribs",
                  "gauges", "calibration"});
  Finger finger;
  finger.name = yaml.Text("name");
  const YamlMap geometry = yaml.Map("geometry");
  geometry.AllowOnly({"front_length_mm", "back_angle_deg"});
  finger.front_length_mm = geometry.PositiveNumber("front_length_mm");
  if (finger.front_length_mm < kShortest_mm ||
      finger.front_length_mm > kLongest_mm) {
    geometry.Fail("front_length_mm", "front_length_mm: expected " +
                                         Short(kShortest_mm) + " to " +
                                         Short(kLongest_mm) + ", found " +
                                         Short(finger.front_length_mm));
  }
  const double angle = geometry.Number("back_angle_deg");
  if (!(angle > 90 && angle < 180)) {
    geometry.Fail("back_angle_deg",
                  "back_angle_deg: expected an angle between 90 and 180 "
                  "degrees, found " +
                      Short(angle));
  }
  finger.back_angle_rad = RadFromDegrees(geometry.Text("back_angle_deg"));
  ReadBeams(yaml.Map("beams"), &finger);
  CheckStiffnessRatio(yaml, finger);
  ReadRibs(yaml, &finger);
  const std::vector<YamlMap> gauges = yaml.Maps("gauges");
  yaml.CheckCount("gauges", gauges.size(), kMostGauges);
  for (const YamlMap& entry : gauges) {
    finger.gauges.push_back(ReadGauge(entry, finger));
  }
  if (yaml.Has("calibration")) {
    finger.calibration =
        ReadParameterCovariance(yaml.Map("calibration"), finger);
  }
  return finger;
}

}  // namespace finray

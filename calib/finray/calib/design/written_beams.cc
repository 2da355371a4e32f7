#include "finray/calib/design/written_beams.h"

#include "finray/io/yaml_map.h"

namespace finray {
namespace {

void AddPlate(const YamlMap& yaml, Side side,
              std::vector<WrittenPlate>* plates) {
  if (!yaml.Has("thickness_mm")) return;
  plates->push_back({side,
                     yaml.PlaceOf("thickness_mm") + SideName(side) + " beam",
                     yaml.Number("width_mm"), yaml.Number("thickness_mm"),
                     yaml.Number("youngs_modulus_GPa")});
}

}  // namespace

std::vector<WrittenPlate> ReadPlates(const std::string& path) {
  const YamlMap beams = YamlMap::FromFile(path).Map("beams");
  std::vector<WrittenPlate> plates;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const YamlMap beam = beams.Map(SideName(side));
    AddPlate(beam, side, &plates);
    for (const YamlMap& piece : beam.Maps("pieces")) {
      AddPlate(piece, side, &plates);
    }
  }
  return plates;
}

}  // namespace finray

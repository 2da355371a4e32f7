#include "finray/sensing/scene.h"

namespace finray {
namespace {

constexpr int kMostContacts = 16;

std::optional<int> ReadContacts(const YamlMap& yaml) {
  if (yaml.Text("contacts", "auto") == "auto") return std::nullopt;
  const int contacts = yaml.Integer("contacts");
  if (contacts < 0 || contacts > kMostContacts) {
    yaml.Fail("contacts", "expected a number of contacts from 0 to " +
                              std::to_string(kMostContacts) + ", or auto");
  }
  return contacts;
}

double ReadCircle(const YamlMap& object) {
  object.AllowOnly({"shape", "radius_mm"});
  object.Choice("shape", {"circle"});
  return object.PositiveNumber("radius_mm");
}

}  // namespace

std::map<std::string, std::string> ReadColumns(const YamlMap& yaml) {
  std::map<std::string, std::string> columns;
  if (!yaml.Has("columns")) return columns;
  const YamlMap map = yaml.Map("columns");
  for (const std::string& key : map.Keys()) columns[key] = map.Text(key);
  return columns;
}

Scene ReadScene(const YamlMap& yaml) {
  yaml.AllowOnly({"schema_version", "contacts", "friction_coefficient",
                  "object", "columns"});
  if (yaml.Has("schema_version") && yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  Scene scene;
  scene.contacts = ReadContacts(yaml);
  scene.friction_coefficient = yaml.Number("friction_coefficient", 0);
  if (yaml.Has("object"))
    scene.circle_radius_mm = ReadCircle(yaml.Map("object"));
  scene.columns = ReadColumns(yaml);
  return scene;
}

Scene ReadScene(const std::string& path) {
  return ReadScene(YamlMap::FromFile(path));
}

}  // namespace finray

#include "finray/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "finray/io/error.h"
#include "finray/io/message_text.h"
#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

constexpr int kMostContacts = 16;
// Each place of an outline is looked for among all of these.
constexpr std::size_t kMostVertices = 1000, kMostHarmonics = 100;

std::optional<int> ReadContacts(const YamlMap& yaml) {
  if (yaml.Text("contacts", "auto") == "auto") return std::nullopt;
  const int contacts = yaml.Integer("contacts");
  if (contacts < 0 || contacts > kMostContacts) {
    yaml.Fail("contacts", "expected a number of contacts from 0 to " +
                              std::to_string(kMostContacts) + ", or auto");
  }
  return contacts;
}

int ReadMostContacts(const YamlMap& yaml, const Scene& scene) {
  constexpr const char* kKey = "most_contacts";
  if (!yaml.Has(kKey)) return scene.most_contacts;
  if (scene.contacts) {
    yaml.Fail(kKey,
              "most_contacts: it is for contacts: auto, which is the "
              "default; leave out the number of contacts");
  }
  const int most = yaml.Integer(kKey);
  if (most < 1 || most > 2) {
    yaml.Fail(kKey, "most_contacts: expected 1 or 2");
  }
  return most;
}

bool HasBackContacts(const Scene& scene) {
  return std::count(scene.contact_beams.begin(), scene.contact_beams.end(),
                    Side::kBack) > 0;
}

void ReadContactBeams(const YamlMap& yaml, Scene* scene) {
  if (!yaml.Has("contact_beams")) return;
  for (const std::string& word :
       yaml.Choices("contact_beams", {"front", "back"})) {
    scene->contact_beams.push_back(word == "front" ? Side::kFront
                                                   : Side::kBack);
  }
  const std::size_t words = scene->contact_beams.size();
  const auto fail = [&](const std::string& expected) {
    yaml.Fail("contact_beams", "contact_beams: expected " + expected +
                                   ", found " + std::to_string(words));
  };
  if (scene->contacts) {
    if (words != static_cast<std::size_t>(*scene->contacts)) {
      fail("one word for each of the " + std::to_string(*scene->contacts) +
           " contacts");
    }
  } else if (words < 1 || words > kMostContacts) {
    fail("1 to " + std::to_string(kMostContacts) + " words");
  }
  if (scene->object && HasBackContacts(*scene)) {
    yaml.Fail("contact_beams",
              "contact_beams: an object touches the front beam only; leave out "
              "the object or 'back'");
  }
  scene->contact_beams_place = yaml.PlaceOf("contact_beams");
}

Outline::Shape ReadShape(const YamlMap& object) {
  const std::string shape = object.Choice(
      "shape", {"circle", "ellipse", "rounded_polygon", "support_series"});
  if (shape == "circle") {
    object.AllowOnly({"shape", "radius_mm", "spring"});
    return CircleOutline{object.PositiveNumber("radius_mm")};
  }
  if (shape == "ellipse") {
    object.AllowOnly({"shape", "semi_axis_x_mm", "semi_axis_y_mm", "spring"});
    return EllipseOutline{object.PositiveNumber("semi_axis_x_mm"),
                          object.PositiveNumber("semi_axis_y_mm")};
  }
  if (shape == "support_series") {
    object.AllowOnly({"shape", "radius_mm", "harmonics_mm", "spring"});
    SupportOutline outline{object.PositiveNumber("radius_mm")};
    for (const auto& harmonic : object.Pairs("harmonics_mm")) {
      outline.harmonics_mm.emplace_back(harmonic[0], harmonic[1]);
    }
    object.CheckCount("harmonics_mm", outline.harmonics_mm.size(),
                      kMostHarmonics);
    return outline;
  }
  object.AllowOnly({"shape", "vertices_mm", "fillet_radius_mm", "spring"});
  RoundedPolygonOutline polygon;
  for (const auto& vertex : object.Pairs("vertices_mm")) {
    polygon.vertices_mm.emplace_back(vertex[0], vertex[1]);
  }
  if (polygon.vertices_mm.size() < 2) {
    object.Fail("vertices_mm", "vertices_mm: expected at least 2 vertices");
  }
  object.CheckCount("vertices_mm", polygon.vertices_mm.size(), kMostVertices);
  polygon.fillet_radius_mm = object.PositiveNumber("fillet_radius_mm");
  return polygon;
}

RigidObject ReadObject(const YamlMap& object) {
  const Outline::Shape shape = ReadShape(object);
  std::optional<ObjectSpring> spring;
  if (object.Has("spring")) {
    const YamlMap map = object.Map("spring");
    map.AllowOnly({"stiffness_N_per_mm", "direction_deg"});
    spring = {map.PositiveNumber("stiffness_N_per_mm"),
              map.Number("direction_deg") * M_PI / 180};
  }
  try {
    return {Outline(shape), spring};
  } catch (const std::invalid_argument& error) {
    const char* key =
        object.Has("harmonics_mm") ? "harmonics_mm" : "vertices_mm";
    object.Fail(key, std::string(key) + ": " + error.what());
  }
}

// Reads the std of measured objects and points. A measured object locates the
// contact only if it is a circle with one contact, so other objects are
// refused.
void ReadMeasurements(const YamlMap& yaml, Scene* scene) {
  yaml.AllowOnly({"object_std_mm", "pin_std_mm", "tip_std_mm"});
  const auto read = [&yaml](const char* key) -> std::optional<double> {
    if (!yaml.Has(key)) return std::nullopt;
    return yaml.PositiveNumber(key);
  };
  scene->pin_std_mm = read("pin_std_mm");
  scene->tip_std_mm = read("tip_std_mm");
  scene->object_std_mm = read("object_std_mm");
  if (!scene->object_std_mm) return;
  const char* expected = nullptr;
  if (!scene->circle_radius_mm() || scene->object->spring) {
    expected = "an object of shape circle without a spring";
  } else if (scene->contacts.value_or(1) != 1) {
    expected = "contacts: 1 or auto";
  }
  if (expected != nullptr) {
    yaml.Fail("object_std_mm", std::string("object_std_mm: a measured object "
                                           "needs ") +
                                   expected + " in the scene");
  }
}

std::vector<std::vector<double>> Pairs(
    const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::vector<double>> pairs;
  for (const auto& point : points) pairs.push_back({point.x(), point.y()});
  return pairs;
}

void EmitShape(const CircleOutline& circle, YamlEmitter* yaml) {
  YamlPairs(yaml, "shape", "circle", "radius_mm", circle.radius_mm);
}

void EmitShape(const EllipseOutline& ellipse, YamlEmitter* yaml) {
  YamlPairs(yaml, "shape", "ellipse", "semi_axis_x_mm", ellipse.semi_axis_x_mm,
            "semi_axis_y_mm", ellipse.semi_axis_y_mm);
}

void EmitShape(const SupportOutline& outline, YamlEmitter* yaml) {
  YamlPairs(yaml, "shape", "support_series", "radius_mm", outline.radius_mm,
            "harmonics_mm", Pairs(outline.harmonics_mm));
}

void EmitShape(const RoundedPolygonOutline& polygon, YamlEmitter* yaml) {
  YamlPairs(yaml, "shape", "rounded_polygon", "vertices_mm",
            Pairs(polygon.vertices_mm), "fillet_radius_mm",
            polygon.fillet_radius_mm);
}

}  // namespace

void RefuseBackContacts(const Scene& scene) {
  if (HasBackContacts(scene)) {
    throw InputError(scene.contact_beams_place +
                     "contact_beams: contacts on the back beam can be "
                     "simulated only; expected front");
  }
}

std::string ContactBeamsToYaml(const Scene& scene) {
  std::vector<std::string> words;
  for (const Side side : scene.contact_beams) words.push_back(SideName(side));
  return "[" + Joined(words) + "]";
}

std::string ObjectToYaml(const RigidObject& object) {
  YamlEmitter yaml;
  yaml << YAML::Flow << YAML::BeginMap;
  std::visit([&](const auto& shape) { EmitShape(shape, &yaml); },
             object.outline.shape());
  if (object.spring) {
    yaml << YAML::Key << "spring" << YAML::Value;
    YamlLine(&yaml, "stiffness_N_per_mm", object.spring->stiffness_N_per_mm,
             "direction_deg", object.spring->direction_rad * 180 / M_PI);
  }
  yaml << YAML::EndMap;
  return yaml.c_str();
}

Scene ReadScene(const YamlMap& yaml) {
  std::vector<std::string> keys = {
      "schema_version",       "contacts",
      "most_contacts",        "contact_beams",
      "friction_coefficient", "friction_std",
      "force_max_N",          "object",
      "measurements",         "smoothing",
      "gauge_offset_walk",    "search_iteration_limit",
      "presliding_mm"};
  keys.insert(keys.end(), ColumnMappingKeys().begin(),
              ColumnMappingKeys().end());
  yaml.AllowOnly(keys);
  if (yaml.Has("schema_version") && yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  Scene scene;
  scene.contacts = ReadContacts(yaml);
  scene.most_contacts = ReadMostContacts(yaml, scene);
  scene.friction_coefficient = yaml.Number("friction_coefficient", 0);
  if (yaml.Has("friction_std")) {
    scene.friction_std = yaml.PositiveNumber("friction_std");
  }
  if (yaml.Has("presliding_mm")) {
    scene.presliding_mm = yaml.PositiveNumber("presliding_mm");
    if (scene.friction_coefficient < 0) {
      yaml.Fail("friction_coefficient",
                "expected 0 or more, as presliding_mm tells the way of "
                "friction");
    }
    if (yaml.Has("smoothing")) {
      yaml.Fail("presliding_mm", "does not go with smoothing");
    }
  }
  if (yaml.Has("force_max_N")) {
    scene.force_max_N = yaml.PositiveNumber("force_max_N");
  }
  if (yaml.Has("search_iteration_limit")) {
    scene.search_iteration_limit = yaml.Integer("search_iteration_limit");
    if (*scene.search_iteration_limit < 1) {
      yaml.Fail("search_iteration_limit",
                "search_iteration_limit: expected at least 1");
    }
  }
  if (yaml.Has("object")) scene.object = ReadObject(yaml.Map("object"));
  if (scene.presliding_mm && !scene.object) {
    yaml.Fail("presliding_mm",
              "presliding_mm: it needs an object in the scene, whose motion "
              "turns friction round");
  }
  ReadContactBeams(yaml, &scene);
  if (yaml.Has("measurements")) {
    ReadMeasurements(yaml.Map("measurements"), &scene);
  }
  if (yaml.Has("smoothing")) {
    const YamlMap map = yaml.Map("smoothing");
    map.AllowOnly({"contact_std_mm", "normal_std_N"});
    if (scene.contacts.value_or(1) != 1) {
      yaml.Fail("smoothing",
                "smoothing: it needs contacts: 1 or auto in the scene");
    }
    scene.smoothing = {map.PositiveNumber("contact_std_mm"),
                       map.PositiveNumber("normal_std_N")};
  }
  if (yaml.Has("gauge_offset_walk")) {
    const YamlMap map = yaml.Map("gauge_offset_walk");
    map.AllowOnly({"start_std_V", "std_V_per_sqrt_s"});
    scene.gauge_offset_walk = {map.PositiveNumber("start_std_V"),
                               map.PositiveNumber("std_V_per_sqrt_s")};
  }
  scene.columns = ReadColumnMapping(yaml);
  return scene;
}

Scene ReadScene(const std::string& path) {
  return ReadScene(YamlMap::FromFile(path));
}

}  // namespace finray

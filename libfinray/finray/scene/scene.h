#ifndef FINRAY_SCENE_SCENE_H_
#define FINRAY_SCENE_SCENE_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "finray/io/yaml_map.h"
#include "finray/objects/object_contact.h"

namespace finray {

/// Std of the change from frame to frame.
struct Smoothing {
  double contact_mm;
  double normal_N;
};

/// What a scene contains, hence what is modelled.
struct Scene {
  /// Number of contacts; empty: decided frame by frame ("auto").
  std::optional<int> contacts;
  /// How many "auto" may find.
  int most_contacts = 2;
  /// The beam of each point contact, contact_1 first; empty: all in front.
  std::vector<Side> contact_beams;
  /// "path:line:column: " of that list, for messages.
  std::string contact_beams_place = "scene: ";
  double friction_coefficient = 0;  ///< mu; + pulls the finger to its tip.
  std::optional<RigidObject> object;
  /// How well object_x_mm, object_y_mm are known, if the estimate of a contact
  /// is to use them.
  std::optional<double> object_std_mm;
  /// How well a camera knows rib pins and the tip, where the estimate is to use
  /// them (--solver ceres).
  std::optional<double> pin_std_mm, tip_std_mm;
  /// How much l_c and f_c change from a frame to the next, if neighbours are to
  /// be smoothed.
  std::optional<Smoothing> smoothing;
  /// A lab's own headers for columns of the frame table.
  std::map<std::string, std::string> columns;

  bool UsesCamera() const { return pin_std_mm || tip_std_mm; }
  /// The radius of the object if there is one and it is a circle.
  std::optional<double> circle_radius_mm() const {
    return object ? object->outline.circle_radius_mm() : std::nullopt;
  }
};

/// Reads a scene YAML. Throws InputError for unknown keys and for what is not
/// modelled.
Scene ReadScene(const std::string& path);
Scene ReadScene(const YamlMap& yaml);

/// Throws InputError at the place of `contact_beams` if any is the back beam,
/// for tools that know contacts on the front beam only.
void RefuseBackContacts(const Scene& scene);

/// The words of `contact_beams`, "[front, back]".
std::string ContactBeamsToYaml(const Scene& scene);

/// The `object:` mapping of a scene as YAML on one line, read back the same.
std::string ObjectToYaml(const RigidObject& object);

/// The `columns:` mapping of a YAML, empty if there is none.
std::map<std::string, std::string> ReadColumns(const YamlMap& yaml);

}  // namespace finray

#endif  // FINRAY_SCENE_SCENE_H_

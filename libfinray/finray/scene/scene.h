#ifndef FINRAY_SCENE_SCENE_H_
#define FINRAY_SCENE_SCENE_H_

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/known_friction.h"
#include "finray/io/column_mapping.h"
#include "finray/io/yaml_map.h"
#include "finray/objects/object_contact.h"

namespace finray {

/// Standard deviations of the changes from one frame to the next.
struct Smoothing {
  double contact_mm;
  double normal_N;
};

/// Offsets of the gauges that wander: each starts within start_std_V of the
/// finger's and is a random walk from there.
struct GaugeOffsetWalk {
  double start_std_V;
  double std_V_per_sqrt_s;  ///< Std of its change in a second.
};

/// The contents of a scene. Only these are modelled.
struct Scene {
  /// Number of contacts. Empty for "auto": the estimator decides frame by
  /// frame.
  std::optional<int> contacts;
  /// The largest number of contacts under "auto": 1 (none or one) or 2.
  int most_contacts = 2;
  /// The beam of each point contact, contact_1 first. Empty: all contacts are
  /// on the front beam.
  std::vector<Side> contact_beams;
  /// "path:line:column: " of `contact_beams` in the YAML, for messages.
  std::string contact_beams_place = "scene: ";
  double friction_coefficient = 0;  ///< mu; + pulls towards the tip.
  /// Its std, an error that all frames share.
  double friction_std = 0;
  /// The slip of the object in which friction turns round (SlidingFriction).
  /// Empty: friction does not follow the object's motion.
  std::optional<double> presliding_mm;
  std::optional<RigidObject> object;
  /// Std of object_x_mm and object_y_mm. Empty: the estimate of a contact does
  /// not use them.
  std::optional<double> object_std_mm;
  /// Std of the rib pins and of the tip seen by a camera. Empty: the estimate
  /// does not use them.
  std::optional<double> pin_std_mm, tip_std_mm;
  /// The largest credible force of a contact. Empty: a multiple of EI / l_0^2
  /// (ContactSearch::most_force_N).
  std::optional<double> force_max_N;
  /// The most iterations that the searches of one frame take together. Empty:
  /// no limit.
  std::optional<int> search_iteration_limit;
  /// How much l_c and f_c change between frames. Empty: neighbouring frames are
  /// not smoothed.
  std::optional<Smoothing> smoothing;
  /// Empty: the offsets are the finger's.
  std::optional<GaugeOffsetWalk> gauge_offset_walk;
  /// How a lab writes its logs.
  ColumnMapping columns;

  /// Contacts with this friction that nothing but gauges senses.
  static Scene OfGauges(double friction_coefficient) {
    Scene scene;
    scene.friction_coefficient = friction_coefficient;
    return scene;
  }

  KnownFriction friction() const {
    return {friction_coefficient, friction_std};
  }
  bool UsesCamera() const { return pin_std_mm || tip_std_mm; }
  /// The number of contacts that an estimate may find with readings of so many
  /// gauges. With `contacts: auto` two need a gauge for each of their four
  /// unknowns, and a measured object touches once.
  int MostContacts(std::size_t gauges) const {
    if (contacts) return *contacts;
    return object_std_mm || gauges < 4 ? std::min(1, most_contacts)
                                       : most_contacts;
  }
  /// The radius of the object if it is a circle, else empty.
  std::optional<double> circle_radius_mm() const {
    return object ? object->outline.circle_radius_mm() : std::nullopt;
  }
};

/// Reads a scene YAML. Throws InputError for unknown keys and for scenes that
/// are not modelled.
Scene ReadScene(const std::string& path);
Scene ReadScene(const YamlMap& yaml);

/// Throws InputError at the place of `contact_beams` if a contact is on the
/// back beam. Tools call it that handle front contacts only.
void RefuseBackContacts(const Scene& scene);

/// Returns `contact_beams` as YAML, "[front, back]".
std::string ContactBeamsToYaml(const Scene& scene);

/// Returns the `object:` mapping of a scene as one line of YAML. Reading it
/// gives the same object.
std::string ObjectToYaml(const RigidObject& object);

}  // namespace finray

#endif  // FINRAY_SCENE_SCENE_H_

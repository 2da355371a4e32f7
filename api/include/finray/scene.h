#ifndef FINRAY_SCENE_H_
#define FINRAY_SCENE_H_

#include <memory>
#include <string>

#include "finray/export.h"

namespace finray::v1 {

/// What an experiment contains, and hence what is modelled: the number of
/// contacts, friction, an object, and so on. It is described by a scene YAML
/// (docs/reference/formats.md) and does not change.
class FINRAY_API Scene {
 public:
  /// `contacts: auto`, and nothing else.
  Scene();
  /// Reads a scene YAML. Throws InputError (file:line:column).
  static Scene Read(const std::string& path);
  /// The same of a text, "contacts: 1". `name` stands for the path in messages.
  static Scene FromYaml(const std::string& text,
                        const std::string& name = "scene");

  /// The text that the scene was read from.
  std::string ToYaml() const;
  std::string path() const;

  struct Inside;
  const Inside& inside() const { return *inside_; }

 private:
  explicit Scene(std::shared_ptr<const Inside> inside);
  std::shared_ptr<const Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_SCENE_H_

#include "inside.h"

namespace finray::v1 {

Scene::Scene(std::shared_ptr<const Inside> inside)
    : inside_(std::move(inside)) {}

Scene::Scene()
    : inside_(std::make_shared<Inside>(
          Inside{finray::Scene(), "contacts: auto\n", "scene"})) {}

Scene Scene::Read(const std::string& path) {
  return Guarded([&] {
    return Scene(std::make_shared<Inside>(
        Inside{ReadScene(path), YamlText(path), path}));
  });
}

Scene Scene::FromYaml(const std::string& text, const std::string& name) {
  return Guarded([&] {
    return Scene(std::make_shared<Inside>(
        Inside{ReadScene(YamlMap::FromText(text, name)), text, name}));
  });
}

std::string Scene::ToYaml() const { return inside_->text; }
std::string Scene::path() const { return inside_->path; }

}  // namespace finray::v1

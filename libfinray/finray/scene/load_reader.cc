#include "finray/scene/load_reader.h"

#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/scene/frame_columns.h"

namespace finray {

LoadReader::LoadReader(const Finger& finger, const Scene& scene,
                       const FrameTable& table)
    : finger_(finger), scene_(scene), table_(table) {
  for (int c = 0; table.Has(ContactArc(c)); ++c) {
    arc_.push_back(table.Numbers(ContactArc(c)));
    normal_.push_back(table.Numbers(NormalForce(c)));
    friction_.push_back(table.NumbersOrNan(Friction(c)));
  }
  if (!scene.contact_beams.empty() &&
      arc_.size() > scene.contact_beams.size()) {
    throw InputError(scene.contact_beams_place +
                     "contact_beams: expected a word for each "
                     "of the " +
                     std::to_string(arc_.size()) + " contacts in " +
                     table.path() + ", found " +
                     std::to_string(scene.contact_beams.size()));
  }
  x_ = table.NumbersOrNan("object_x_mm");
  y_ = table.NumbersOrNan("object_y_mm");
  angle_ = table.NumbersOrNan("object_angle_deg");
  if (table.Has("object_x_mm") && arc_.empty() && !scene.object) {
    throw InputError(table.path() +
                     ": has the object's place, but the scene has no object; "
                     "give one with --scene");
  }
}

RowLoad LoadReader::Read(std::size_t row) const {
  RowLoad load;
  for (int c = 0; c < contacts(); ++c) {
    const double arc = arc_[c][row], normal = normal_[c][row];
    if (std::isnan(arc) && (std::isnan(normal) || normal == 0)) continue;
    const Side side =
        scene_.contact_beams.empty() ? Side::kFront : scene_.contact_beams[c];
    const double length = BeamLength(finger_, side);
    if (!(arc >= 0 && arc <= length)) {
      Fail(row, ContactArc(c) + ": expected an arc length on the " +
                    SideName(side) + " beam, 0 to " + std::to_string(length) +
                    " mm");
    }
    if (!(normal >= 0)) {
      Fail(row, NormalForce(c) + ": expected a force of at least 0 N with " +
                    ContactArc(c));
    }
    const double mu = friction_[c][row];
    load.contacts.push_back(
        {arc, normal, std::isnan(mu) ? scene_.friction_coefficient : mu, side});
  }
  if (std::isnan(x_[row]) != std::isnan(y_[row])) {
    Fail(row, "object_x_mm and object_y_mm: expected both or neither");
  }
  if (load.contacts.empty() && std::isfinite(x_[row]) && scene_.object) {
    const double angle = std::isnan(angle_[row]) ? 0 : angle_[row];
    load.object = {{x_[row], y_[row]}, angle * M_PI / 180};
  }
  return load;
}

void LoadReader::Fail(std::size_t row, const std::string& message) const {
  throw InputError(table_.path() + ":" + std::to_string(table_.line(row)) +
                   ": " + message);
}

}  // namespace finray

#ifndef FINRAY_SCENE_LOAD_READER_H_
#define FINRAY_SCENE_LOAD_READER_H_

#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/io/frame_table.h"
#include "finray/scene/scene.h"

namespace finray {

/// The load on the finger in one row of a frame table.
struct RowLoad {
  std::vector<PointContact> contacts;
  std::optional<ObjectPose> object;  ///< Set only if there are no contacts.
};

/// Reads the loads of a frame table for the simulation. Throws InputError with
/// the line of a load that is incomplete, negative or off the beam.
class LoadReader {
 public:
  /// Keeps references to all three arguments.
  LoadReader(const Finger& finger, const Scene& scene, const FrameTable& table);

  /// The number of point contacts that the columns can hold.
  int contacts() const { return static_cast<int>(arc_.size()); }
  RowLoad Read(std::size_t row) const;

 private:
  [[noreturn]] void Fail(std::size_t row, const std::string& message) const;

  const Finger& finger_;
  const Scene& scene_;
  const FrameTable& table_;
  std::vector<std::vector<double>> arc_, normal_, friction_;
  std::vector<double> x_, y_, angle_;
};

}  // namespace finray

#endif  // FINRAY_SCENE_LOAD_READER_H_

#ifndef FINRAY_TESTS_STATICS_RANDOM_FINGER_H_
#define FINRAY_TESTS_STATICS_RANDOM_FINGER_H_

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/ladder/ladder.h"

namespace finray {

/// Fingers and loads over all that a lab may build and do, from a seed. Draws
/// numbers itself, as those of <random>'s distributions differ by library.
class RandomFinger {
 public:
  explicit RandomFinger(unsigned seed) : engine_(seed) {
    while (!Draw()) {
    }
    DrawLoads();
  }

  const Finger& finger() const { return finger_; }
  const std::vector<PointContact>& contacts() const { return contacts_; }
  double Uniform(double from, double to) {
    return from + (to - from) * engine_() / 4294967296.0;
  }

 private:
  double LogUniform(double from, double to) {
    return std::exp(Uniform(std::log(from), std::log(to)));
  }
  bool Chance(double probability) { return Uniform(0, 1) < probability; }
  int Count(int most) { return static_cast<int>(Uniform(0, most + 1)); }

  // False if the ribs would cross or come too close to each other.
  bool Draw() {
    finger_ = {};
    finger_.name = "random";
    finger_.front_length_mm = Uniform(40, 250);
    finger_.back_angle_rad = Uniform(95, 135) * M_PI / 180;
    const double front = finger_.front_length_mm;
    const double back = BeamLength(finger_, Side::kBack);
    const double size = std::pow(front / 140, 2);
    finger_.front_stiffness_N_mm2 = LogUniform(500, 2e5) * size;
    finger_.back_stiffness_N_mm2 = LogUniform(500, 2e5) * size;
    if (Chance(0.15)) finger_.front_axial_stiffness_N = LogUniform(1e4, 1e6);
    if (Chance(0.15)) finger_.back_axial_stiffness_N = LogUniform(1e4, 1e6);
    const double spacing = 0.04 * front;
    const std::vector<double> at = Places(Count(10), front, spacing);
    if (Chance(0.5)) {
      const double angle = Uniform(-10, 25) * M_PI / 180;
      for (const double arc : at) {
        const double turn = angle + Uniform(-3, 3) * M_PI / 180;
        finger_.ribs.push_back({arc, RibBackArc(finger_, arc, turn), 0});
      }
    } else {
      const std::vector<double> behind =
          Places(static_cast<int>(at.size()), back, spacing);
      for (std::size_t i = 0; i < at.size(); ++i) {
        finger_.ribs.push_back({at[i], behind[i], 0});
      }
    }
    const double prestress = Chance(0.4) ? Uniform(0, 5e-3) : 0;
    double last = 0;
    for (Rib& rib : finger_.ribs) {
      if (!(rib.back_mm - last >= spacing && back - rib.back_mm >= spacing)) {
        return false;
      }
      last = rib.back_mm;
      rib.length_mm =
          NominalRibLength(finger_, rib) * (1 + prestress * Uniform(-1, 1));
      if (Chance(0.15)) rib.axial_stiffness_N = LogUniform(50, 1e5);
    }
    if (Chance(0.2)) finger_.front_pieces = DrawPieces(front);
    if (Chance(0.2)) finger_.back_pieces = DrawPieces(back);
    for (int j = 0; j < 3; ++j) {
      Gauge gauge;
      gauge.beam = Chance(0.5) ? Side::kFront : Side::kBack;
      const double length = BeamLength(finger_, gauge.beam);
      gauge.start_mm = Uniform(0, 0.85) * length;
      gauge.length_mm = Uniform(0.05, 0.15) * length;
      finger_.gauges.push_back(gauge);
    }
    return true;
  }

  // Sorted places on a beam, apart from each other and its ends.
  std::vector<double> Places(int count, double length, double spacing) {
    const double free = length - (count + 1) * spacing;
    std::vector<double> places(count);
    for (double& place : places) place = Uniform(0, free);
    std::sort(places.begin(), places.end());
    for (int i = 0; i < count; ++i) places[i] += (i + 1) * spacing;
    return places;
  }

  std::vector<StiffnessPiece> DrawPieces(double length) {
    std::vector<StiffnessPiece> pieces;
    for (const double end : Places(1 + Count(3), length, 0.05 * length)) {
      pieces.push_back({end, LogUniform(0.3, 3)});
    }
    pieces.push_back({length, LogUniform(0.3, 3)});
    return pieces;
  }

  void DrawLoads() {
    const double length = finger_.front_length_mm;
    const double softest =
        std::min(finger_.front_stiffness_N_mm2, finger_.back_stiffness_N_mm2);
    const double most = 50 * softest / (length * length);
    const int count = Count(3);
    for (int i = 0; i < count; ++i) {
      PointContact contact;
      contact.side = Chance(0.85) ? Side::kFront : Side::kBack;
      contact.arc_mm = Uniform(0, 1) * BeamLength(finger_, contact.side);
      contact.normal_N = LogUniform(1e-3, 30);
      contact.friction = Chance(0.5) ? Uniform(-0.5, 0.8) : 0;
      contacts_.push_back(contact);
    }
    double sum = 0;
    for (const PointContact& contact : contacts_) sum += contact.normal_N;
    for (PointContact& contact : contacts_) {
      contact.normal_N *= std::min(1.0, most / sum);
    }
  }

  std::mt19937 engine_;
  Finger finger_;
  std::vector<PointContact> contacts_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_RANDOM_FINGER_H_

#ifndef FINRAY_TESTS_STATICS_PAPER_FINGER_H_
#define FINRAY_TESTS_STATICS_PAPER_FINGER_H_

#include "finray/finger/finger.h"
#include "finray/finger/finger_yaml.h"

namespace finray {

/// The finger of the paper's Table I: 140 mm, five ribs, four gauges.
inline Finger PaperFinger() {
  return ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
}

/// The same with each rib's length off nominal, so that it is prestressed.
inline Finger PrestressedPaperFinger() {
  Finger finger = PaperFinger();
  const double error_mm[] = {0.3, -0.4, 0.5, -0.2, 0.25};
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    finger.ribs[i].length_mm += error_mm[i];
  }
  return finger;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_PAPER_FINGER_H_

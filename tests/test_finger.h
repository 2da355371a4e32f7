#ifndef FINRAY_TESTS_TEST_FINGER_H_
#define FINRAY_TESTS_TEST_FINGER_H_

#include <string>

#include "finray/finger/finger_yaml.h"

namespace finray {

/// The paper's finger, Table I.
inline Finger PaperFinger() {
  return ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
}

}  // namespace finray

#endif  // FINRAY_TESTS_TEST_FINGER_H_

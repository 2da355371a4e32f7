// Two contacts that wander for FRAMES frames, followed in blocks and searched
// alone: how many statuses differ, and how far apart the estimates are. With
// `blocks` or `alone` it only estimates, for callgrind.
//
//   build/test/tests/followed_pairs_study [FRAMES [blocks|alone]]

#include <cstdlib>
#include <string>

#include "finray/finger/finger_yaml.h"
#include "studies/pair_log.h"

int main(int argc, char** argv) {
  using namespace finray;
  const int frames = argc > 1 ? std::atoi(argv[1]) : 3000;
  const std::string only = argc > 2 ? argv[2] : "";
  for (const char* name :
       {"paper_140mm.yaml", "paper_140mm_eight_gauges.yaml"}) {
    const Finger finger = WithLittleNoise(
        ReadFinger(std::string(FINRAY_SOURCE_DIR "/configs/fingers/") + name));
    const PairLog log = SimulatePairs(finger, frames, WanderingPair);
    if (only.empty()) {
      std::printf("%s: ", name);
      ComparePairs(finger, SceneOfTwo(), log);
      continue;
    }
    FrameEstimator estimator(finger, SceneOfTwo());
    if (only == "blocks") {
      EstimateInBlocks(&estimator, log);
    } else {
      for (const Measurements& row : log.rows) estimator.Estimate(row);
    }
    break;  // callgrind counts one finger
  }
}

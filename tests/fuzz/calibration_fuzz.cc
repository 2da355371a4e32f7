#include "fuzz/fuzz.h"

FINRAY_FUZZ_TARGET(finray::ReadCalibrationYaml)

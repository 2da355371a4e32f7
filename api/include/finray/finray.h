#ifndef FINRAY_FINRAY_H_
#define FINRAY_FINRAY_H_

/// The public face of finray: simulate, estimate, sense live, calibrate and
/// reconstruct. It needs nothing but the standard library. finray/residuals.h,
/// for residuals of your own, needs Ceres and is not included here.
///
/// Units are mm, N, rad and V, and stand in every name. Frame S: the origin is
/// at the base of the front beam, +y along the undeformed front beam, +x
/// towards the back beam. Bad input throws InputError with one line that says
/// where and what was expected (finray/error.h).
///
/// The interface keeps its binary form as long as the soname (libfinray.so.1)
/// stays.

#include "finray/calibration.h"     // IWYU pragma: export
#include "finray/error.h"           // IWYU pragma: export
#include "finray/estimator.h"       // IWYU pragma: export
#include "finray/finger.h"          // IWYU pragma: export
#include "finray/live_estimator.h"  // IWYU pragma: export
#include "finray/reconstruction.h"  // IWYU pragma: export
#include "finray/scene.h"           // IWYU pragma: export
#include "finray/simulator.h"       // IWYU pragma: export
#include "finray/table.h"           // IWYU pragma: export
#include "finray/version.h"         // IWYU pragma: export

#endif  // FINRAY_FINRAY_H_

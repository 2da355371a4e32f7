#ifndef FINRAY_API_SRC_INSIDE_H_
#define FINRAY_API_SRC_INSIDE_H_

// What the public classes hold. In the sources here, Finger is the public class
// and finray::Finger the internal one.

#include <exception>
#include <new>
#include <string>
#include <vector>

#include "finray/calib/problem/plan.h"
#include "finray/calibration.h"
#include "finray/error.h"
#include "finray/estimation/frame_estimate.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimator.h"
#include "finray/finger.h"
#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/error.h"
#include "finray/io/frame_table.h"
#include "finray/io/warning.h"
#include "finray/live_estimator.h"
#include "finray/perception/reconstruction.h"
#include "finray/scene.h"
#include "finray/scene/scene.h"
#include "finray/table.h"

namespace finray::v1 {

struct Finger::Inside {
  finray::Finger finger;
  std::string text, path;
};

struct Scene::Inside {
  finray::Scene scene;
  std::string text, path;
};

struct Plan::Inside {
  finray::Plan plan;
  std::string text, path;
};

/// Returns call(), with the internal exceptions as public ones.
template <class Call>
auto Guarded(Call call) -> decltype(call()) {
  try {
    return call();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const finray::InputError& error) {
    throw InputError(error.what());
  } catch (const finray::SpreadError& error) {
    throw GateError(error.what());
  } catch (const std::exception& error) {
    throw SolveError(error.what());
  }
}

/// Copies a table, with text where its columns hold text.
FrameTable ToFrameTable(const Table& table);
Table FromFrameTable(const FrameTable& table, const std::string& name);

std::vector<Warning> ToPublic(const std::vector<finray::Warning>& warnings);

finray::Discretization ToInternal(const Discretization& discretization);

/// The method of the options. Throws InputError for a word that is none.
finray::FrameMethod MethodOf(const EstimateOptions& options);

/// The text of a file that holds YAML.
std::string YamlText(const std::string& path);

/// The scene of estimates: those of frames in their order, jointly or live, use
/// its gauge_offset_walk.
finray::Scene SceneOf(const Scene& scene, bool in_order);

}  // namespace finray::v1

#endif  // FINRAY_API_SRC_INSIDE_H_

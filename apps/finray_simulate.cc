// Solves the finger for given contacts or object places, row by row.

#include "app.h"
#include "finray/scene/simulation.h"

DEFINE_string(finger, "", "finger YAML");
DEFINE_string(scene, "", "scene YAML; needed for rows with an object");
DEFINE_string(frames, "", "CSV with contact_<c>_mm, normal_<c>_N or object_*");
DEFINE_string(out, "", "CSV to write: the frames with everything filled in");
DEFINE_string(shape_out, "", "CSV to write: both beams of every row");
DEFINE_string(log_out, "",
              "CSV to write: a log as a lab would record it, with noise");
DEFINE_double(force_std_N, 0.02, "noise of force_N in --log_out");
DEFINE_double(object_std_mm, 0.05, "noise of object_* in --log_out");
DEFINE_double(pin_std_mm, 0, "noise of rib pins in --log_out; 0: no pins");
DEFINE_uint64(seed, 1, "seed of the noise in --log_out");
DEFINE_bool(strict, true, "exit code 3 if any row has no solution");

namespace {

int Run() {
  using namespace finray;
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Scene scene = FLAGS_scene.empty() ? Scene() : ReadScene(FLAGS_scene);
  const std::string& in = Required("frames", FLAGS_frames);
  const std::string& out = Required("out", FLAGS_out);
  const Discretization discretization = DiscretizationFlags();
  if (DumpConfigFlag(finger, scene, discretization)) return kGood;
  if (!(FLAGS_force_std_N >= 0 && FLAGS_object_std_mm >= 0 &&
        FLAGS_pin_std_mm >= 0)) {
    throw InputError(
        "--force_std_N, --object_std_mm, --pin_std_mm: expected at least 0");
  }

  FrameTable frames = FrameTable::Read(in, scene.columns);
  FrameTable shapes;
  const SimulationSummary summary =
      Simulate(finger, scene, discretization, &frames,
               FLAGS_shape_out.empty() ? nullptr : &shapes);
  frames.Write(out);
  if (!FLAGS_shape_out.empty()) shapes.Write(FLAGS_shape_out);
  if (!FLAGS_log_out.empty()) {
    MakeLog(
        finger, frames,
        {FLAGS_force_std_N, FLAGS_object_std_mm, FLAGS_seed, FLAGS_pin_std_mm})
        .Write(FLAGS_log_out);
  }
  std::cout << out << "\n"
            << "finger         " << finger.name << "\n"
            << "scheme         " << FLAGS_scheme << "\n"
            << "with contact   " << summary.contact << "\n"
            << "without        " << summary.free << "\n"
            << "not converged  " << summary.not_converged << "\n";
  if (summary.not_converged > 0) {
    Warn(std::to_string(summary.not_converged) + " of " +
             std::to_string(frames.rows()) + " rows have no solution, first " +
             summary.first_failure,
         "their cells are empty; lower their loads");
  }
  const bool none = summary.contact + summary.free == 0;
  return none || (FLAGS_strict && summary.not_converged > 0) ? kSolveFailed
                                                             : kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Shape, gauges, rib forces and tip of a finger under given contacts.\n"
    "finray_simulate --finger F.yaml --frames in.csv --out out.csv "
    "[--scene S.yaml] [--shape_out shape.csv] [--log_out log.csv]",
    Run};

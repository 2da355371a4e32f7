// Reconstructs the outline of an object from touches of a finger.

#include <cmath>
#include <cstdio>

#include "app.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/io/atomic_file.h"
#include "finray/io/python_script.h"
#include "finray/perception/perception_files.h"
#include "finray/perception/polygon.h"

DEFINE_string(finger, "", "finger YAML, preferably calibrated");
DEFINE_string(scene, "", "scene YAML; default: contacts: auto");
DEFINE_string(logs, "",
              "CSV of touches: gauge_<j>_V, object_x_mm, object_y_mm, "
              "object_angle_deg, one row a touch");
DEFINE_string(out_dir, "",
              "folder for outline.csv, reconstruction.yaml, outline.svg");
DEFINE_string(truth, "", "CSV with x_mm, y_mm of the true outline");
DEFINE_double(stage_std_mm, 0.02, "std of object_x_mm and object_y_mm");
DEFINE_int32(descriptors, 19, "odd number of Fourier descriptors");
DEFINE_double(envelope_mm, 10,
              "length of beam on each side of a contact in the paper's "
              "interior envelope");
DEFINE_bool(plots, true, "draw outline.svg and outline.png");

namespace {

using namespace finray;

constexpr int kDrawnPoints = 1440;

void CheckFlags() {
  if (!(FLAGS_stage_std_mm > 0) || !std::isfinite(FLAGS_stage_std_mm)) {
    throw UsageError("--stage_std_mm: expected a number above 0");
  }
  if (!(FLAGS_envelope_mm > 0) || !std::isfinite(FLAGS_envelope_mm)) {
    throw UsageError("--envelope_mm: expected a number above 0");
  }
  if (FLAGS_descriptors < 3 || FLAGS_descriptors % 2 == 0 ||
      FLAGS_descriptors > 999) {
    throw UsageError("--descriptors: expected an odd number from 3 to 999");
  }
}

void PrintSummary(const Reconstruction& found,
                  const std::optional<RadialError>& error,
                  const std::optional<RadialError>& envelope_error) {
  std::printf("%s\n", OutPath("outline.csv").c_str());
  std::printf("touches        %zu of %zu rows usable, %zu contacts\n",
              found.touches.rows.at(FrameStatus::kOk), found.touches.all_rows(),
              found.touches.usable.size());
  double std = 0;
  for (const OutlinePoint& point : found.outline) {
    std += point.std_mm / static_cast<double>(found.outline.size());
  }
  std::printf(
      "outline        %.4g mm around, mean std %.2g mm, noise %.2f of the "
      "expected\n",
      found.fit.curve.perimeter_mm(), std, found.fit.noise_scale);
  std::printf("supported      %.0f %%; no touch lies on %zu stretch%s",
              100 * found.supported_share, found.gaps.size(),
              found.gaps.size() == 1 ? "" : "es");
  std::printf("%s\n", found.gaps.empty()
                          ? ""
                          : ": straight edges or dents, which a finger "
                            "cannot tell apart");
  if (!error) {
    std::printf("radial error   unknown without --truth\n");
    return;
  }
  std::printf(
      "radial error   mean %.3g %%, 95 %% below %.3g %%, largest %.3g "
      "%%; interior envelope %.3g, %.3g, %.3g %%\n",
      error->Mean(), error->Quantile(0.95), error->Largest(),
      envelope_error->Mean(), envelope_error->Quantile(0.95),
      envelope_error->Largest());
}

int Run() {
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Scene scene = FLAGS_scene.empty() ? Scene() : ReadScene(FLAGS_scene);
  const Discretization discretization = DiscretizationFlags();
  if (DumpConfigFlag(finger, scene, discretization)) return kGood;
  const std::string& log = Required("logs", FLAGS_logs);
  Required("out_dir", FLAGS_out_dir);
  CheckFlags();
  if (SplitList(log).size() != 1) {
    throw UsageError("--logs: expected one log, the touches of one object");
  }
  std::vector<std::string> inputs = {FLAGS_finger, log};
  for (const std::string& path :
       {FLAGS_scene, scene.columns.path, FLAGS_truth}) {
    if (!path.empty()) inputs.push_back(path);
  }
  RefuseToOverwrite(inputs,
                    {OutPath("outline.csv"), OutPath("touches.csv"),
                     OutPath("beams.csv"), OutPath("reconstruction.yaml")});
  const FrameTable table = FrameTable::Read(log, scene.columns);
  std::optional<Polygon> truth;
  if (!FLAGS_truth.empty()) truth = ReadOutline(FLAGS_truth);

  Reconstruction found;
  try {
    found =
        Reconstruct(table, finger, scene, discretization, FLAGS_stage_std_mm);
  } catch (const SpreadError& error) {
    std::cerr << "finray_reconstruct: " << error.what() << "\n";
    return kGateFailed;
  }
  const FourierDescriptors descriptors(found.polygon(), FLAGS_descriptors);
  const FourierDescriptors envelope(
      InteriorEnvelope(found.touches.usable, FLAGS_envelope_mm),
      FLAGS_descriptors);
  std::optional<RadialError> error, envelope_error;
  if (truth) {
    error = CompareRadii(found.polygon(), *truth);
    envelope_error = CompareRadii(envelope.Sampled(kDrawnPoints), *truth);
  }

  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(OutPath("outline.csv"), OutlineCsv(found, error));
  WriteFileAtomically(OutPath("touches.csv"), TouchCsv(found));
  WriteFileAtomically(OutPath("beams.csv"), BeamCsv(found, FLAGS_envelope_mm));
  WriteFileAtomically(OutPath("reconstruction.yaml"),
                      ReconstructionYaml(found, descriptors, envelope, error,
                                         envelope_error, inputs));
  PrintSummary(found, error, envelope_error);
  Warn(FrictionWarnings(finger, scene));
  if (FLAGS_plots) {
    std::vector<std::string> arguments = {FLAGS_out_dir};
    if (truth) arguments.push_back(FLAGS_truth);
    const std::string problem =
        RunPythonScript("scripts/perception/plot_outline.py", arguments,
                        "python3-matplotlib and python3-yaml");
    if (!problem.empty()) Warn("no plots", problem);
  }
  return kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Reconstructs the outline of an object from touches of a finger.\n"
    "finray_reconstruct --finger F.yaml --logs touches.csv --out_dir D "
    "[--scene S.yaml] [--truth outline.csv]",
    Run};

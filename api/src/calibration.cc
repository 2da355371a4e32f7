#include <cmath>
#include <utility>

#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/report/explored_calibration.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/atomic_file.h"
#include "finray/io/usable_cores.h"
#include "inside.h"

namespace finray::v1 {

Plan::Plan(std::shared_ptr<const Inside> inside) : inside_(std::move(inside)) {}

Plan Plan::Read(const std::string& path) {
  return Guarded([&] {
    return Plan(
        std::make_shared<Inside>(Inside{ReadPlan(path), YamlText(path), path}));
  });
}

Plan Plan::FromYaml(const std::string& text, const std::string& name) {
  return Guarded([&] {
    return Plan(std::make_shared<Inside>(
        Inside{ReadPlan(YamlMap::FromText(text, name)), text, name}));
  });
}

std::string Plan::ToYaml() const { return inside_->text; }
std::string Plan::path() const { return inside_->path; }

struct Calibration::Inside {
  Inside(Finger start, Plan given)
      : plan(std::move(given)), finger(std::move(start)) {}

  Plan plan;
  std::string explored_yaml;  // with explore
  CalibrationInputs inputs;
  std::unique_ptr<CalibrationProblem> problem;
  CalibrationResult result;
  Finger finger;
};

namespace {

CalibrationLogs LogsOf(const std::vector<std::string>& logs,
                       const finray::Finger& finger, const finray::Plan& plan,
                       CalibrationInputs* /*inputs*/) {
  return ReadCalibrationLogs(logs, finger, plan);
}

// Tables in memory have names of their own.
CalibrationLogs LogsOf(const std::vector<Table>& logs,
                       const finray::Finger& finger, const finray::Plan& plan,
                       CalibrationInputs* inputs) {
  std::vector<FrameTable> tables;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    Table named(logs[i].rows(), "log " + std::to_string(i + 1));
    for (const std::string& name : logs[i].columns()) {
      if (logs[i].IsText(name)) {
        named.SetText(name, logs[i].TextAt(name));
      } else {
        named.Borrow(name, logs[i].At(name));
      }
    }
    tables.push_back(ToFrameTable(named));
    inputs->texts[named.name()] = tables.back().ToCsv();
  }
  return ReadCalibrationLogs(tables, finger, plan);
}

// Ends a calibration from inside. It is no error, so no step that may fail
// catches it.
struct Stopped {};

std::unique_ptr<CalibrationProblem> ProblemOf(
    const finray::Finger& finger, const finray::Plan& plan,
    CalibrationLogs logs, const CalibrationOptions& options) {
  auto problem = std::make_unique<CalibrationProblem>(
      finger, plan, std::move(logs), ToInternal(options.discretization),
      ThreadsFor("threads", options.threads));
  problem->set_tolerance_std(options.tolerance_std);
  RefuseImplausible(problem.get());
  problem->TellProgress([options](const std::string& step) {
    if (options.stop && options.stop()) throw Stopped();
    if (options.progress) options.progress(step);
  });
  return problem;
}

}  // namespace

template <class Logs>
Calibration Calibration::Solve(const Finger& finger, const Plan& plan,
                               const Logs& logs,
                               const CalibrationOptions& options) {
  return Guarded([&] {
    if (logs.empty()) throw InputError("logs: expected at least one");
    if (!(options.tolerance_std > 0)) {
      throw InputError("tolerance_std: expected a number above 0");
    }
    auto inside = std::make_unique<Inside>(finger, plan);
    CalibrationInputs& inputs = inside->inputs;
    inputs.finger_path = finger.path();
    inputs.plan_path = plan.path();
    inputs.scheme = options.discretization.scheme;
    inputs.resolution = options.discretization.resolution;
    inputs.command = "finray::Calibration::Run";
    inputs.texts[finger.path()] = finger.inside().text;
    const finray::Finger& start = finger.inside().finger;
    const auto problem_of = [&](const finray::Plan& with) {
      return ProblemOf(start, with, LogsOf(logs, start, with, &inputs),
                       options);
    };
    const finray::Plan& given = plan.inside().plan;
    try {
      if (options.explore) {
        ExploredCalibration done =
            CalibrateExplored(given, plan.path(), plan.ToYaml(), problem_of,
                              options.leave_one_log_out);
        inside->problem = std::move(done.problem);
        inside->result = std::move(done.result);
        if (!done.as_given) {
          inside->plan = Plan::FromYaml(done.plan_yaml, plan.path());
        }
        inside->explored_yaml = std::move(done.plan_yaml);
      } else {
        inside->problem = problem_of(given);
        inside->result =
            Calibrate(inside->problem.get(), options.leave_one_log_out);
      }
    } catch (const Stopped&) {
      throw Interrupted();
    }
    inputs.texts[plan.path()] = inside->plan.ToYaml();
    inside->problem->TellProgress({});
    inside->finger = Finger(std::make_shared<Finger::Inside>(Finger::Inside{
        inside->result.finger, FingerToYaml(inside->result.finger),
        "calibrated " + finger.name()}));
    return Calibration(std::move(inside));
  });
}

Calibration Calibration::Run(const Finger& finger, const Plan& plan,
                             const std::vector<std::string>& logs,
                             const CalibrationOptions& options) {
  return Solve(finger, plan, logs, options);
}
Calibration Calibration::Run(const Finger& finger, const Plan& plan,
                             const std::vector<Table>& logs,
                             const CalibrationOptions& options) {
  return Solve(finger, plan, logs, options);
}

Calibration::Calibration(std::unique_ptr<Inside> inside)
    : inside_(std::move(inside)) {}
Calibration::~Calibration() = default;
Calibration::Calibration(Calibration&&) noexcept = default;
Calibration& Calibration::operator=(Calibration&&) noexcept = default;

const Finger& Calibration::finger() const { return inside_->finger; }
const Plan& Calibration::plan() const { return inside_->plan; }
std::string Calibration::verdict() const { return inside_->result.Verdict(); }
std::vector<std::string> Calibration::doubts() const {
  return inside_->result.doubts;
}
std::vector<Warning> Calibration::warnings() const {
  return ToPublic(inside_->result.warnings);
}
bool Calibration::converged() const {
  return inside_->result.solution.solve.converged;
}
int Calibration::iterations() const {
  return inside_->result.solution.solve.iterations;
}

std::vector<CalibratedParameter> Calibration::parameters() const {
  std::vector<CalibratedParameter> all;
  const Identifiability& found = inside_->result.identifiability;
  std::size_t free = 0;
  for (const CalibrationParameter& p : inside_->problem->parameters().all()) {
    const double at = *p.variable;
    all.push_back(
        {p.name, p.unit, p.Value(p.initial), p.Value(at),
         p.free ? p.ValueStd(at, found.std[free]) : 0.0,
         p.prior_std ? p.ValueStd(p.initial, *p.prior_std) : std::nan(""),
         ParameterStatusName(p.free ? found.status[free]
                                    : ParameterStatus::kFixed)});
    free += p.free;
  }
  return all;
}

std::vector<std::string> Calibration::free_names() const {
  std::vector<std::string> names;
  for (const CalibratedParameter& p : parameters()) {
    if (p.status != "fixed") names.push_back(p.name);
  }
  return names;
}

std::vector<double> Calibration::covariance() const {
  std::vector<double> std;
  for (const CalibratedParameter& p : parameters()) {
    if (p.status != "fixed") std.push_back(p.std);
  }
  const Eigen::MatrixXd& correlation =
      inside_->result.identifiability.correlation;
  std::vector<double> covariance;
  covariance.reserve(std.size() * std.size());
  for (std::size_t i = 0; i < std.size(); ++i) {
    for (std::size_t j = 0; j < std.size(); ++j) {
      const double share = i == j ? 1
                                  : correlation(static_cast<Eigen::Index>(i),
                                                static_cast<Eigen::Index>(j));
      // Nothing is known of a parameter with an infinite std.
      covariance.push_back(share == 0 ? 0 : share * std[i] * std[j]);
    }
  }
  return covariance;
}

std::vector<ResidualNoise> Calibration::noise() const {
  std::vector<ResidualNoise> all;
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise =
        inside_->result.identifiability.noise[i];
    if (noise.residuals == 0) continue;
    all.push_back({ResidualFamilyName(static_cast<ResidualFamily>(i)),
                   noise.residuals, noise.dof, noise.chi2});
  }
  return all;
}

std::vector<WeakDirection> Calibration::weak_directions() const {
  std::vector<WeakDirection> all;
  for (const auto& weak : inside_->result.identifiability.weak) {
    all.push_back({weak.words, weak.how_far, weak.remedy});
  }
  return all;
}

namespace {

double RmsOf(const ErrorStatistics& errors) {
  return errors.frames > 0 ? errors.rms() : std::nan("");
}

}  // namespace

double Calibration::force_rms_before_N() const {
  return RmsOf(inside_->result.forces.fitted.before.contact.force_N);
}
double Calibration::force_rms_after_N() const {
  return RmsOf(inside_->result.forces.fitted.after.contact.force_N);
}
double Calibration::force_rms_held_out_N() const {
  return RmsOf(inside_->result.forces.held_out.after.contact.force_N);
}
std::string Calibration::next() const {
  return NextWords(inside_->result.next);
}

Table Calibration::Frames() const {
  return Guarded([&] {
    return FromFrameTable(CalibrationFrames(*inside_->problem, inside_->result),
                          "calibration.frames.csv");
  });
}

std::string Calibration::ToYaml() const {
  return Guarded([&] {
    return CalibrationYaml(*inside_->problem, inside_->result, inside_->inputs);
  });
}

std::string Calibration::Write(const std::string& out_dir, bool report) const {
  return Guarded([&] {
    if (!inside_->explored_yaml.empty()) {
      MakeFolder(out_dir);
      WriteFileAtomically(out_dir + "/plan.yaml", inside_->explored_yaml);
    }
    return WriteCalibration(*inside_->problem, inside_->result, inside_->inputs,
                            out_dir, report);
  });
}

}  // namespace finray::v1

// The C++ side of the Python package. python/finray/*.py is its face: names,
// defaults and documentation are there.

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "calls.h"
#include "columns.h"
#include "finray/finray.h"

namespace py = pybind11;

namespace finray_python {
namespace {

// The exceptions of finray/errors.py, with the texts of the executables.
void Translate(std::exception_ptr pointer) {
  const auto raise = [](const char* name, const char* text) {
    const py::object type = py::module_::import("finray.errors").attr(name);
    PyErr_SetString(type.ptr(), text);
  };
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const finray::InputError& error) {
    raise("InputError", error.what());
  } catch (const finray::SolveError& error) {
    raise("SolveError", error.what());
  } catch (const finray::GateError& error) {
    raise("GateError", error.what());
  }
}

template <class Description>
void BindDescription(py::module_* module, const char* name) {
  py::class_<Description>(*module, name)
      .def_static("read", &Description::Read)
      .def_static("from_yaml", &Description::FromYaml)
      .def("to_yaml", &Description::ToYaml)
      .def_property_readonly("path", &Description::path);
}

py::object OptionalNumber(double value) {
  return std::isnan(value) ? py::object(py::none()) : py::float_(value);
}

py::list WarningTuples(const std::vector<finray::Warning>& warnings) {
  py::list all;
  for (const finray::Warning& warning : warnings) {
    all.append(py::make_tuple(warning.code, warning.text, warning.remedy));
  }
  return all;
}

finray::EstimateOptions OptionsOf(const std::string& solver,
                                  const std::string& equilibrium, bool joint,
                                  int threads, const std::string& scheme,
                                  int resolution) {
  return {solver, equilibrium, joint, threads, {scheme, resolution}};
}

// (numbers, statuses as bytes, summary, warnings)
py::tuple Estimate(const finray::Estimator& estimator,
                   const finray::Table& log) {
  finray::Estimation found = CallWithoutGil(
      [&](const auto& stop) { return estimator.Estimate(log, stop); });
  const finray::EstimationSummary& of = found.summary;
  py::dict summary;
  summary["frames"] = of.frames;
  summary["ok"] = of.ok;
  summary["no_contact"] = of.no_contact;
  summary["unobservable"] = of.unobservable;
  summary["not_converged"] = of.not_converged;
  summary["bad_input"] = of.bad_input;
  summary["unexplained"] = of.unexplained;
  summary["force_compared"] = of.force_compared;
  summary["force_rms_error_N"] = OptionalNumber(of.force_rms_error_N);
  summary["force_max_error_N"] = OptionalNumber(of.force_max_error_N);
  const py::bytes statuses(reinterpret_cast<const char*>(found.statuses.data()),
                           found.statuses.size());
  return py::make_tuple(ToDict(found.numbers), statuses, summary,
                        WarningTuples(found.warnings));
}

py::tuple Simulate(const finray::Finger& finger, const finray::Scene& scene,
                   const finray::Table& frames, bool shapes,
                   const std::string& scheme, int resolution) {
  const finray::Simulator simulator(finger, scene, {scheme, resolution});
  const finray::Simulation found = CallWithoutGil(
      [&](const auto&) { return simulator.Simulate(frames, shapes); });
  return py::make_tuple(ToDict(found.frames), ToDict(found.shapes),
                        found.contact, found.free, found.not_converged,
                        found.first_failure);
}

py::dict MakeLog(const finray::Finger& finger, const finray::Table& simulated,
                 double force_std_N, double object_std_mm, double pin_std_mm,
                 std::uint64_t seed) {
  return ToDict(finray::Simulator(finger).MakeLog(
      simulated, {force_std_N, object_std_mm, pin_std_mm, seed}));
}

py::tuple ContactTuple(const finray::Contact& c) {
  return py::make_tuple(c.arc_mm, c.arc_std_mm, c.normal_N, c.normal_std_N,
                        c.x_mm, c.y_mm, c.angle_rad, c.arc_low_mm,
                        c.arc_high_mm, c.normal_low_N, c.normal_high_N);
}

py::tuple Next(finray::LiveEstimator* live, const std::vector<double>& gauges_V,
               double time_s, double object_x_mm, double object_y_mm,
               double object_angle_deg) {
  const finray::Frame& frame = live->Next(
      {gauges_V, time_s, object_x_mm, object_y_mm, object_angle_deg});
  py::list contacts;
  for (int c = 0; c < frame.contacts; ++c) {
    contacts.append(ContactTuple(frame.contact[c]));
  }
  return py::make_tuple(finray::StatusName(frame.status), contacts, frame.chi2,
                        frame.chi2_p_value, frame.tip_x_mm, frame.tip_y_mm,
                        frame.tip_angle_rad, frame.iterations,
                        frame.search_ended, frame.ribs_N);
}

template <class Logs>
finray::Calibration Calibrate(const finray::Finger& finger,
                              const finray::Plan& plan, const Logs& logs,
                              double tolerance_std, bool leave_one_log_out,
                              bool explore, int threads,
                              const std::string& scheme, int resolution) {
  return CallWithoutGil([&](const auto& stop) {
    finray::CalibrationOptions options;
    options.tolerance_std = tolerance_std;
    options.leave_one_log_out = leave_one_log_out;
    options.explore = explore;
    options.threads = threads;
    options.discretization = {scheme, resolution};
    options.stop = stop;
    return finray::Calibration::Run(finger, plan, logs, options);
  });
}

void BindCalibration(py::module_* module) {
  using finray::Calibration;
  py::class_<Calibration>(*module, "Calibration")
      .def_property_readonly("finger", &Calibration::finger)
      .def_property_readonly("plan", &Calibration::plan)
      .def_property_readonly("verdict", &Calibration::verdict)
      .def_property_readonly("doubts", &Calibration::doubts)
      .def_property_readonly("warnings",
                             [](const Calibration& self) {
                               return WarningTuples(self.warnings());
                             })
      .def_property_readonly("converged", &Calibration::converged)
      .def_property_readonly("iterations", &Calibration::iterations)
      .def_property_readonly("parameters",
                             [](const Calibration& self) {
                               py::list all;
                               for (const auto& p : self.parameters()) {
                                 all.append(py::make_tuple(
                                     p.name, p.unit, p.initial, p.value, p.std,
                                     OptionalNumber(p.prior_std), p.status));
                               }
                               return all;
                             })
      .def_property_readonly("free_names", &Calibration::free_names)
      .def_property_readonly("covariance", &Calibration::covariance)
      .def_property_readonly(
          "noise",
          [](const Calibration& self) {
            py::list all;
            for (const auto& n : self.noise()) {
              all.append(py::make_tuple(n.family, n.residuals, n.dof, n.chi2));
            }
            return all;
          })
      .def_property_readonly(
          "weak_directions",
          [](const Calibration& self) {
            py::list all;
            for (const auto& weak : self.weak_directions()) {
              all.append(py::make_tuple(weak.words, weak.how_far, weak.remedy));
            }
            return all;
          })
      .def_property_readonly("force_rms_N",
                             [](const Calibration& self) {
                               return py::make_tuple(
                                   OptionalNumber(self.force_rms_before_N()),
                                   OptionalNumber(self.force_rms_after_N()),
                                   OptionalNumber(self.force_rms_held_out_N()));
                             })
      .def_property_readonly("next", &Calibration::next)
      .def("frames",
           [](const Calibration& self) { return ToDict(self.Frames()); })
      .def("to_yaml", &Calibration::ToYaml)
      .def("write", &Calibration::Write,
           py::call_guard<py::gil_scoped_release>());
  module->def("calibrate", &Calibrate<std::vector<std::string>>);
  module->def("calibrate", &Calibrate<std::vector<finray::Table>>);
}

}  // namespace
}  // namespace finray_python

PYBIND11_MODULE(_finray, module) {
  using namespace finray_python;
  py::register_exception_translator(&Translate);
  module.def("version", &finray::Version);
  module.def("versions", &finray::Versions);
  module.def("resource", &finray::ResourcePath);

  BindDescription<finray::Scene>(&module, "Scene");
  BindDescription<finray::Plan>(&module, "Plan");
  BindDescription<finray::Finger>(&module, "Finger");
  auto finger = py::class_<finray::Finger>(module.attr("Finger"));
  finger.def_property_readonly("name", &finray::Finger::name)
      .def_property_readonly("front_length_mm",
                             &finray::Finger::front_length_mm)
      .def_property_readonly("back_angle_rad", &finray::Finger::back_angle_rad)
      .def_property_readonly("front_stiffness_N_mm2",
                             &finray::Finger::front_stiffness_N_mm2)
      .def_property_readonly("back_stiffness_N_mm2",
                             &finray::Finger::back_stiffness_N_mm2)
      .def_property_readonly("ribs", &finray::Finger::ribs)
      .def_property_readonly("gauges", &finray::Finger::gauges)
      .def_property_readonly("calibrated", &finray::Finger::calibrated)
      .def("gauge_angle_rad", &finray::Finger::GaugeAngle_rad)
      .def("gauge_volts", &finray::Finger::GaugeVolts)
      .def("write", &finray::Finger::Write);

  py::class_<finray::Table>(module, "Table")
      .def(py::init(&FromDict))
      .def_static("read",
                  py::overload_cast<const std::string&, const finray::Scene&>(
                      &finray::Table::Read))
      .def_property_readonly("name", &finray::Table::name)
      .def_property_readonly("rows", &finray::Table::rows)
      .def("to_dict", &ToDict)
      .def("write", &finray::Table::Write);

  module.def("simulate", &Simulate);
  module.def("make_log", &MakeLog);

  py::class_<finray::Estimator>(module, "Estimator")
      .def(py::init([](const finray::Finger& finger, const finray::Scene& scene,
                       const std::string& solver,
                       const std::string& equilibrium, bool joint, int threads,
                       const std::string& scheme, int resolution) {
        return finray::Estimator(
            finger, scene,
            OptionsOf(solver, equilibrium, joint, threads, scheme, resolution));
      }))
      .def("estimate", &Estimate);

  py::class_<finray::LiveEstimator>(module, "LiveEstimator")
      .def(
          py::init([](const finray::Finger& finger, const finray::Scene& scene,
                      const std::string& solver, const std::string& equilibrium,
                      const std::string& scheme, int resolution) {
            return finray::LiveEstimator(
                finger, scene,
                OptionsOf(solver, equilibrium, false, 1, scheme, resolution));
          }))
      .def("next", &Next)
      .def("restart", &finray::LiveEstimator::Restart);

  BindCalibration(&module);

  module.def("reconstruct", [](const finray::Finger& finger,
                               const finray::Table& touches,
                               const finray::Scene& scene, double stage_std_mm,
                               const std::string& scheme, int resolution) {
    const finray::Reconstruction found = CallWithoutGil([&](const auto&) {
      return finray::Reconstruct(finger, touches, scene, stage_std_mm,
                                 {scheme, resolution});
    });
    return py::make_tuple(
        ToDict(found.outline), ToDict(found.touches), found.centroid_x_mm,
        found.centroid_y_mm, found.perimeter_mm, found.noise_scale,
        found.supported_share, found.usable_touches, found.rows);
  });
}

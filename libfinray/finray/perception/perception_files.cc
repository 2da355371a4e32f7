#include "finray/perception/perception_files.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "finray/finger/geometry.h"
#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/message_text.h"
#include "finray/io/number_text.h"
#include "finray/io/sha256.h"
#include "finray/io/versions.h"
#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

// Appends a row to CSV text. NaN becomes an empty cell.
template <class... Cells>
void AppendRow(std::string* csv, const Cells&... cells) {
  const auto append = [csv](const auto& cell) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(cell)>>) {
      const auto number = static_cast<double>(cell);
      if (std::isfinite(number)) *csv += NumberText(number);
    } else {
      AppendCsvText(cell, csv);
    }
    *csv += ',';
  };
  (append(cells), ...);
  csv->back() = '\n';
}

// Adds the inputs to the mapping of a file and closes it.
std::string WithInputs(const std::vector<std::string>& paths,
                       YamlEmitter* yaml) {
  *yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginSeq;
  for (const std::string& path : paths) {
    YamlLine(yaml, "path", path, "sha256", Sha256OfFile(path));
  }
  *yaml << YAML::EndSeq;
  YamlPair(yaml, "version", FINRAY_VERSION);
  *yaml << YAML::EndMap;
  return std::string(yaml->c_str()) + "\n";
}

void EmitTrial(const ComplianceTrial& trial, YamlEmitter* yaml) {
  const StiffnessFit& fit = trial.fit;
  *yaml << YAML::BeginMap;
  YamlPairs(yaml, "object", trial.object, "trial", trial.name, "rows",
            trial.rows, "points", fit.points, "standing", fit.standing,
            "left_out", fit.left_out.size(), "direction_deg",
            trial.direction.angle_rad / kDegree, "direction_std_deg",
            trial.direction.std_rad / kDegree, "stiffness_N_per_mm",
            trial.stiffness.N_per_mm, "std_N_per_mm", trial.stiffness.std,
            "friction_N", fit.friction_N(), "friction_std_N",
            fit.friction_std_N());
  *yaml << YAML::Key << "law" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (int m = 0; m <= fit.law.degree; ++m) *yaml << fit.coefficients[m];
  *yaml << YAML::EndSeq;
  YamlPairs(yaml, "chi2", fit.chi2, "dof", fit.dof);
  *yaml << YAML::EndMap;
}

void EmitError(const char* key, const RadialError& error, YamlEmitter* yaml) {
  *yaml << YAML::Key << key << YAML::Value;
  YamlLine(yaml, "mean", error.Mean(), "rms", error.Rms(), "quantile_95",
           error.Quantile(0.95), "largest", error.Largest());
}

void EmitDescriptors(const char* key, const FourierDescriptors& descriptors,
                     YamlEmitter* yaml) {
  const auto& c = descriptors.coefficients();
  const int most = static_cast<int>(c.size()) / 2;
  *yaml << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (int k = -most; k <= most; ++k) {
    const auto& value = c[static_cast<std::size_t>(k + most)];
    YamlLine(yaml, "k", k, "real_mm", value.real(), "imaginary_mm",
             value.imag());
  }
  *yaml << YAML::EndSeq;
}

std::vector<double> Coordinates(const Eigen::Vector2d& point) {
  return {point.x(), point.y()};
}

}  // namespace

std::string PointCsv(const Compliance& found) {
  std::string csv =
      "object,trial,row,displacement_mm,displacement_std_mm,force_N,"
      "force_std_N,direction,slides,left_out\n";
  for (const ComplianceTrial& trial : found.trials) {
    const std::vector<std::size_t>& left_out = trial.fit.left_out;
    for (const ForcePoint& point : trial.points) {
      AppendRow(&csv, trial.object, trial.name, point.row + 1,
                point.displacement_mm, std::sqrt(point.covariance(0, 0)),
                point.force_N, std::sqrt(point.covariance(1, 1)),
                point.direction, point.slides,
                std::count(left_out.begin(), left_out.end(), point.row) > 0);
    }
  }
  return csv;
}

std::string StiffnessCsv(const Compliance& found) {
  std::string csv =
      "object,trials,stiffness_N_per_mm,std_N_per_mm,"
      "calibration_std_N_per_mm,probability_stiffer_than_next\n";
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectStiffness& object = found.objects[i];
    AppendRow(&csv, object.name, object.trials.size(), object.mean.N_per_mm,
              object.mean.std, object.calibration_std,
              i < found.pair_confidence.size() ? found.pair_confidence[i]
                                               : std::nan(""));
  }
  return csv;
}

std::string LawCsv(const Compliance& found) {
  constexpr int kSteps = 40;
  std::string csv = "object,trial,displacement_mm,force_N,friction_N\n";
  for (const ComplianceTrial& trial : found.trials) {
    const StiffnessFit& fit = trial.fit;
    for (int k = 0; k <= kSteps; ++k) {
      const double u =
          fit.least_mm + (fit.largest_mm - fit.least_mm) * k / kSteps;
      AppendRow(&csv, trial.object, trial.name, u, fit.ForceAt(u),
                fit.friction_N());
    }
  }
  return csv;
}

std::string ComplianceYaml(const Compliance& found,
                           const std::vector<std::string>& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap << YAML::Key << "compared_between_N" << YAML::Value
       << YAML::Flow << std::vector<double>{found.from_N, found.to_N};
  YamlPair(&yaml, "order_confidence", found.order_confidence);
  yaml << YAML::Key << "objects" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectStiffness& object = found.objects[i];
    yaml << YAML::BeginMap;
    YamlPairs(&yaml, "object", object.name, "trials", object.trials.size(),
              "stiffness_N_per_mm", object.mean.N_per_mm, "std_N_per_mm",
              object.mean.std, "calibration_std_N_per_mm",
              object.calibration_std);
    if (i < found.pair_confidence.size()) {
      YamlPair(&yaml, "probability_stiffer_than_next",
               found.pair_confidence[i]);
    }
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq << YAML::Key << "trials" << YAML::Value
       << YAML::BeginSeq;
  for (const ComplianceTrial& trial : found.trials) EmitTrial(trial, &yaml);
  yaml << YAML::EndSeq;
  return WithInputs(inputs, &yaml);
}

std::string OutlineCsv(const Reconstruction& found,
                       const std::optional<RadialError>& error) {
  std::string csv = "angle_deg,x_mm,y_mm,radius_mm,std_mm,supported";
  csv += error ? ",true_radius_mm,radial_error_percent\n" : "\n";
  for (std::size_t i = 0; i < found.outline.size(); ++i) {
    const OutlinePoint& point = found.outline[i];
    AppendRow(&csv, point.angle_rad / kDegree, point.position_mm.x(),
              point.position_mm.y(), point.radius_mm, point.std_mm,
              point.supported);
    if (!error) continue;
    csv.back() = ',';
    AppendRow(&csv, error->true_radius_mm[i], error->percent[i]);
  }
  return csv;
}

std::string TouchCsv(const Reconstruction& found) {
  std::string csv =
      "row,point_x_mm,point_y_mm,normal_deg,normal_N,normal_std_mm,"
      "along_std_mm,distance_std\n";
  for (std::size_t i = 0; i < found.touches.usable.size(); ++i) {
    const Touch& touch = found.touches.usable[i];
    const Eigen::Vector2d n = touch.Normal();
    const auto std_mm = [&](const Eigen::Vector2d& direction) {
      return std::sqrt(
          direction.dot(touch.covariance.topLeftCorner<2, 2>() * direction));
    };
    AppendRow(&csv, touch.row + 1, touch.point_mm.x(), touch.point_mm.y(),
              touch.normal_angle_rad / kDegree, touch.normal_N, std_mm(n),
              std_mm({-n.y(), n.x()}), found.fit.distances[i]);
  }
  return csv;
}

std::string BeamCsv(const Reconstruction& found, double reach_mm) {
  std::string csv = "row,x_mm,y_mm\n";
  for (const Touch& touch : found.touches.usable) {
    for (const Eigen::Vector2d& point : touch.BeamNear(reach_mm)) {
      AppendRow(&csv, touch.row + 1, point.x(), point.y());
    }
  }
  return csv;
}

std::string ReconstructionYaml(const Reconstruction& found,
                               const FourierDescriptors& descriptors,
                               const FourierDescriptors& envelope,
                               const std::optional<RadialError>& error,
                               const std::optional<RadialError>& envelope_error,
                               const std::vector<std::string>& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap << YAML::Key << "touches" << YAML::Value
       << YAML::BeginMap;
  YamlPair(&yaml, "rows", found.touches.all_rows());
  for (const auto& [status, count] : found.touches.rows) {
    YamlPair(&yaml, StatusName(status), count);
  }
  const std::vector<double>& distances = found.fit.distances;
  YamlPairs(&yaml, "contacts", distances.size(), "along_edges",
            std::count_if(distances.begin(), distances.end(),
                          [](double distance) { return std::isnan(distance); }),
            "astray",
            std::count_if(distances.begin(), distances.end(),
                          [](double distance) { return distance > 4; }));
  yaml << YAML::EndMap << YAML::Key << "fit" << YAML::Value;
  YamlLine(&yaml, "smoothing", found.fit.smoothing, "noise_scale",
           found.fit.noise_scale, "beam_bounds", found.fit.beam_bounds);
  yaml << YAML::Key << "centroid_mm" << YAML::Value << YAML::Flow
       << Coordinates(found.centroid_mm) << YAML::Key << "straight_edges"
       << YAML::Value << YAML::BeginSeq;
  for (const StraightEdge& edge : found.fit.edges) {
    YamlLine(&yaml, "normal_deg",
             std::remainder(edge.middle_rad, 2 * M_PI) / kDegree, "length_mm",
             edge.length_mm);
  }
  yaml << YAML::EndSeq;
  YamlPair(&yaml, "supported_percent", 100 * found.supported_share);
  yaml << YAML::Key << "unsupported" << YAML::Value << YAML::BeginSeq;
  for (const TouchCoverage::Gap& gap : found.gaps) {
    YamlLine(&yaml, "from_mm", Coordinates(gap.from_mm), "to_mm",
             Coordinates(gap.to_mm), "length_mm", gap.length_mm);
  }
  yaml << YAML::EndSeq;
  EmitDescriptors("descriptors", descriptors, &yaml);
  EmitDescriptors("envelope_descriptors", envelope, &yaml);
  if (error) {
    EmitError("radial_error_percent", *error, &yaml);
    EmitError("envelope_radial_error_percent", *envelope_error, &yaml);
  }
  return WithInputs(inputs, &yaml);
}

Polygon ReadOutline(const std::string& path) {
  FrameTable table = FrameTable::Read(path);
  Polygon polygon(table.rows());
  const char* names[] = {"x_mm", "y_mm"};
  for (int k = 0; k < 2; ++k) {
    if (!table.Has(names[k])) table.Numbers(names[k]);  // names its columns
    const auto& cells = table.MutableText(names[k]);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto number = ParseNumber(cells[i]);
      if (!number || !std::isfinite(*number)) {
        throw InputError(path + ":" + std::to_string(table.line(i)) + ": " +
                         names[k] + ": expected a number, found " +
                         ShownText(cells[i]));
      }
      polygon[i][k] = *number;
    }
  }
  if (polygon.size() < 3) {
    throw InputError(path + ": an outline needs at least 3 points");
  }
  return polygon;
}

}  // namespace finray

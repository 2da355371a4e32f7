#include "finray/perception/reconstruction_files.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/io/shown_text.h"
#include "finray/io/yaml_emitter.h"
#include "finray/perception/inputs_yaml.h"

namespace finray {
namespace {

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

FrameTable OutlineTable(const Reconstruction& found, const Polygon* truth) {
  FrameTable table(found.outline.size());
  const RadialError error =
      truth == nullptr ? RadialError()
                       : CompareRadii(found.polygon(), *truth,
                                      static_cast<int>(found.outline.size()));
  for (std::size_t i = 0; i < found.outline.size(); ++i) {
    const OutlinePoint& point = found.outline[i];
    const auto set = [&](const char* name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    set("angle_deg", point.angle_rad / kDegree);
    set("x_mm", point.position_mm.x());
    set("y_mm", point.position_mm.y());
    set("radius_mm", point.radius_mm);
    set("std_mm", point.std_mm);
    set("supported", point.supported ? 1 : 0);
    if (truth == nullptr) continue;
    const auto radius = RadiusAt(*truth, CentroidOf(*truth), point.angle_rad);
    set("true_radius_mm", radius.value_or(std::nan("")));
    set("radial_error_percent", error.percent[i]);
  }
  return table;
}

FrameTable TouchTable(const Reconstruction& found) {
  const std::vector<Touch>& touches = found.touches.usable;
  FrameTable table(touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Touch& touch = touches[i];
    const auto set = [&](const char* name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    set("row", static_cast<double>(touch.row + 1));
    set("point_x_mm", touch.point_mm.x());
    set("point_y_mm", touch.point_mm.y());
    set("normal_deg", touch.normal_angle_rad / kDegree);
    set("normal_N", touch.normal_N);
    const Eigen::Vector2d n = touch.Normal();
    set("normal_std_mm",
        std::sqrt(n.dot(touch.covariance.topLeftCorner<2, 2>() * n)));
    set("distance_std", found.fit.distances[i]);
  }
  return table;
}

FrameTable BeamTable(const Reconstruction& found, double reach_mm) {
  std::vector<std::array<double, 3>> rows;
  for (const Touch& touch : found.touches.usable) {
    for (const Eigen::Vector2d& point : touch.BeamNear(reach_mm)) {
      rows.push_back(
          {static_cast<double>(touch.row + 1), point.x(), point.y()});
    }
  }
  FrameTable table(rows.size());
  const char* names[] = {"row", "x_mm", "y_mm"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double>& cells = table.MutableNumbers(names[k]);
    for (std::size_t i = 0; i < rows.size(); ++i) cells[i] = rows[i][k];
  }
  return table;
}

std::string ReconstructionYaml(const Reconstruction& found,
                               const FourierDescriptors& descriptors,
                               const FourierDescriptors& envelope,
                               const RadialError* error,
                               const RadialError* envelope_error,
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
  if (error != nullptr) {
    EmitError("radial_error_percent", *error, &yaml);
    EmitError("envelope_radial_error_percent", *envelope_error, &yaml);
  }
  EmitInputs(inputs, &yaml);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
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

#include "finray/io/frame_vocabulary.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>

#include "finray/io/message_text.h"

namespace finray {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool Matches(std::string_view name, std::string_view pattern) {
  const auto hash = pattern.find('#');
  if (hash == std::string_view::npos) return name == pattern;
  const std::string_view before = pattern.substr(0, hash);
  const std::string_view after = pattern.substr(hash + 1);
  if (name.size() <= before.size() + after.size() ||
      name.substr(0, before.size()) != before ||
      name.substr(name.size() - after.size()) != after) {
    return false;
  }
  const std::string_view index =
      name.substr(before.size(), name.size() - before.size() - after.size());
  return index.front() != '0' && index.size() <= 4 &&
         std::all_of(index.begin(), index.end(), IsDigit);
}

}  // namespace

const std::vector<std::string>& FrameColumnPatterns() {
  static const std::vector<std::string> patterns = [] {
    std::istringstream words(
        "time_s gauge_#_V gauge_#_rad contact_#_mm contact_#_std_mm "
        "contact_#_noise_mm normal_#_N normal_#_std_N normal_#_noise_N "
        "contact_#_low_mm contact_#_high_mm normal_#_low_N "
        "normal_#_high_N friction_# alternative_contact_#_mm "
        "alternative_normal_#_N contact_#_x_mm contact_#_y_mm "
        "contact_#_angle_rad object_x_mm object_y_mm object_angle_deg "
        "object_displacement_mm force_N force_x_N force_y_N rib_#_N "
        "rib_#_front_x_mm rib_#_front_y_mm rib_#_back_x_mm rib_#_back_y_mm "
        "cylinder_radius_mm tip_x_mm tip_y_mm tip_angle_rad chi2 chi2_p_value "
        "alternative_chi2 iterations search_ended temperature_C "
        "gauge_#_scatter_V force_scatter_N force_x_scatter_N "
        "force_y_scatter_N gauge_readings force_readings");
    return std::vector<std::string>(std::istream_iterator<std::string>(words),
                                    {});
  }();
  return patterns;
}

bool IsFrameColumn(std::string_view name) {
  return std::any_of(
      FrameColumnPatterns().begin(), FrameColumnPatterns().end(),
      [name](std::string_view pattern) { return Matches(name, pattern); });
}

double LargestIn(std::string_view name) {
  if (name == "time_s") return kLargestTime_s;
  static const std::vector<std::string> patterns = [] {
    std::istringstream words(
        "contact_#_mm normal_#_N friction_# contact_#_x_mm contact_#_y_mm "
        "contact_#_angle_rad object_x_mm object_y_mm object_angle_deg "
        "object_displacement_mm force_N force_x_N force_y_N rib_#_N "
        "rib_#_front_x_mm rib_#_front_y_mm rib_#_back_x_mm rib_#_back_y_mm "
        "tip_x_mm tip_y_mm tip_angle_rad temperature_C");
    return std::vector<std::string>(std::istream_iterator<std::string>(words),
                                    {});
  }();
  const bool bounded = std::any_of(
      patterns.begin(), patterns.end(),
      [name](const auto& pattern) { return Matches(name, pattern); });
  return bounded ? kLargestMeasured : std::numeric_limits<double>::infinity();
}

bool MayBeInfinite(std::string_view name) {
  return name == "cylinder_radius_mm" || Matches(name, "gauge_#_V") ||
         Matches(name, "gauge_#_rad");
}

std::string DidYouMeanFrameColumn(const std::string& name) {
  // The patterns get the index that the name has, if any.
  const auto digit = std::find_if(name.begin(), name.end(), IsDigit);
  std::string index(digit, std::find_if_not(digit, name.end(), IsDigit));
  if (index.empty() || index.front() == '0') index = "1";
  std::vector<std::string> columns = {"status"};
  for (const std::string& pattern : FrameColumnPatterns()) {
    std::string& column = columns.emplace_back(pattern);
    const auto hash = column.find('#');
    if (hash != std::string::npos) column.replace(hash, 1, index);
  }
  return DidYouMean(name, columns);
}

std::string NoColumn(const std::string& name,
                     const std::vector<std::string>& columns) {
  std::string hint = DidYouMean(name, columns);
  if (hint.empty()) hint = "; it has " + Joined(columns, " ");
  return "no column '" + name + "'" + ShownLine(hint);
}

}  // namespace finray

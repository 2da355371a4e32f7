#pragma once

#include <std_msgs/msg/float64_multi_array.hpp>

namespace diagnostic_msgs::msg {
struct KeyValue {
  std::string key, value;
};
struct DiagnosticStatus {
  static constexpr unsigned char OK = 0, WARN = 1, ERROR = 2, STALE = 3;
  unsigned char level = OK;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};
struct DiagnosticArray {
  std_msgs::msg::Header header;
  std::vector<DiagnosticStatus> status;
};
inline std::string Text(const DiagnosticArray& message) {
  const DiagnosticStatus& found = message.status.at(0);
  std::string text = std::to_string(found.level) + "|" + found.name + "|" +
                     found.message + "|" + found.hardware_id;
  for (const KeyValue& pair : found.values) {
    text += "|" + pair.key + "=" + pair.value;
  }
  return text;
}
}  // namespace diagnostic_msgs::msg

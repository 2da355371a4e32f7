#pragma once

#include <cstdio>
#include <std_msgs/msg/float64_multi_array.hpp>

namespace geometry_msgs::msg {
struct Vector3 {
  double x = 0, y = 0, z = 0;
};
struct Wrench {
  Vector3 force, torque;
};
struct WrenchStamped {
  std_msgs::msg::Header header;
  Wrench wrench;
};
inline std::string Text(const WrenchStamped& message) {
  char text[200];
  std::snprintf(text, sizeof text, "%s %.9g %.9g %.9g",
                message.header.frame_id.c_str(), message.wrench.force.x,
                message.wrench.force.y, message.wrench.torque.z);
  return text;
}
}  // namespace geometry_msgs::msg

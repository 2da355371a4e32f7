#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace std_msgs::msg {
struct Time {
  std::int64_t nanoseconds = 0;
};
struct Header {
  Time stamp;
  std::string frame_id;
};
struct Float64MultiArray {
  std::vector<double> data;
};
}  // namespace std_msgs::msg

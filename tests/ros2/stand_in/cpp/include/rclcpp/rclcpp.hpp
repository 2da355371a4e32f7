// A stand-in for rclcpp: spin() hands the lines of standard input to the
// subscription of `gauges`, and publishers print.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <std_msgs/msg/float64_multi_array.hpp>
#include <string>
#include <vector>

namespace rclcpp {

inline std::map<std::string, std::string>& Given() {
  static std::map<std::string, std::string> given;
  return given;
}

struct Time {
  std::int64_t nanoseconds = 0;
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds); }
  operator std_msgs::msg::Time() const { return {nanoseconds}; }
};

template <class Message>
struct Publisher {
  using SharedPtr = std::shared_ptr<Publisher>;
  std::string topic;
  void publish(const Message& message) {
    std::printf("%s %s\n", topic.c_str(), Text(message).c_str());
  }
};

template <class Message>
struct Subscription {
  using SharedPtr = std::shared_ptr<Subscription>;
};

class Node {
 public:
  explicit Node(const std::string& name) : name_(name) {}
  const char* get_name() const { return name_.c_str(); }
  Time now() { return {ticks_ += 10000000}; }
  template <class Value>
  Value declare_parameter(const std::string& name, const Value& value) {
    const auto given = Given().find(name);
    return given == Given().end() ? value : given->second;
  }
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(
      const std::string& topic, int) {
    return std::make_shared<Publisher<Message>>(Publisher<Message>{topic});
  }
  template <class Message, class Callback>
  typename Subscription<Message>::SharedPtr create_subscription(
      const std::string& topic, int, Callback callback) {
    if (topic == "gauges") gauges = callback;
    return std::make_shared<Subscription<Message>>();
  }

  std::function<void(const std_msgs::msg::Float64MultiArray&)> gauges;

 private:
  std::string name_;
  std::int64_t ticks_ = 0;
};

inline void init(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const char* is = std::strstr(argv[i], ":=");
    if (is != nullptr) {
      Given()[std::string(argv[i], static_cast<std::size_t>(is - argv[i]))] =
          is + 2;
    }
  }
}

inline void spin(const std::shared_ptr<Node>& node) {
  for (std::string line; std::getline(std::cin, line);) {
    std_msgs::msg::Float64MultiArray volts;
    std::istringstream words(line);
    for (double value; words >> value;) volts.data.push_back(value);
    node->gauges(volts);
  }
}

inline void shutdown() {}

}  // namespace rclcpp

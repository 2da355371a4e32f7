// Senses contacts of a Fin-Ray finger from its gauges, frame by frame: as
// python/finray_node.py, which says what it subscribes to and publishes.

#include <cmath>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <geometry_msgs/msg/wrench_stamped.hpp>
#include <limits>
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/float64_multi_array.hpp>

#include "finray/finray.h"

using diagnostic_msgs::msg::DiagnosticArray;
using diagnostic_msgs::msg::DiagnosticStatus;
using finray::FrameStatus;
using geometry_msgs::msg::WrenchStamped;
using std_msgs::msg::Float64MultiArray;

class FinrayNode : public rclcpp::Node {
 public:
  FinrayNode()
      : Node("finray"),
        frame_id_(Text("frame_id", "finray")),
        live_(finray::Finger::Read(Text("finger", "")),
              finray::Scene::FromYaml(Text("scene", "most_contacts: 1"))),
        wrench_(create_publisher<WrenchStamped>("wrench", 10)),
        diagnostics_(create_publisher<DiagnosticArray>("/diagnostics", 10)),
        gauges_(create_subscription<Float64MultiArray>(
            "gauges", 10, [this](const Float64MultiArray& in) { Sense(in); })) {
  }

 private:
  std::string Text(const char* parameter, const char* initially) {
    return declare_parameter<std::string>(parameter, initially);
  }

  void Sense(const Float64MultiArray& volts) {
    WrenchStamped out;
    out.header.stamp = now();
    out.header.frame_id = frame_id_;
    DiagnosticStatus found;
    found.name = std::string(get_name()) + ": contacts";
    found.hardware_id = frame_id_;
    finray::Frame frame;  // bad_input
    try {
      frame = live_.Next({volts.data, now().seconds()});
      found.message = finray::StatusName(frame.status);
    } catch (const finray::InputError& error) {  // not as many as gauges
      found.message = std::string("bad_input: ") + error.what();
    }
    const bool ok = frame.status == FrameStatus::kOk;
    const bool known = ok || frame.status == FrameStatus::kNoContact;
    const bool guessed = frame.status == FrameStatus::kUnobservable;
    found.level = known     ? DiagnosticStatus::OK
                  : guessed ? DiagnosticStatus::WARN
                            : DiagnosticStatus::ERROR;
    auto &force = out.wrench.force, &torque = out.wrench.torque;
    force.x = force.y = torque.z =
        known ? 0 : std::numeric_limits<double>::quiet_NaN();
    for (int c = 0; c < frame.contacts; ++c) {
      const finray::Contact& contact = frame.contact[c];
      // The normal of the front beam, into the finger. NaN stays NaN.
      const double fx = contact.normal_N * std::sin(contact.angle_rad);
      const double fy = -contact.normal_N * std::cos(contact.angle_rad);
      force.x += fx;
      force.y += fy;
      torque.z += 1e-3 * (contact.x_mm * fy - contact.y_mm * fx);
      const auto add = [&](const std::string& name, double value) {
        found.values.emplace_back();
        found.values.back().key = name + "_" + std::to_string(c + 1);
        found.values.back().value = std::to_string(value);
      };
      add("contact_mm", contact.arc_mm);
      add("contact_std_mm", contact.arc_std_mm);
      add("normal_N", contact.normal_N);
      add("normal_std_N", contact.normal_std_N);
    }
    wrench_->publish(out);
    DiagnosticArray array;
    array.header.stamp = out.header.stamp;
    array.status.push_back(found);
    diagnostics_->publish(array);
  }

  std::string frame_id_;
  finray::LiveEstimator live_;
  rclcpp::Publisher<WrenchStamped>::SharedPtr wrench_;
  rclcpp::Publisher<DiagnosticArray>::SharedPtr diagnostics_;
  rclcpp::Subscription<Float64MultiArray>::SharedPtr gauges_;
};

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<FinrayNode>());
  rclcpp::shutdown();
}

#!/usr/bin/env python3
"""Senses contacts of a Fin-Ray finger from its gauges, frame by frame.

in:  gauges       std_msgs/Float64MultiArray, volts of all gauges
out: wrench       geometry_msgs/WrenchStamped in the frame of the finger: N, and N m about the base of the front beam.
                  Zero where there is no contact; NaN where it is not known
     /diagnostics diagnostic_msgs/DiagnosticArray: the status of each frame, its contacts with their std
parameters: finger (path of a YAML), scene (text of a scene YAML), frame_id
"""

import math

import finray
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

# `unobservable` is a number that the gauges do not determine; the others are no number at all.
LEVELS = {"ok": DiagnosticStatus.OK, "no_contact": DiagnosticStatus.OK, "unobservable": DiagnosticStatus.WARN}


class FinrayNode(Node):
    def __init__(self):
        super().__init__("finray")
        finger = finray.Finger.read(self.declare_parameter("finger", "").value)
        scene = finray.Scene.from_yaml(self.declare_parameter("scene", "most_contacts: 1").value)
        self.frame_id = self.declare_parameter("frame_id", "finray").value
        self.live = finray.Live(finger, scene)
        self.wrench = self.create_publisher(WrenchStamped, "wrench", 10)
        self.diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.subscription = self.create_subscription(Float64MultiArray, "gauges", self.sense, 10)

    def sense(self, message):
        stamp = self.get_clock().now()
        try:
            frame = self.live.next(message.data, time_s=stamp.nanoseconds * 1e-9)
            status, contacts = frame.status, frame.contacts
        except finray.InputError as error:  # not as many readings as gauges
            status, contacts = f"bad_input: {error}", []
        out = WrenchStamped()
        out.header.stamp, out.header.frame_id = stamp.to_msg(), self.frame_id
        known = status in ("ok", "no_contact")
        force = [0.0 if known else math.nan] * 3  # fx, fy, torque
        for contact in contacts:
            # The normal of the front beam, into the finger. NaN stays NaN.
            fx, fy = contact.normal_N * math.sin(contact.angle_rad), -contact.normal_N * math.cos(contact.angle_rad)
            torque = 1e-3 * (contact.x_mm * fy - contact.y_mm * fx)
            force = [a + b for a, b in zip(force, (fx, fy, torque))]
        out.wrench.force.x, out.wrench.force.y, out.wrench.torque.z = force
        self.wrench.publish(out)
        self.diagnostics.publish(self.diagnosis(out.header.stamp, status, contacts))

    def diagnosis(self, stamp, status, contacts):
        values = {}
        for number, contact in enumerate(contacts, 1):
            values[f"contact_mm_{number}"] = contact.arc_mm
            values[f"contact_std_mm_{number}"] = contact.arc_std_mm
            values[f"normal_N_{number}"] = contact.normal_N
            values[f"normal_std_N_{number}"] = contact.normal_std_N
        found = DiagnosticStatus(
            level=LEVELS.get(status, DiagnosticStatus.ERROR), name=f"{self.get_name()}: contacts", message=status,
            hardware_id=self.frame_id, values=[KeyValue(key=k, value=f"{v:.6g}") for k, v in values.items()])
        array = DiagnosticArray(status=[found])
        array.header.stamp = stamp
        return array


def main():
    rclpy.init()
    node = FinrayNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

from std_msgs.msg import Header


class Vector3:
    """Takes floats only, as the real one does."""

    def __init__(self):
        self.x = self.y = self.z = 0.0

    def __setattr__(self, name, value):
        assert name in "xyz" and isinstance(value, float), (name, value)
        super().__setattr__(name, value)


class Wrench:
    def __init__(self):
        self.force, self.torque = Vector3(), Vector3()


class WrenchStamped:
    def __init__(self):
        self.header, self.wrench = Header(), Wrench()

    def __str__(self):
        force, torque = self.wrench.force, self.wrench.torque
        return f"{self.header.frame_id} {force.x:.9g} {force.y:.9g} {torque.z:.9g}"

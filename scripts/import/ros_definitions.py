"""Definitions of common messages of ROS 2, for bags that do not bring them along."""

_HEADER = "std_msgs/Header header\n"
_STAMP = "int32 sec\nuint32 nanosec"
_TEXTS = {
    "time": _STAMP, "duration": _STAMP,
    "builtin_interfaces/Time": _STAMP,
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id",
    "std_msgs/Float64": "float64 data",
    "std_msgs/Float32": "float32 data",
    "std_msgs/Int32": "int32 data",
    "std_msgs/UInt16": "uint16 data",
    "std_msgs/MultiArrayDimension": "string label\nuint32 size\nuint32 stride",
    "std_msgs/MultiArrayLayout": "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset",
    "std_msgs/Float64MultiArray": "std_msgs/MultiArrayLayout layout\nfloat64[] data",
    "std_msgs/Float32MultiArray": "std_msgs/MultiArrayLayout layout\nfloat32[] data",
    "std_msgs/Int32MultiArray": "std_msgs/MultiArrayLayout layout\nint32[] data",
    "std_msgs/UInt16MultiArray": "std_msgs/MultiArrayLayout layout\nuint16[] data",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w",
    "geometry_msgs/Wrench": "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque",
    "geometry_msgs/WrenchStamped": _HEADER + "geometry_msgs/Wrench wrench",
    "geometry_msgs/PointStamped": _HEADER + "geometry_msgs/Point point",
    "geometry_msgs/Vector3Stamped": _HEADER + "geometry_msgs/Vector3 vector",
    "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseStamped": _HEADER + "geometry_msgs/Pose pose",
    "sensor_msgs/JointState":
        _HEADER + "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort",
    "sensor_msgs/Temperature": _HEADER + "float64 temperature\nfloat64 variance",
}


def text_of(name):
    """The text of a definition, or None."""
    return _TEXTS.get(name)

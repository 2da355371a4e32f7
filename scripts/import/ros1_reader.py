"""ROS 1 bags through python3-rosbag, which has the definitions of the messages from the bag."""

import genpy
import rosbag

import message_tables
from errors import BadInput


def _plain(value):
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"sec": value.secs, "nsec": value.nsecs}
    if isinstance(value, genpy.Message):
        return {name: _plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def read(path):
    topics = {}
    try:
        with rosbag.Bag(path) as bag:
            for topic, message, stamp in bag.read_messages():
                topics.setdefault(topic, []).append((stamp.to_nsec(), _plain(message)))
    except rosbag.ROSBagUnindexedException as error:
        raise BadInput(f"{path}: broken or cut: the bag has no index; `rosbag reindex` may mend "
                       "it") from error
    return message_tables.tables(path, topics, [])

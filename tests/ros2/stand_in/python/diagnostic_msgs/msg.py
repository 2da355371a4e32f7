from std_msgs.msg import Header


class KeyValue:
    def __init__(self, *, key, value):
        assert isinstance(key, str) and isinstance(value, str)
        self.key, self.value = key, value


class DiagnosticStatus:
    OK, WARN, ERROR, STALE = b"\0", b"\1", b"\2", b"\3"

    def __init__(self, *, level, name, message, hardware_id, values):
        assert isinstance(level, bytes) and len(level) == 1
        self.level, self.name, self.message, self.hardware_id, self.values = level, name, message, hardware_id, values


class DiagnosticArray:
    def __init__(self, *, status):
        self.header, self.status = Header(), status

    def __str__(self):
        assert self.header.stamp is not None
        (found,) = self.status
        return "|".join([str(found.level[0]), found.name, found.message, found.hardware_id,
                         *(f"{pair.key}={pair.value}" for pair in found.values)])

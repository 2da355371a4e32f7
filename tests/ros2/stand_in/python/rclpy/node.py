import sys


class Time:
    def __init__(self, nanoseconds):
        self.nanoseconds = nanoseconds

    def to_msg(self):
        return self.nanoseconds


class Clock:
    def __init__(self):
        self.ticks = 0

    def now(self):
        self.ticks += 10_000_000
        return Time(self.ticks)


class Publisher:
    def __init__(self, message, topic):
        self.message, self.topic = message, topic

    def publish(self, message):
        assert isinstance(message, self.message), message
        print(self.topic, message, flush=True)


class Parameter:
    def __init__(self, value):
        self.value = value


class Node:
    def __init__(self, name):
        self.name, self.subscriptions, self.clock = name, {}, Clock()
        self.given = dict(word.split(":=", 1) for word in sys.argv if ":=" in word)

    def get_name(self):
        return self.name

    def get_clock(self):
        return self.clock

    def declare_parameter(self, name, value):
        return Parameter(self.given.get(name, value))

    def create_publisher(self, message, topic, depth):
        assert depth > 0
        return Publisher(message, topic)

    def create_subscription(self, message, topic, callback, depth):
        assert depth > 0
        self.subscriptions[topic] = callback, message
        return object()

    def destroy_node(self):
        pass

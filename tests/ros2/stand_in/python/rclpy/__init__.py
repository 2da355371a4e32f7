"""A stand-in for rclpy: spin() hands the lines of standard input to the subscription of `gauges` and publishers print."""
import array
import sys


def init():
    pass


def spin(node):
    callback, message = node.subscriptions["gauges"]
    for line in sys.stdin:
        volts = message()
        volts.data = array.array("d", map(float, line.split()))
        callback(volts)


def try_shutdown():
    pass

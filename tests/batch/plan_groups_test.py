#!/usr/bin/python3
"""Groups of logs, and numbers as finray_estimate writes them."""

import unittest

import yaml

import batch_fixture  # noqa: F401, finds scripts/batch
from merge_summaries import number_text, yaml_number
from plan_groups import Log, assign

LIMITS = {"logs_per_task": 3, "log_MB_per_task": 1}


def logs_of(*paths, size=1000):
    return [Log(path, size, 0) for path in paths]


def as_old(groups):
    return [(group.number, group.root, [log.path for log in group.logs])
            for group in groups]


def paths_of(groups):
    return [[log.path for log in group.logs] for group in groups]


class AssignTest(unittest.TestCase):
    def test_sorted_and_filled_up(self):
        groups = assign(logs_of("/r/d", "/r/b", "/r/s/c", "/r/a"), [], LIMITS)
        self.assertEqual(paths_of(groups), [["/r/a", "/r/b", "/r/d"], ["/r/s/c"]])
        self.assertEqual([group.root for group in groups], ["/r", "/r/s"])
        self.assertEqual(groups[1].name, "000/001")

    def test_a_log_stays_where_it_is(self):
        paths = ["/r/b", "/r/d", "/r/f", "/r/h"]
        old = as_old(assign(logs_of(*paths), [], LIMITS))
        more = ["/r/a", "/r/c", "/r/g"]
        groups = assign(logs_of(*paths, *more), old, LIMITS)
        self.assertEqual(paths_of(groups), [["/r/b", "/r/d", "/r/f"],
                                            ["/r/h", "/r/a", "/r/c"], ["/r/g"]])
        # Others go; the number of an empty group stays taken.
        groups = assign(logs_of("/r/g", "/r/d", "/r/z"), as_old(groups), LIMITS)
        self.assertEqual(paths_of(groups), [["/r/d"], [], ["/r/g", "/r/z"]])

    def test_outside_of_the_last_group_s_root_a_new_one_begins(self):
        old = as_old(assign(logs_of("/r/s/a"), [], LIMITS))
        groups = assign(logs_of("/r/s/a", "/r/sa", "/r/s/b"), old, LIMITS)
        self.assertEqual(paths_of(groups), [["/r/s/a", "/r/s/b"], ["/r/sa"]])

    def test_one_result_a_log(self):
        groups = assign(logs_of("/r/a.csv", "/r/a.csv.gz", "/s/a.csv"), [], LIMITS)
        self.assertEqual(paths_of(groups), [["/r/a.csv"], ["/r/a.csv.gz", "/s/a.csv"]])
        self.assertEqual(groups[1].root, "/")

    def test_size(self):
        groups = assign(logs_of("/a", "/b", "/c", size=500_000)
                        + logs_of("/d", size=3_000_000), [], LIMITS)
        self.assertEqual(paths_of(groups), [["/a", "/b"], ["/c"], ["/d"]])

    def test_number_of_a_thousand(self):
        groups = assign(logs_of("/a"), [(12344, "/r", [])], LIMITS)
        self.assertEqual(groups[1].name, "012/345")


class NumberTextTest(unittest.TestCase):
    def test_as_to_chars(self):
        for value, text in ((0.0, "0"), (1.0, "1"), (0.25, "0.25"), (0.001, "0.001"),
                            (0.0001, "1e-04"), (0.00012, "0.00012"), (1e5, "1e+05"),
                            (123000.0, "123000"), (12345.678, "12345.678"),
                            (1e22, "1e+22"), (1.5e-7, "1.5e-07"),
                            (0.04609790393728325, "0.04609790393728325"),
                            (123456789012345680.0, "123456789012345680"),
                            (1e-300, "1e-300")):
            self.assertEqual(number_text(value), text)

    def test_as_yaml(self):
        for text, expected in (("0", "0"), ("1e-04", "1.0e-04"), ("1.5e+22", "1.5e+22"),
                               ("1e+05", "1.0e+05"), ("0.25", "0.25"), ("123000", "123000")):
            self.assertEqual(yaml_number(text), expected)
            self.assertEqual(yaml.safe_load(expected), float(text))


if __name__ == "__main__":
    unittest.main()

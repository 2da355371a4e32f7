#!/usr/bin/python3
"""Arrays of any layout: each column is read as the doubles that numpy.asarray(values, float64) holds, or refused by name."""
import decimal
import unittest
import warnings

from built_package import finray, np

try:
    import pandas
except ImportError:
    pandas = None

ROWS = 100
GAUGES = [f"gauge_{j}_V" for j in range(1, 5)]
VALUES = np.random.default_rng(1).normal(0, 0.01, (ROWS, 4))


def table(log):
    """What the library holds of a log."""
    return finray.tables.columns_of(finray.tables.table_of(log).to_dict())


def structured(first, numbers, **options):
    """Records as a logger writes them: a counter, then the gauges."""
    records = np.zeros(ROWS, np.dtype([("tick", first), *((name, numbers) for name in GAUGES)], **options))
    records["tick"] = np.arange(ROWS) % 100
    for j, name in enumerate(GAUGES):
        records[name] = VALUES[:, j]
    return records


def unaligned(values):
    """The same doubles at an odd address."""
    bytes_ = np.zeros(values.nbytes + 1, np.uint8)
    moved = bytes_[1:].view(values.dtype)
    moved[:] = values
    assert not moved.flags.aligned
    return moved


class ArraysTest(unittest.TestCase):
    def assert_same(self, values, expected=None):
        """A column of these values is read as asarray reads them."""
        expected = np.asarray(values, np.float64).copy() if expected is None else np.asarray(expected)
        read = table({"gauge_1_V": values})["gauge_1_V"]
        self.assertEqual(read.dtype, np.float64)
        self.assertTrue(np.array_equal(read, expected, equal_nan=True), (read, expected))

    def assert_refused(self, log, words):
        with self.assertRaisesRegex(finray.InputError, words):
            finray.tables.table_of(log)

    def test_records_of_any_size(self):
        finger = finray.paper_finger()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", finray.FinrayWarning)
            whole = finray.estimate(finger, {name: VALUES[:, j].copy() for j, name in enumerate(GAUGES)})
            for first in ("u4", "u1", "u2", "u8", "f4", "S3"):
                for align in (False, True):
                    records = structured(first, "f8", align=align)
                    for name, values in table(records).items():
                        if name != "tick" or first != "S3":
                            self.assertTrue(np.array_equal(values, records[name].copy()), (first, align, name))
                    found = finray.estimate(finger, records)
                    self.assertTrue(np.array_equal(found["normal_1_N"], whole["normal_1_N"], equal_nan=True), first)
                    self.assertEqual(list(found.status), list(whole.status))
        for numbers in (">f8", "<f8", "f4", ">f4", "f2", "i2", ">i4", "g"):
            records = structured("u2", numbers)
            for name in GAUGES:
                self.assert_same(records[name])

    def test_steps_and_addresses(self):
        column = VALUES[:, 0].copy()
        for step in (1, 2, 3, -1, -2):
            self.assert_same(column[::step])
        for values in (np.asfortranarray(VALUES)[:, 2], VALUES.T[1], np.broadcast_to(1.5, ROWS), unaligned(column),
                       unaligned(column)[::-3], np.lib.stride_tricks.as_strided(column, (ROWS - 1,), (8,)),
                       np.broadcast_to(unaligned(column[:1]), (ROWS,)), column[:0], unaligned(column[:1])):
            self.assert_same(values)
        for step in (4, 12, -12, 20):
            raw = np.zeros(4096, np.uint8)
            at = 2048
            view = np.ndarray((50,), np.float64, raw.data, at, (step,))
            view[:] = np.linspace(0, 1, 50)
            self.assert_same(view)

    def test_types(self):
        column = VALUES[:, 0]
        for dtype in (">f8", "f4", ">f4", "f2", "g", "i1", "u1", "i8", "u8", ">i2", "?"):
            self.assert_same((100 * column).astype(dtype))
            self.assert_same((100 * column).astype(dtype)[::-2])
        self.assert_same([1, 2, 3])
        self.assert_same((0.5, True, 2))
        self.assert_same(range(5))
        self.assert_same(memoryview(column.copy()))
        self.assert_same(np.array([2**63, 2**64 - 1], np.uint64))

    def test_masks_are_cells_not_measured(self):
        for dtype in ("f8", "f4", ">f8", "i4"):
            values = np.ma.array((1000 * VALUES[:, 0]).astype(dtype), mask=np.arange(ROWS) % 3 == 0)
            self.assert_same(values, np.where(np.arange(ROWS) % 3 == 0, np.nan, values.data.astype(np.float64)))
        records = np.ma.array(structured("u4", "f8"), mask=False)
        records["gauge_2_V"][4] = np.ma.masked
        read = table(records)
        self.assertEqual(np.flatnonzero(np.isnan(read["gauge_2_V"])).tolist(), [4])
        self.assertEqual(np.isnan(read["gauge_1_V"]).sum(), 0)
        text = table({"note": np.ma.array(["a", "b"], mask=[False, True])})
        self.assertEqual(text["note"].tolist(), ["a", ""])

    def test_what_is_no_number_is_refused_by_name(self):
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # of numpy.matrix
        ones = np.ones(3)
        for values, words in ((ones + 1j, "'gauge_1_V': expected real numbers or text, found complex128"),
                              (ones.astype("F"), "'gauge_1_V'.*complex64"),
                              (np.zeros((3, 1)), "'gauge_1_V': expected a one-dimensional array, found one with 2"),
                              (np.matrix([1.0, 2, 3]), "'gauge_1_V': expected a one-dimensional array"),
                              (1.0, "'gauge_1_V': expected a one-dimensional array, found one with 0"),
                              (np.zeros(3, "V4"), "'gauge_1_V': expected real numbers or text"),
                              (np.zeros(3, "f8,f8"), "'gauge_1_V': expected real numbers or text"),
                              (np.array([1.0, "2", 3], "O"), r"'gauge_1_V'.* holds numbers, found text \(dtype object\)"),
                              (ones.astype("U"), "'gauge_1_V'.* holds numbers, found text"),
                              (ones.astype("S"), "'gauge_1_V'.* holds numbers, found text"),
                              (["1", "2", "3"], "'gauge_1_V'.* holds numbers, found text"),
                              ([1.0, None, "2"], "'gauge_1_V'.* holds numbers, found text"),
                              ([1.0, None, 10**400], "'gauge_1_V': expected numbers that a double holds"),
                              (ones.astype("M8[s]"), r"'gauge_1_V'.* holds numbers, found text \(dtype datetime64"),
                              (ones.astype("m8[s]"), r"'gauge_1_V'.* holds numbers, found text \(dtype timedelta64")):
            self.assert_refused({"gauge_1_V": values}, "the log: column " + words)
        self.assert_refused({"time_s": ones, "gauge_1_V": ones[:2]}, "'gauge_1_V': expected 3 values, found 2")
        self.assert_refused({"time_s": ones, "note": ["a"]}, "'note': expected 3 values, found 1")
        self.assert_refused({1: ones, "1": ones}, "two columns '1'")
        self.assert_refused(np.zeros(3, [("gauge_1_V", "f8", (2,))]), "'gauge_1_V': expected a one-dimensional array")

    def test_columns_of_other_names_hold_text(self):
        read = table({"note": np.array([b"a", b"\xc3\xa4"]), "mixed": np.array(["x", None, 2.5, np.nan], object)[:2],
                      "when": np.array(["2026-01-02", "NaT"], "M8[D]")})
        self.assertEqual({name: values.tolist() for name, values in read.items()},
                         {"note": ["a", "ä"], "mixed": ["x", ""], "when": ["2026-01-02", ""]})

    def test_objects_that_are_numbers(self):
        self.assert_same([None, 0.01, 0.01], [np.nan, 0.01, 0.01])
        self.assert_same([None, None], [np.nan, np.nan])
        self.assert_same(np.array([1, 2.5, True, np.float32(3), decimal.Decimal("0.5")], object), [1, 2.5, 1, 3, 0.5])
        self.assert_same(np.ma.array([1, "x"], mask=[False, True], dtype=object), [1, np.nan])

    def test_columns_that_nobody_uses_refuse_no_log(self):
        ones = np.ones(3)
        for values in (ones + 1j, np.zeros(3, "V4"), np.zeros((3, 2)), 1.0, [10**400, 1, None], [decimal.Decimal("sNaN"), 1, 2]):
            self.assertEqual(list(table({"time_s": ones, "mine": values})), ["time_s"])
        self.assertEqual(table({"note": ["\udc80", "a"], "\udc80": [1.0, 2.0]})["note"].tolist(), ["?", "a"])

    def test_live_readings(self):
        finger = finray.paper_finger()
        live = finray.Live(finger)
        row = VALUES[0]
        expected = live.next(row.tolist())
        for values in (row, row.astype(">f8"), tuple(row), unaligned(row), np.repeat(row, 2)[::2],
                       structured("u4", "f8")[GAUGES[0]][:4] * 0 + row):
            live.restart()
            self.assertEqual(repr(live.next(values)), repr(expected))
        live.restart()
        without = live.next([row[0], float("nan"), row[2], row[3]])
        live.restart()
        masked = np.ma.array(row, mask=[False, True, False, False])
        self.assertEqual(repr(live.next(masked)), repr(without))
        live.restart()
        self.assertEqual(repr(live.next((row[0], None, row[2], row[3]))), repr(without))
        for values, words in ((row + 0j, "gauges_V.*complex128"), (row[None, :], "gauges_V.*one-dimensional"),
                              (["1", "2", "3", "4"], "gauges_V.*expected numbers, found text"),
                              ([0.1, None, "0.1", 0.1], "gauges_V.*expected numbers, found text")):
            with self.assertRaisesRegex(finray.InputError, words):
                live.next(values)

    @unittest.skipIf(pandas is None, "no pandas")
    def test_data_frames(self):
        plain = pandas.DataFrame(VALUES, columns=GAUGES)
        some = np.arange(ROWS) % 7 == 0
        holed = plain.mask(np.repeat(some[:, None], len(GAUGES), axis=1))
        for dtype in ("Float64", "Float32"):
            read = table(holed.astype(dtype))
            for name in GAUGES:
                expected = holed[name].astype(np.float32 if dtype == "Float32" else float).to_numpy(np.float64)
                self.assertTrue(np.array_equal(read[name], expected, equal_nan=True), dtype)
        counts = pandas.Series([1, None, 3], dtype="Int64")
        self.assert_same(counts, [1, np.nan, 3])
        self.assert_same(pandas.Series([True, None], dtype="boolean"), [1, np.nan])
        self.assert_same(pandas.Series([2, 5], dtype="UInt8"), [2, 5])
        self.assert_same(pandas.Series([0, 1.5, 0], dtype=pandas.SparseDtype(float)), [0, 1.5, 0])
        self.assert_same(pandas.Series([1.5, 2.5], index=[7, 3]), [1.5, 2.5])
        self.assertTrue(np.shares_memory(table(plain)["gauge_1_V"], plain["gauge_1_V"].to_numpy()))
        self.assert_same(pandas.Series([1.5, None, 1.5]).astype("category"), [1.5, np.nan, 1.5])
        self.assert_same(pandas.Series([1.5, pandas.NA, 2], dtype=object), [1.5, np.nan, 2])
        for series, words in ((pandas.Series(["1", "2"]).astype("category"), r"found text \(dtype category\)"),
                              (pandas.Series(["1", "2"], dtype="string"), r"found text \(dtype string\)"),
                              (pandas.Series([1.5, "2"], dtype=object), r"found text \(dtype object\)"),
                              (pandas.to_datetime(pandas.Series([1, 2])), r"found text \(dtype datetime64"),
                              (pandas.Series([1j, 2]), "found complex128")):
            for log in ({"gauge_3_V": series}, pandas.DataFrame({"gauge_3_V": series})):
                self.assert_refused(log, "'gauge_3_V'.*" + words)
        twice = pandas.DataFrame(VALUES[:, :2], columns=["gauge_1_V", "gauge_1_V"])
        self.assert_refused(twice, "'gauge_1_V': expected a one-dimensional array, found one with 2")
        read = table(pandas.DataFrame({"note": pandas.Series(["a", None], dtype="string"),
                                       "kind": pandas.Series(["x", "y"]).astype("category")}))
        self.assertEqual({name: values.tolist() for name, values in read.items()},
                         {"note": ["a", ""], "kind": ["x", "y"]})


if __name__ == "__main__":
    unittest.main()

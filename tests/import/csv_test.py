#!/usr/bin/python3
"""CSV in the dialects of loggers, units, times and mappings; faults name line and column."""

import gzip
import unittest

import numpy as np
from fixture import ROOT, ImportCase

import csv_reader
import raw_table
import times
import units
import vocabulary

PLAIN = "time_s,gauge_1_V,force_N\n0,0.125,1.5\n0.1,-0.25,2\n"
LOG = {"time_s": ["0.0", "0.1"], "gauge_1_V": ["0.125", "-0.25"], "force_N": ["1.5", "2.0"]}
# Billions of words behind few bytes.
LAUGHS = "l0: &l0 [x, x, x]\n" + "".join(
    f"l{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 9)}]\n" for i in range(1, 9))


class DialectTest(ImportCase):
    def log_of_text(self, text, mapping=None, name="a.csv"):
        path = self.write(name, text)
        more = ["--mapping", self.write("m.yaml", mapping)] if mapping else []
        return self.log_of("--logs", path, "--force_bias_N", "0", *more)

    def test_all_dialects_give_the_same_log(self):
        comma = PLAIN.replace(",", ";").replace(".", ",")
        dialects = {
            "plain": PLAIN,
            "windows": PLAIN.replace("\n", "\r\n"),
            "byte order mark": "\ufeff" + PLAIN,
            "semicolon": PLAIN.replace(",", ";"),
            "semicolon, decimal comma": comma,
            "tab": PLAIN.replace(",", "\t"),
            "tab, decimal comma": PLAIN.replace(",", "\t").replace(".", ","),
            "spaces": PLAIN.replace(",", "   "),
            "bars": PLAIN.replace(",", "|"),
            "quotes": PLAIN.replace("gauge_1_V", '"gauge_1_V"').replace("0.125", '"0.125"'),
            "units": PLAIN.replace("\n", "\ns,V,N\n", 1),
            "units in brackets": PLAIN.replace("\n", "\n[s],[V],[N]\n", 1),
            "preamble": "Logger 7\nserial;12,5\n\n" + comma,
            "comments": "# by hand\n" + PLAIN,
            "header in a comment": "# by hand\n# " + PLAIN,
            "delimiter at the end": PLAIN.replace("\n", ",\n"),
            "trailing blank lines": PLAIN + "\n\n",
        }
        for name, text in dialects.items():
            with self.subTest(name):
                self.assertEqual(self.log_of_text(text), LOG)

    def test_utf_16_latin_1_and_gzip_are_read(self):
        for data in (PLAIN.encode("utf-16"), ("# Größe in µm\n" + PLAIN).encode("latin-1"),
                     gzip.compress(PLAIN.encode())):
            self.assertEqual(self.log_of_text(data), LOG)

    def test_a_header_that_is_absent_gives_numbers(self):
        log = self.log_of_text(PLAIN.split("\n", 1)[1],
                               "columns: {column_1: time_s, column_2: gauge_1_V, "
                               "column_3: force_N}")
        self.assertEqual(log, LOG)

    def test_words_for_nothing_leave_cells_empty(self):
        for word in ("NaN", "NA", "n/a", "", "-", "#NV", "null", "--"):
            with self.subTest(word):
                log = self.log_of_text(PLAIN.replace("-0.25", word))
                self.assertEqual(log["gauge_1_V"], ["0.125", ""])
        for word in ("OVER", "-9999"):
            log = self.log_of_text(PLAIN.replace("-0.25", word), "not_measured: [OVER, -9999]")
            self.assertEqual(log["gauge_1_V"], ["0.125", ""])

    def test_stated_dialect_holds(self):
        log = self.log_of_text("gauge_1_V\n1,5\n2,5\n", 'delimiter: ";"\ndecimal: ","')
        self.assertEqual(log, {"gauge_1_V": ["1.5", "2.5"]})

    def test_units_of_the_file_are_converted(self):
        for text, mapping in (
                ("t [ms],ch0 [mV],Fz [gf]\n0,125,1000\n100,-250,500\n",
                 "columns: {'ch0 [mV]': gauge_1_V, 'Fz [gf]': force_N}"),
                ("t,ch0,Fz\nms,mV,gf\n0,125,1000\n100,-250,500\n",
                 "columns: {ch0: gauge_1_V, Fz: force_N}"),
                ("t,ch0,Fz\n0,125,1000\n100,-250,500\n",
                 "columns: {t: {to: time_s, unit: ms}, ch0: {to: gauge_1_V, unit: mV}, "
                 "Fz: {to: force_N, unit: gf}}"),
                ("time_ms,gauge_1_mV,force_gf\n0,125,1000\n100,-250,500\n", None)):
            with self.subTest(text):
                log = self.log_of_text(text, mapping)
                self.assertEqual(log["time_s"], ["0.0", "0.1"])
                self.assertEqual(log["gauge_1_V"], ["0.125", "-0.25"])
                self.assertEqual([float(v) for v in log["force_N"]], [9.80665, 9.80665 / 2])

    def test_a_row_of_units_may_hold_units_that_no_column_takes(self):
        known = ("Nm", "Nmm", "N mm", "N·m", "mNm", "[Nm]", "mm", "", "-")
        for unit in (*known, "foo", "m/s^2"):
            for names, of_names in (("t,Fx,Tx,Ty", "s,N"), ("Time;Fx;Tx;Ty", "s;N"),
                                    ("tick,Fx,Tx,Ty", ",N"), ("force_N,Fx,Tx,Ty", "N,mN")):
                if unit in ("foo", "m/s^2") and names.startswith("tick"):
                    continue  # no header has a meaning, and most words are unknown
                with self.subTest((unit, names)):
                    mark = ";" if ";" in names else ","
                    rows = [names, mark.join([of_names, unit, unit]),
                            *(mark.join(map(str, (i, 2, 3, 4))) for i in range(1, 9))]
                    table = csv_reader.read(str(self.write("a.csv", "\n".join(rows) + "\n")), {})[0]
                    self.assertEqual([c.name for c in table.columns], names.split(mark))
                    self.assertEqual([c.unit for c in table.columns],
                                     [*of_names.split(mark), *[unit.strip("[]")] * 2])
                    self.assertEqual(table.rows, 8)

    def test_a_header_is_no_row_of_units(self):
        for above in ("Rig,Sensor,Amplifier", "DAQ,7b,x"):
            for header in ("t,V,N", "time_s,gauge_1_V,N", "ch1,x,N"):
                with self.subTest((above, header)):
                    text = f"{above}\n{header}\n" + PLAIN.split("\n", 1)[1]
                    table = csv_reader.read(str(self.write("a.csv", text)), {})[0]
                    self.assertEqual([c.name for c in table.columns], header.split(","))
        log = self.log_of_text("Rig,Sensor,Amplifier\ns,V,N\n" + PLAIN.split("\n", 1)[1],
                               "columns: {s: time_s, V: gauge_1_V, N: force_N}")
        self.assertEqual(log, LOG)

    def test_an_unknown_unit_is_refused_where_its_column_is_used(self):
        text = PLAIN.replace("force_N", "Tx").replace("\n", "\ns,V,{}\n", 1)
        for unit in ("Nm", "foo"):
            log = self.log_of_text(text.format(unit))
            self.assertEqual(log, {n: LOG[n] for n in ("time_s", "gauge_1_V")})
            path, mapping = self.folder / "a.csv", self.write("m.yaml", "columns: {Tx: force_N}")
            line = self.refused("--logs", path, "--mapping", mapping)
            self.assertIn("column 'Tx': force_N takes one of N, mN", line)
            self.assertIn(f"found '{unit}'", line)
        path = self.write("a.csv", PLAIN.replace("\n", "\ns,V,pounds\n", 1))
        self.assertIn("found 'pounds'", self.refused("--logs", path))
        path = self.write("a.csv", "Tx [Nmm],t\n1,2\n")
        mapping = self.write("m.yaml", "columns: {'Tx [Nmm]': force_N}")
        self.assertIn("found 'Nmm'", self.refused("--logs", path, "--mapping", mapping))
        self.log_of_text("time,gauge_1_V\nISO 8601,V\n2026-03-11T14:05:07,1\n"
                         "2026-03-11T14:05:08,1\n")

    def test_scale_and_offset_apply_behind_the_unit(self):
        log = self.log_of_text(
            "t,ch0,x\n0,0,0.15\n1,65535,0.16\n",
            "columns: {t: time_s, ch0: {to: gauge_1_V, unit: {adc_bits: 16, "
            "range_V: [-5, 5]}}, x: {to: object_x_mm, unit: m, scale: -1, offset: 150}}")
        self.assertEqual(log["gauge_1_V"], ["-5.0", repr(-5 + 65535 * (10 / 65536))])
        self.assertEqual(log["object_x_mm"], ["0.0", "-10.0"])
        log = self.log_of_text("t,x\ns,m\n0,0.15\n", "columns: {x: {to: object_x_mm, "
                               "scale: -1000, offset: 150}}")
        self.assertEqual(log["object_x_mm"], ["0.0"])
        log = self.log_of_text("t,ch0\n0,100\n", "columns: {ch0: {to: gauge_1_V, scale: 8.06e-4}}")
        self.assertEqual(log["gauge_1_V"], [repr(100 * 8.06e-4)])

    def test_a_scale_of_one_against_a_unit_of_the_file_is_said(self):
        self.log_of_text("t,x\ns,m\n0,0.15\n", "columns: {x: {to: object_x_mm, scale: -1}}")
        self.assertIn("state `unit: m`", self.result.err)
        log = self.log_of_text("t,ch,x\ns,V,mm\n0,1,0.15\n", "columns: {ch: gauge_1_V, "
                               "x: {to: friction_1, scale: 1}}")
        self.assertEqual((log["friction_1"], self.result.err), (["0.15"], ""))

    def test_times_of_every_kind_are_the_same(self):
        for cells in (("2026-03-11T14:05:07", "2026-03-11T14:05:07.1"),
                      ("2026-03-11 14:05:07Z", "2026-03-11 15:05:07.100+01:00"),
                      ("2026-03-11T14:05:07,000", "2026-03-11T14:05:07,100"),
                      ("1773237907", "1773237907.1"), ("1773237907000", "1773237907100"),
                      ("1773237907000000000", "1773237907100000000")):
            with self.subTest(cells):
                delimiter = ";" if "," in cells[0] else ","
                rows = [("time", "gauge_1_V"), (cells[0], "0"), (cells[1], "1")]
                log = self.log_of_text("\n".join(delimiter.join(r) for r in rows) + "\n")
                self.assertEqual(log["time_s"], ["0.0", "0.1"])
                text = (self.folder / "log.mapping.yaml").read_text()
                self.assertIn("2026-03-11T14:05:07Z", text)

    def test_a_clock_beside_a_date_is_a_time(self):
        log = self.log_of_text("Datum;Zeit;ch0\n11.03.2026;23:59:59,9;1,5\n"
                               "12.03.2026;00:00:00,4;2,5\n", "columns: {ch0: gauge_1_V}")
        self.assertEqual(log["time_s"], ["86399.9", "86400.4"])
        self.assertIn("a.csv: left out: Datum", self.result.out)
        again = (self.folder / "log.mapping.yaml").read_text()
        self.assertIn("Zeit: {to: time_s, format: clock}", again)
        path = self.write("a.csv", "Zeit;ch0\n14:05:07;1\n14:05:61;2\n")
        self.assertIn("a.csv:3", self.refused("--logs", path))

    def test_columns_of_one_name_are_told_apart(self):
        log = self.log_of_text("time,ch,time,ch\n0,125,0,1\n0.1,-250,0.1,2\n",
                               "columns: {ch: {to: gauge_1_V, unit: mV}, ch.2: force_N}")
        self.assertEqual(log, {**LOG, "force_N": ["1.0", "2.0"]})
        self.assertIn("columns of one name are time.2, ch.2", self.result.out)

    def test_one_mapping_can_be_shared(self):
        self.write("shared.yaml", "decimal: ','\ncolumns: {ch0: {to: gauge_1_V, unit: mV}}\n")
        for mapping in ("columns: shared.yaml", "tables: {a.csv: {columns: shared.yaml}}"):
            log = self.log_of_text("time_s;ch0\n0;125\n0,1;-250\n", mapping)
            self.assertEqual(log, {n: LOG[n] for n in ("time_s", "gauge_1_V")})

    def test_headers_may_stand_on_either_side(self):
        log = self.log_of_text("t,Fz\n0,1.5\n0.1,2\n", "columns: {force_N: Fz}")
        self.assertEqual(log["force_N"], LOG["force_N"])

    def test_a_stated_header_line_holds(self):
        text = "1,2,3\n4,5,6\ntime_s,gauge_1_V,force_N\n-,-,-\n" + PLAIN.split("\n", 1)[1]
        log = self.log_of_text(text, "header_line: 3\nunits_row: true")
        self.assertEqual(log, LOG)

    def test_counts_beyond_the_converter_are_a_fault(self):
        path = self.write("a.csv", "time_s,ch0\n0,65535\n1,65536\n")
        mapping = self.write("m.yaml", "columns: {ch0: {to: gauge_1_V, unit: {adc_bits: 16, "
                             "range_V: [-5, 5]}}}")
        line = self.refused("--logs", path, "--mapping", mapping)
        self.assertIn("a.csv:3", line)
        self.assertIn("0 to 65535, found 65536", line)

    def test_comments_may_be_long(self):
        log = self.log_of_text("# " + "a, b; " * 20000 + "\ntime_s,gauge_1_V\n0,1\n1,2\n")
        self.assertEqual(log["gauge_1_V"], ["1.0", "2.0"])

    def test_a_cut_last_cell_is_said(self):
        self.log_of_text(PLAIN[:-1])
        self.assertIn("its last cell may be cut", self.result.err)


class FaultTest(ImportCase):
    def fault(self, text, mapping=None):
        path = self.write("bad.csv", text)
        more = [] if mapping is None else ["--mapping", self.write("m.yaml", mapping)]
        return self.refused("--logs", path, *more)

    def test_faults_of_a_table_name_line_and_column(self):
        for text, words in (
                (PLAIN.replace("-0.25", "x7"), ["bad.csv:3", "gauge_1_V", "x7"]),
                (PLAIN.replace("-0.25", "1e999"), ["bad.csv:3", "1e999"]),
                (PLAIN.replace("-0.25", "0x10"), ["bad.csv:3", "0x10"]),
                (PLAIN.replace("-0.25,2", "-0.25"), ["bad.csv:3", "expected 3 cells, found 2"]),
                (PLAIN + "1" * (17 << 20), ["bad.csv:4", "16 MiB"]),
                ("a," * 20000 + "\n" + "1," * 20000 + "\n", ["bad.csv:1", "10000 cells"]),
                (PLAIN.replace("0.1,", "-0.1,"), ["bad.csv:3", "time_s", "goes back"]),
                (PLAIN.replace("0.1,", "NA,"), ["bad.csv:3", "needs a time"]),
                (PLAIN + "0.2,1.234,5,6\n", ["bad.csv:4", "4"]),
                ("", ["bad.csv", "no rows"]), ("time_s,force_N\n", ["bad.csv", "no rows"]),
                ("hello\n", ["bad.csv", "no rows"]), (PLAIN + "\0", ["bad.csv:4", "NUL"]),
                (b"\x1f\x8b\x08\x00", ["bad.csv", "the gzip file is cut"]),
                (gzip.compress(PLAIN.encode() * 99)[:-20], ["bad.csv", "the gzip file is cut"]),
                (b"\x1f\x8b\x08\x00" + b"x" * 99, ["bad.csv", "broken gzip"]),
                ("a,b\n1,2\n", ["bad.csv", "no column is understood", "--mapping"])):
            with self.subTest(text[:99]):
                line = self.fault(text)
                for word in words:
                    self.assertIn(word, line)

    def test_mixed_decimal_marks_are_a_fault(self):
        line = self.fault("time_s;force_N\n0;1,5\n1;2,5\n2;3.5\n3;4,5\n")
        self.assertIn("bad.csv:4", line)

    def test_faults_of_a_mapping_name_the_line_and_the_nearest_name(self):
        for mapping, words in (
                ("columns: {a: force}", ["m.yaml:1:14: a: 'force' is no column", "force_N"]),
                ("columns:\n  a: {to: force_N, unti: gf}", ["m.yaml:2:20: unknown key", "'unit'"]),
                ("columns:\n  a: {to: force_N,\n    unit: mm}",
                 ["m.yaml:3:11: unit", "takes one of N, mN"]),
                ("columns:\n  a: force_N\n  bb: time_s", ["m.yaml:3:3: no recording has a column 'bb'",
                                                          "time_s", "`tables`"]),
                ("columns: {A: force_N}", ["m.yaml:1:11", "'A'", "force_N", "did you mean 'a'"]),
                ("tables: {bad.csv: {columns: {c: force_N}}}",
                 ["m.yaml:1:30: bad.csv has no column 'c' to become force_N"]),
                ("not_measured: {a: 1}", ["m.yaml:1:15", "a list of words"]),
                ("columns: {a: {to: force_N, unit: kgff}}", ["m.yaml:1", "kgf"]),
                ("columns: {a: {scale: 2}}", ["m.yaml:1", "needs `to`"]),
                ("columns: {a: {to: gauge_1_V, unit: counts}}", ["m.yaml:1", "adc_bits"]),
                ("columns: {a: {to: gauge_1_V, unit: {adc_bits: 16}}}", ["m.yaml:1", "range_V"]),
                ("columns: {a: {to: force_N, unit: {adc_bits: 16, range_V: [0, 1]}}}",
                 ["m.yaml:1", "volts"]),
                ("columns: {a: {to: gauge_1_V, unit: {adc_bits: 16, range_V: [1, 0]}}}",
                 ["m.yaml:1", "smaller"]),
                ("columns: {a: {to: time_s, unit: ms, format: iso8601}}", ["m.yaml:1", "none"]),
                ("columns: none.yaml", ["none.yaml", "cannot be read"]),
                ("columns: {a: {to: force_N, scale: 0}}", ["m.yaml:1", "scale"]),
                ("columns: {a: {to: force_N, scale: x}}", ["m.yaml:1", "number"]),
                ("columns: {a: {to: time_s, format: iso}}", ["m.yaml:1", "iso8601"]),
                ("columns: {a: {to: force_N, format: epoch}}", ["m.yaml:1", "time_s"]),
                ("column: {}", ["m.yaml:1", "'columns'"]),
                ("columns: {a: force_N, a: time_s}", ["m.yaml:1", "twice"]),
                ("columns: {a: force_N, b: force_N}", ["'a'", "'b'", "force_N"]),
                ("join: {method: cubic}", ["m.yaml:1", "; the default is linear"]),
                ("delimiter: *l9", ["m.yaml:1"]), ("x: " + "[" * 5000, ["m.yaml"]),
                (LAUGHS + "delimiter: *l8", ["m.yaml"]), (LAUGHS + "columns: *l8", ["m.yaml"]),
                ("columns:\n\ta: force_N", ["m.yaml:2:1: tab in the indentation, YAML wants spaces"]),
                ("a: [", ["m.yaml"]), ("", ["m.yaml", "empty"]), ("[]", ["m.yaml:1"]),
                ("decimal: ';'", ["m.yaml:1", "';'"])):
            with self.subTest(mapping):
                line = self.fault("a,b\n1,2\n", mapping)
                for word in words:
                    self.assertIn(word, line)

    def test_columns_of_files_that_are_not_there_may_be_mapped(self):
        plain = self.write("a.csv", PLAIN)
        for mapping in ("columns: {operator: null}",  # left out: nothing is missed
                        "columns: {time_s: time_s, t: time_s}",  # one of two names
                        "tables: {rig.csv: {columns: {Fz: force_x_N}}}"):
            with self.subTest(mapping):
                log = self.log_of("--logs", plain, "--mapping", self.write("m.yaml", mapping))
                self.assertEqual(log, LOG)
        self.assertIn("no recording has the table 'rig.csv'", self.result.err)

    def test_tables_are_named_by_patterns_too(self):
        text = PLAIN.replace("force_N", "Fz").replace(",", ";")
        for name in ("rig_007.csv", "rig_007.csv.gz"):
            data = text.encode()
            path = self.write(name, gzip.compress(data) if name.endswith("gz") else data)
            for said in ("rig_007.csv", "rig_*.csv", "rig*", "*"):
                with self.subTest((name, said)):
                    mapping = self.write("m.yaml", f"tables: {{'{said}': {{columns: {{Fz: force_N}}, "
                                         "delimiter: ';'}}")
                    log = self.log_of("--logs", path, "--mapping", mapping, "--force_bias_N", "0")
                    self.assertEqual((log, self.result.err), (LOG, ""))
            # An exact name says more than a pattern.
            mapping = self.write("m.yaml", "tables: {'*': {columns: {Fz: null}}, rig_007.csv: "
                                 f"{{columns: {{Fz: force_N}}}}}}".replace("rig_007.csv", name))
            self.assertEqual(self.log_of("--logs", path, "--mapping", mapping,
                                         "--force_bias_N", "0"), LOG)
            mapping = self.write("m.yaml", "tables: {'rug_*.csv': {columns: {Fz: force_N}}}")
            self.log_of("--logs", path, "--mapping", mapping)
            self.assertIn("no recording has the table 'rug_*.csv'", self.result.err)
            mapping = self.write("m.yaml", "tables: {'rig_*': {columns: {Fy: force_N}}}")
            self.assertIn("rig_* has no column 'Fy'",
                          self.refused("--logs", path, "--mapping", mapping))

    def test_columns_that_nobody_knows_are_listed(self):
        result = self.run_import("--logs", self.write("a.csv", PLAIN.replace("force_N", "Fz")))
        self.assertEqual(result.code, 0)
        self.assertIn("a.csv: left out: Fz", result.out)
        self.assertIn("columns: {'Fz': {to: gauge_2_V", result.out)  # there is a gauge_1_V
        result = self.run_import("--logs", self.write("b.csv", "a,b [mV]\n1,2\n"))
        self.assertEqual((result.code, result.err), (0, ""))


class NamesTest(unittest.TestCase):
    def test_the_vocabulary_is_that_of_the_library(self):
        source = (ROOT / "libfinray/finray/io/frame_vocabulary.cc").read_text()
        start = source.index("words(") + len("words(")
        words = "".join(source[start:source.index(");", start)].split('"')[1::2]).split()
        self.assertEqual(vocabulary.PATTERNS, words)

    def test_words_for_nothing_are_those_of_the_library(self):
        source = (ROOT / "libfinray/finray/io/column_mapping.cc").read_text()
        source = source[source.index("kNotMeasured"):]
        words = source[:source.index("}")].split('"')[1::2]
        self.assertEqual({"", *words}, raw_table.NA_WORDS)

    def test_headers_are_guessed_only_where_they_are_certain(self):
        self.assertEqual(vocabulary.guess("gauge_3_mV", ""), ("gauge_3_V", units.find("mV")))
        self.assertEqual(vocabulary.guess("force [kg]", "kg"), ("force_N", units.find("kgf")))
        self.assertEqual(vocabulary.guess("object_x", "m"), ("object_x_mm", units.find("m")))
        self.assertEqual(vocabulary.guess("Time (s)", "s")[0], "time_s")
        for header in ("Fz", "ch0", "stage_x", "force", "gauge_0_V"):
            self.assertIsNone(vocabulary.guess(header, ""))

    def test_units(self):
        def one(unit, target):
            return units.conversion(units.find(unit), target).apply(np.array([12.3]))[0]
        self.assertEqual(one("kgf", "force_N"), 12.3 * 9.80665)
        self.assertEqual(one("deg", "object_angle_deg"), 12.3)
        self.assertEqual(one("deg", "gauge_1_rad"), 12.3 * np.pi / 180)
        self.assertEqual(one("m", "object_x_mm"), 12300)
        self.assertEqual(one("mV", "gauge_1_V"), 0.0123)
        self.assertEqual(one("µV", "gauge_1_V"), 12.3e-6)
        self.assertEqual(one("K", "temperature_C"), 12.3 - 273.15)
        self.assertAlmostEqual(one("degF", "temperature_C"), (12.3 - 32) / 1.8, 12)
        self.assertIsNone(units.conversion(units.find("mm"), "force_N"))
        signed = units.Counts(16, -5, 5, True)
        self.assertEqual((signed.least, signed.most), (-32768, 32767))
        np.testing.assert_array_equal(signed.apply(np.array([-32768.0, 0.0])), [-5, 0])

    def test_iso_times(self):
        self.assertEqual(times.iso_ns("1970-01-02T00:00:00.000000001"), 86400 * 10**9 + 1)
        self.assertEqual(times.iso_ns("1970-01-01T02:00+0200"), 0)
        for text in ("2026-13-01T00:00:00", "2026-01-01", "12:00:00", "2026-01-01T25:00:00"):
            self.assertIsNone(times.iso_ns(text))


if __name__ == "__main__":
    unittest.main()

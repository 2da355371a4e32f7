#!/usr/bin/python3
"""The pages of finray_view in headless Chromium: they draw, scrub, zoom, play and compare without
an error, and load nothing from elsewhere."""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
sys.path.insert(0, str(HERE))
import browser as chromium  # noqa: E402

FINGER = ROOT / "datasets/mixed/finger.yaml"
# How many pixels of a canvas are painted.
PAINTED = """(canvas => { const d = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0; return n; })"""
FRAME = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


def run(tool, *arguments):
    return subprocess.run([BINARIES / tool, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        logs = cls.folder / "logs"
        logs.mkdir()
        rows = (ROOT / "datasets/mixed/log.csv").read_text().splitlines(keepends=True)
        (logs / "2026-03-01 a.csv").write_text("".join(rows))
        (logs / "2026-03-04 b.csv").write_text("".join(rows[:1] + rows[100:300]))
        # Gauges that have slipped: a log with warnings.
        slipped = [",".join([c[0], str(float(c[1]) + 0.02), *c[2:]]) for c in (r.split(",") for r in rows[1:150])]
        (logs / "2026-03-07 c.csv").write_text("".join(rows[:1] + slipped))
        cls.out = cls.folder / "D"
        cls.said = run("finray_estimate", "--finger", FINGER, "--logs", f"{logs}/*.csv", "--out_dir", cls.out, "--report")
        cls.driver = chromium.Browser()
        cls.browser = cls.driver.__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.driver.__exit__()
        cls.temporary.cleanup()

    def setUp(self):
        self.browser.errors.clear()
        self.browser.window(1280, 900)

    def tearDown(self):
        self.assertEqual(self.browser.errors, [])

    def open(self, name, fragment=""):
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.open((self.out / name).resolve().as_uri() + fragment)
        self.browser.run(FRAME)

    def readout(self):
        rows = self.browser.run("[...document.getElementById('readout').rows].map(r => [...r.cells].map(c => c.textContent))")
        return {row[0]: row[1:] for row in rows}

    def test_report_is_beside_the_results(self):
        self.assertIn(f"report         {self.out}/index.html\n", self.said)
        self.assertEqual(sorted(p.name for p in self.out.glob("*.html")),
                         ["2026-03-01 a.html", "2026-03-04 b.html", "2026-03-07 c.html", "index.html"])

    def test_pages_of_an_earlier_run_go(self):
        """A run without --report leaves no page that is no longer true, and none that finray has not written."""
        logs, out = self.folder / "again", self.folder / "again_D"
        logs.mkdir()
        for name in ("index", "b"):
            shutil.copy(self.folder / "logs/2026-03-04 b.csv", logs / f"{name}.csv")
        batch = ["finray_estimate", "--finger", FINGER, "--logs", f"{logs}/*.csv", "--out_dir", out]
        run(*batch, "--report")
        self.assertEqual(sorted(p.name for p in out.glob("*.html")), ["b.html", "index.html", "index_log.html"])
        self.assertIn("index_log.html", (out / "index.html").read_text())
        (out / "b.html").write_text("<html>of the user</html>")
        run(*batch)
        self.assertEqual([p.name for p in out.glob("*.html")], ["b.html"])

    def test_a_folder_without_results_is_one_line(self):
        (self.folder / "none").mkdir()
        done = subprocess.run([BINARIES / "finray_view", "--results", self.folder / "none", "--out_dir", self.folder / "V"],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
        self.assertIn("none: has no summary.yaml", done.stderr)
        self.assertFalse((self.folder / "V").exists())

    def test_draws_all(self):
        self.open("2026-03-01 a.html")
        painted = self.browser.run(f"[...document.querySelectorAll('canvas')].filter(c => c.offsetParent).map({PAINTED})")
        self.assertEqual(len(painted), 6)  # the finger and five plots
        self.assertTrue(all(n > 5000 for n in painted[1:]), painted)
        self.assertGreater(painted[0], 3000)

    def test_values_are_those_of_the_result(self):
        self.open("2026-03-01 a.html")
        with open(self.out / "2026-03-01 a.frames.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        names = ["contact_1_mm", "contact_1_std_mm", "normal_1_N", "contact_2_mm", "force_N"]
        page = self.browser.run("finray.then(p => Array.from({length: p.logs[0].end}, (_, i) => [p.logs[0].time(i), "
                                "STATUSES[Math.log2(p.logs[0].status[i])], "
                                f"...{json.dumps(names)}.map(n => {{const v = p.logs[0].value(n, i); return isNaN(v) ? null : v}})]))")
        self.assertEqual(len(page), len(rows))
        for shown, row in zip(page, rows):
            self.assertAlmostEqual(shown[0], float(row["time_s"]), delta=1e-3)
            self.assertEqual(shown[1], row["status"])
            for name, value in zip(names, shown[2:]):
                self.assertEqual(value is None, row[name] == "", (name, row))
                if value is None:
                    continue
                true = float(row[name])
                self.assertAlmostEqual(value, true, delta=0.04 * true if "std" in name else 3e-3)

    def test_shape_is_that_of_the_simulation(self):
        """The page's shape against finray_simulate's, which reads neither table nor codes."""
        self.open("2026-03-01 a.html")
        for frame in (30, 139, 168):  # one contact, two contacts, one
            loads = self.browser.run(f"finray.then(p => ['contact_1_mm', 'normal_1_N', 'contact_2_mm', 'normal_2_N'].map(n => p.logs[0].value(n, {frame}))"
                                     ".map(v => isNaN(v) ? null : v))")
            count = 4 if loads[2] is not None else 2
            table = self.folder / "loads.csv"
            table.write_text(",".join(["contact_1_mm", "normal_1_N", "contact_2_mm", "normal_2_N"][:count]) + "\n"
                             + ",".join(map(str, loads[:count])) + "\n")
            shape = self.folder / "shape.csv"
            run("finray_simulate", "--finger", FINGER, "--frames", table, "--out", self.folder / "out.csv", "--shape_out", shape)
            front = [list(map(float, r.split(",")[2:5])) for r in shape.read_text().splitlines()[1:] if ",front," in r]
            places, arcs = self.browser.run(f"finray.then(p => [Array.from(p.picture.finger.shape(p.logs[0], {frame}).places), p.picture.finger.front])")
            for k, arc in enumerate(arcs):
                a, b = next(((p, q) for p, q in zip(front, front[1:]) if p[0] <= arc <= q[0] + 1e-9))
                u = (arc - a[0]) / (b[0] - a[0])
                for axis in (1, 2):
                    self.assertAlmostEqual(places[2 * k + axis - 1], a[axis] + u * (b[axis] - a[axis]), delta=0.08)

    def test_friction_of_each_row(self):
        """A circle slides up the finger and down again: friction turns round, and arrow and shape with it."""
        scene, table, log = (self.folder / name for name in ("slide.yaml", "slide.csv", "slide.frames.csv"))
        scene.write_text("{contacts: 1, friction_coefficient: 0.3, presliding_mm: 0.001, object: {shape: circle, radius_mm: 15}}\n")
        table.write_text("time_s,object_x_mm,object_y_mm\n"
                         + "".join(f"{0.1 * i:.1f},-9,{75 + 0.8 * min(i, 39 - i):.1f}\n" for i in range(40)))
        run("finray_simulate", "--finger", FINGER, "--scene", scene, "--frames", table, "--out", log)
        run("finray_view", "--results", log, "--finger", FINGER, "--out_dir", self.out / "slide")
        with open(log, newline="") as file:
            rows = list(csv.DictReader(file))
        self.open("slide/slide.html")
        # The shaft of an arrow is the only line of this width.
        self.browser.run("""(prototype => { let path = []; window.shafts = [];
          for (const name of ["moveTo", "lineTo", "beginPath", "stroke"]) {
            const plain = prototype[name];
            prototype[name] = function (...at) {
              if (name === "beginPath") path = [];
              else if (name !== "stroke") path.push(at);
              else if (Math.abs(this.lineWidth - 2.6) < 0.01 && path.length === 2) window.shafts.push(path);
              return plain.apply(this, at);
            };
          } })(CanvasRenderingContext2D.prototype)""")
        turns = set()
        for frame in (10, 15, 25, 35):
            row = {name: float(cell) for name, cell in rows[frame].items() if name != "status"}
            self.browser.run(f"window.shafts.length = 0, finray.then(p => {{ p.scrub({row['time_s']}); }})")
            self.browser.run(FRAME)
            ((tail_x, tail_y), (head_x, head_y)), = self.browser.run("window.shafts")
            drawn = math.atan2(tail_y - head_y, head_x - tail_x)  # y of a canvas points down
            into_finger = row["contact_1_angle_rad"] - math.pi / 2
            self.assertAlmostEqual(drawn - into_finger, math.atan(row["friction_1"]), delta=0.01)
            turns.add(round(row["friction_1"], 3))
            tip = self.browser.run(f"finray.then(p => {{ const n = p.picture.finger.front.length, s = p.picture.finger.shape(p.logs[0], {frame});"
                                   "return [s.places[2 * n - 2], s.places[2 * n - 1]]; })")
            for shown, axis in zip(tip, "xy"):
                self.assertAlmostEqual(shown, row[f"tip_{axis}_mm"], delta=0.05)
        self.assertEqual(turns, {-0.3, 0.3})

    def test_scrubs_by_mouse_keys_and_slider(self):
        self.open("2026-03-01 a.html")
        box = self.browser.run("(b => [b.x, b.y, b.width, b.height])(document.querySelector('.plot .area').getBoundingClientRect())")
        x, y = box[0] + 0.5 * box[2], box[1] + 0.5 * box[3]
        self.browser.mouse("mousePressed", x, y)
        self.browser.run(FRAME)
        first = self.readout()["frame"]
        self.browser.mouse("mouseMoved", x + 100, y)
        self.browser.mouse("mouseReleased", x + 100, y)
        self.browser.run(FRAME)
        second = self.readout()["frame"]
        self.assertGreater(int(second[0]), int(first[0]) + 20)
        self.browser.run("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}))")
        self.browser.run(FRAME)
        self.assertEqual(int(self.readout()["frame"][0]), int(second[0]) + 1)
        self.browser.run("(s => { s.value = 1; s.dispatchEvent(new Event('input')) })(document.getElementById('scrub'))")
        self.browser.run(FRAME)
        self.assertEqual(self.readout()["frame"], ["500"])

    def test_zooms_and_plays(self):
        self.open("2026-03-01 a.html")
        span = "finray.then(p => p.view.t1 - p.view.t0)"
        whole = self.browser.run(span)
        self.browser.run("document.getElementById('in').click()")
        self.assertAlmostEqual(self.browser.run(span), whole / 2)
        box = self.browser.run("(b => [b.x, b.y, b.width, b.height])(document.querySelector('.plot .area').getBoundingClientRect())")
        self.browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=box[0] + 200, y=box[1] + 50, deltaX=0, deltaY=-300, modifiers=2)
        self.browser.wait(f"{span}.then(s => s < {0.9 * whole / 2})")
        self.browser.run("document.getElementById('all').click()")
        self.assertAlmostEqual(self.browser.run(span), whole)
        self.browser.run("document.getElementById('play').click()")
        self.browser.wait("finray.then(p => p.view.cursor > 0.3)")
        self.browser.run("document.getElementById('play').click()")
        self.assertFalse(self.browser.run("finray.then(p => p.playing)"))

    def test_compares_with_a_page_and_by_command(self):
        self.open("2026-03-01 a.html")
        document = self.browser.call("DOM.getDocument")["root"]["nodeId"]
        node = self.browser.call("DOM.querySelector", nodeId=document, selector="#other")["nodeId"]
        self.browser.call("DOM.setFileInputFiles", nodeId=node, files=[str(self.out / "2026-03-04 b.html")])
        self.browser.wait("finray.then(p => p.logs.length === 2)")
        self.browser.run(FRAME)
        self.assertEqual(len(self.readout()["frame"]), 2)
        run("finray_view", "--results", f"{self.out}/2026-03-01 a.frames.csv,{self.out}/2026-03-04 b.frames.csv", "--compare",
            "--finger", FINGER, "--out_dir", self.out / "both")
        self.open("both/2026-03-01 a_and_2026-03-04 b.html")
        self.browser.run("finray.then(p => p.scrub(8))")
        self.browser.run(FRAME)
        self.assertEqual(self.readout()["frame"], ["161", "62"])
        self.assertGreater(self.browser.run(f"{PAINTED}(document.getElementById('finger'))"), 3000)

    def test_without_a_finger(self):
        run("finray_view", "--results", f"{self.out}/2026-03-01 a.frames.csv", "--out_dir", self.out / "bare")
        self.open("bare/2026-03-01 a.html")
        self.assertFalse(self.browser.run("document.getElementById('finger').offsetParent !== null"))
        self.assertNotIn("residuals", self.readout())

    def test_page_of_all_logs(self):
        self.open("index.html")
        amber = self.browser.run("[...document.querySelectorAll('tr.amber a')].map(a => a.textContent)")
        self.assertEqual(amber, ["2026-03-07 c"])
        self.assertEqual(self.browser.run("document.querySelector('.verdict .chip').textContent"), "zero")
        self.assertEqual(self.browser.run("document.querySelectorAll('svg').length"), 3)
        link = self.browser.run("[...document.querySelectorAll('a')].find(a => a.hash).href")
        frame = link.split("=")[-1]
        self.browser.open(link)
        self.browser.run(FRAME)
        self.assertEqual(self.readout()["frame"], [frame])

    def test_phone_and_dark(self):
        for width, dark in ((390, False), (390, True), (1280, True)):
            self.browser.window(width, 844, dark, ratio=2, phone=width < 500)
            for name in ("2026-03-01 a.html", "index.html"):
                self.open(name)
                self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), width)
                ground = self.browser.run("getComputedStyle(document.body).backgroundColor")
                self.assertEqual(ground, "rgb(20, 24, 29)" if dark else "rgb(255, 255, 255)")

    def test_colours_stand_apart_for_colour_blind_readers(self):
        """Lines of different meaning differ in lightness or by more than 20 units of CIE Lab after
        simulated loss of red or green cones (Vienot 1999), and from the ground by a contrast of 3."""
        def linear(c):
            return [(v / 255 / 12.92) if v <= 10 else ((v / 255 + 0.055) / 1.055) ** 2.4 for v in c]

        def blind(c, kind):
            r, g, b = c
            l, m, s = 17.8824 * r + 43.5161 * g + 4.11935 * b, 3.45565 * r + 27.1554 * g + 3.86714 * b, 0.0299566 * r + 0.184309 * g + 1.46709 * b
            if kind == "protan":
                l = 2.02344 * m - 2.52581 * s
            if kind == "deutan":
                m = 0.494207 * l + 1.24827 * s
            return [0.0809444479 * l - 0.130504409 * m + 0.116721066 * s, -0.0102485335 * l + 0.0540193266 * m - 0.113614708 * s,
                    -0.000365296938 * l - 0.00412161469 * m + 0.693511405 * s]

        def lab(c):
            r, g, b = (max(0, v) for v in c)
            xyz = [(0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505, 0.2126 * r + 0.7152 * g + 0.0722 * b, (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089]
            f = [v ** (1 / 3) if v > 0.008856 else 7.787 * v + 16 / 116 for v in xyz]
            return 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])

        def luminance(c):
            return sum(w * v for w, v in zip((0.2126, 0.7152, 0.0722), c))

        for dark in (False, True):
            self.browser.window(1280, 900, dark)
            self.open("2026-03-01 a.html")
            style = "getComputedStyle(document.documentElement).getPropertyValue"
            colour = {n: linear(bytes.fromhex(self.browser.run(f"{style}.call(getComputedStyle(document.documentElement), '--{n}')").strip()[1:]))
                      for n in ("after", "before", "held", "ground", "warn")}
            ground = luminance(colour.pop("ground"))
            for name, c in colour.items():
                light, dim = sorted((luminance(c) + 0.05, ground + 0.05), reverse=True)
                self.assertGreater(light / dim, 3, name)
            for kind in ("protan", "deutan"):
                for a, b in (("after", "before"), ("after", "held")):  # two logs; two contacts
                    distance = sum((p - q) ** 2 for p, q in zip(lab(blind(colour[a], kind)), lab(blind(colour[b], kind)))) ** 0.5
                    self.assertGreater(distance, 20, (dark, kind, a, b))

    def test_nothing_comes_from_elsewhere(self):
        for page in self.out.glob("*.html"):
            text = page.read_text("utf-8")
            self.assertNotIn("http://", text.replace("http://www.w3.org/2000/svg", ""))
            self.assertNotIn("https://", text)


if __name__ == "__main__":
    if missing := chromium.missing():
        print("skipped:", missing)
        sys.exit(77)
    unittest.main()

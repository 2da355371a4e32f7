#!/usr/bin/python3
"""finray_estimate --follow --serve: the live page, its zero button, and clients that are slow, many or malformed.
The parts without a browser run where Chromium is absent too."""

import contextlib
import csv
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
sys.path.insert(0, str(HERE))
import browser as chromium  # noqa: E402

FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
HEADER = "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n"
SCENE = "contacts: 1\n"


class Server:
    """The executable with a port of its own and rows at a rate, free or under a load."""

    def __init__(self, folder, *flags, rows_per_s=500, row_s=None):
        scene = folder / "scene.yaml"
        scene.write_text(SCENE)
        self.out, self.err = open(folder / "rows.csv", "w+"), open(folder / "errors", "w+")
        self.process = subprocess.Popen(
            [BINARIES / "finray_estimate", "--follow", "--finger", FINGER, "--scene", scene, "--serve", "0", *flags],
            stdin=subprocess.PIPE, stdout=self.out, stderr=self.err, text=True)
        self.free, self.ending, self.rows = True, False, 0
        self.process.stdin.write(HEADER)
        self.process.stdin.flush()
        deadline = time.monotonic() + 30
        while not (found := re.search(r"live page +(http://([^/]+)/(\S*))\n", self.errors())):
            if time.monotonic() > deadline or self.process.poll() is not None:
                raise RuntimeError(self.errors())
            time.sleep(0.02)
        self.url, host, self.query = found.groups()
        self.port = int(host.rsplit(":", 1)[1])
        self.thread = threading.Thread(target=self._feed, args=(rows_per_s, row_s or 1 / rows_per_s))
        self.thread.start()

    def _feed(self, rate, row_s):
        with contextlib.suppress(BrokenPipeError):  # a server that was killed
            self._write_rows(rate, row_s)
            self.process.stdin.close()

    def _write_rows(self, rate, row_s):
        start = time.monotonic()
        while not self.ending:
            due = int((time.monotonic() - start) * rate)
            while self.rows < due:
                noise = 1e-4 * (self.rows % 5 - 2)
                volts = [0.002, 0.002, 0.002, 0.002] if self.free else [0.025, 0.034, 0.042, 0.022]
                self.process.stdin.write(f"{self.rows * row_s:.4f}," + ",".join(f"{v + noise:.5f}" for v in volts) + "\n")
                self.rows += 1
            self.process.stdin.flush()
            time.sleep(0.005)

    def errors(self):
        return pathlib.Path(self.err.name).read_text()

    def request(self, method, path, headers=None, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, body=body, headers=headers or {})
        answer = connection.getresponse()
        result = answer.status, answer.read().decode()
        connection.close()
        return result

    def finish(self):
        """Ends the input; returns the exit code and the rows that came out."""
        self.ending = True
        self.thread.join()
        code = self.process.wait(30)
        self.out.close()
        self.err.close()
        return code, len(pathlib.Path(self.out.name).read_text().splitlines()) - 1

    def resident_kB(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def files(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))


class LivePageTest(unittest.TestCase):
    def setUp(self):
        import tempfile
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.server = None

    def tearDown(self):
        if self.server:
            code, rows = self.server.finish()
            self.assertEqual(rows, self.server.rows)  # estimation has missed nothing
            self.assertEqual(code, 0, self.server.errors())
        self.temporary.cleanup()

    def start(self, *flags, **options):
        self.server = Server(self.folder, *flags, **options)
        return self.server

    def test_who_may_see_it(self):
        server = self.start()
        self.assertEqual(server.request("GET", "/")[0], 200)
        for host in ("evil.example", "127.evil.example"):
            self.assertEqual(server.request("GET", "/", {"Host": host})[0], 403)
        self.assertEqual(server.request("POST", "/zero", {"X-Finray": "zero", "Host": "evil.example"}, "")[0], 403)
        self.assertEqual(server.request("POST", "/zero", {}, "")[0], 403)
        self.assertEqual(server.request("GET", "/zero")[0], 404)
        self.assertEqual(server.request("GET", "/../../etc/passwd")[0], 404)
        self.assertIn("name: paper_140mm", server.request("GET", "/finger.yaml")[1])

    def test_what_a_request_costs_is_bounded(self):
        server = self.start()
        page = server.request("GET", "/")[1]
        before = server.resident_kB()
        ranges = {"Range": "bytes=" + ",".join(["0-"] * 2600)}  # of which each is a copy of the page
        answers = []
        clients = [threading.Thread(target=lambda: answers.append(server.request("GET", "/", ranges))) for _ in range(12)]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        self.assertTrue(len(answers) == 12 and set(answers) == {(200, page)})
        with socket.create_connection(("127.0.0.1", server.port), timeout=20) as client:  # headers without end
            with contextlib.suppress(OSError):  # once they are too many
                client.sendall(b"GET / HTTP/1.1\r\n")
                for _ in range(10000):
                    client.sendall(b"X-Filler: 0123456789\r\n" * 1000)  # 220 MB
        self.assertLess(server.resident_kB() - before, 100_000)
        with socket.create_connection(("127.0.0.1", server.port), timeout=20) as client:
            client.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X-Filler: 0\r\n" * 1500 + b"\r\n")
            answer = client.makefile(errors="replace").read()
        self.assertTrue(answer.startswith("HTTP/1.1 400"), answer)
        self.assertIn("at most 16384 bytes", answer)

    def test_a_request_that_comes_byte_by_byte_ends(self):
        server = self.start()
        with socket.create_connection(("127.0.0.1", server.port), timeout=20) as client:
            start = time.monotonic()
            with contextlib.suppress(OSError):
                while time.monotonic() - start < 60:
                    client.sendall(b"G")
                    time.sleep(0.5)
            self.assertLess(time.monotonic() - start, 20)

    def events(self, server, seconds):
        """The events that a page gets which is open for so long: kind and data."""
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
        connection.request("GET", "/events")
        answer, text, end = connection.getresponse(), b"", time.monotonic() + seconds
        while time.monotonic() < end:
            text += answer.read1()
        connection.close()
        events = [event.split("data: ", 1) for event in text.decode().split("\n\n")[:-1]]
        return [(kind.strip().removeprefix("event: "), json.loads(data)) for kind, data in events]

    def test_a_page_that_is_opened_late_gets_the_past(self):
        server = self.start()
        time.sleep(6)
        for _ in range(2):  # and one that is loaded anew
            events = [event for event in self.events(server, 1) if event[0] != "alive"]
            past = [update for kind, updates in events if kind == "past" for update in updates]
            self.assertGreater(len(past), 60)
            rows = [update["rows"] for update in past] + [update["rows"] for kind, update in events if kind == ""]
            self.assertLess(rows[0], 200)  # of the first tenths of a second
            self.assertGreater(rows[-1], len(past))
            self.assertEqual(rows, sorted(set(rows)))

    def test_another_address_needs_the_token(self):
        token = "a-token-of-24-characters"
        server = self.start("--serve_address", "0.0.0.0", "--serve_token", token)
        self.assertEqual(server.query, "?token=" + token)
        for path in ("/", "/events", "/finger.yaml", "/?token=", "/?token=a-token-of-24-characterz"):
            self.assertEqual(server.request("GET", path)[0], 403, path)
        self.assertEqual(server.request("GET", "/?token=" + token)[0], 200)

    def test_flags(self):
        base = [BINARIES / "finray_estimate", "--follow", "--finger", FINGER]
        for flags, words in ((["--serve", "0", "--serve_address", "0.0.0.0"], "needs a --serve_token"),
                             (["--serve", "0", "--serve_token", "secret"],
                              "--serve_token: expected at least 16 letters, digits, - and _, found 6 characters"),
                             (["--serve", "0", "--serve_address", "0.0.0.0", "--serve_token", "short"], "found 5 characters"),
                             (["--serve", "0", "--serve_token="], "found 0 characters"),
                             (["--serve", "0", "--serve_token", "with space and more text"], "letters, digits"),
                             (["--serve", "70000"], "expected a port"), (["--serve_token", "x"], "goes with --serve"),
                             (["--serve", "0", "--serve_rate_Hz", "0"], "expected 0.1 to 1000")):
            done = subprocess.run([*base, *flags], input=HEADER, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertIn(words, done.stderr)
        server = self.start()
        done = subprocess.run([*base, "--serve", str(server.port)], input=HEADER, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("the port is in use", done.stderr)

    def test_zero_is_that_of_finray_zero(self):
        server = self.start()
        self.assertIn("the next 100 rows", server.request("POST", "/zero", {"X-Finray": "zero"}, "")[1])
        deadline = time.monotonic() + 20
        while "Zeroed by 100 rows" not in server.errors() and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertIn("Zeroed by 100 rows; moved by +2", server.errors())
        offsets = re.findall(r"offset_V: ([-\d.e]+)", server.request("GET", "/finger.yaml")[1])
        self.assertEqual(len(offsets), 4)
        for offset in offsets:
            self.assertAlmostEqual(float(offset), 0.002, delta=3e-5)
        time.sleep(0.3)
        server.ending = True
        server.thread.join()
        server.process.wait(30)
        with open(server.out.name, newline="") as file:
            rows = list(csv.DictReader(file))
        for j in range(1, 5):
            self.assertGreater(float(rows[0][f"gauge_{j}_rad"]), 1.5e-3)
            self.assertLess(abs(float(rows[-1][f"gauge_{j}_rad"])), 3e-4)

    def test_slow_many_and_malformed_clients(self):
        server = self.start(rows_per_s=2000)
        sockets = []

        def connect(data=b""):
            try:
                client = socket.create_connection(("127.0.0.1", server.port), timeout=2)
                client.sendall(data)
                sockets.append(client)
            except OSError:
                pass  # it is refused, which is fine

        for _ in range(30):  # they ask for updates and never read
            connect(b"GET /events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        for _ in range(10):  # they never end their request
            connect(b"GET / HT")
        for data in (b"\0\xff" * 2000, b"GET " + b"a" * 100000, b"POST /zero HTTP/1.1\r\nHost: localhost\r\nContent-Length: 999999999\r\n\r\nx",
                     b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: -5\r\n\r\n", b"\r\n\r\n" * 1000,
                     b"GET /events?token=" + b"%" * 3000 + b" HTTP/1.1\r\n\r\n"):
            connect(data)
        time.sleep(3)
        before = server.rows
        self.assertLess(server.files(), 60)
        # Rows go on: the feeder waits for a process that no longer reads. How fast they go on is the machine's.
        deadline = time.monotonic() + 60
        while server.rows - before < 2500:
            self.assertLess(time.monotonic(), deadline, f"{server.rows - before} rows")
            time.sleep(0.05)
        self.assertIsNone(server.process.poll())
        for client in sockets:
            client.close()
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline:
            with contextlib.suppress(OSError):  # full (503) or refused, until the workers find out that their clients have gone
                if server.request("GET", "/")[0] == 200:
                    break
            time.sleep(0.2)
        else:
            self.fail("nobody is served after the clients have gone")

    def test_too_many_pages_are_told_so(self):
        server = self.start()
        streams = []
        for _ in range(8):
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
            connection.request("GET", "/events")
            streams.append((connection, connection.getresponse()))
        self.assertTrue(all(answer.status == 200 for _, answer in streams))
        status, words = server.request("GET", "/events")
        self.assertEqual((status, words[:21]), (503, "8 live pages are open"))
        # Four more that do not end their request: no worker is left.
        stalled = [socket.create_connection(("127.0.0.1", server.port), timeout=10) for _ in range(4)]
        for client in stalled:
            client.sendall(b"GET / HT")
        status, words = server.request("GET", "/")
        self.assertEqual((status, words), (503, "This live page can take no more connections: 12 are open. Close one, then load it again.\n"))
        for client in stalled:
            client.close()
        for connection, answer in streams:
            answer.close()
            connection.close()
        deadline = time.monotonic() + 15
        while True:
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
            connection.request("GET", "/events")
            answer = connection.getresponse()
            status = answer.status
            answer.close()
            connection.close()
            if status == 200 or time.monotonic() > deadline:
                break
            time.sleep(0.2)
        self.assertEqual(status, 200)

    def test_the_end_comes_behind_the_last_row(self):
        for rate in ("0.1", "1000"):
            with self.subTest(rate):
                server = self.start("--serve_rate_Hz", rate)
                connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30)
                connection.request("GET", "/events")
                answer = connection.getresponse()
                time.sleep(0.3)
                self.server = None
                self.assertEqual(server.finish()[0], 0)
                events = answer.read().decode()
                connection.close()
                *updates, end = [e for e in events.split("\n\n") if e and not e.startswith("event: alive")]
                self.assertEqual(end, "event: end\ndata: {}")
                last = json.loads(updates[-1].split("data: ", 1)[1])
                self.assertEqual((last[-1] if isinstance(last, list) else last)["rows"], server.rows)

    def test_page(self):
        if missing := chromium.missing():
            self.skipTest(missing)
        server = self.start()
        with chromium.Browser() as browser:
            browser.window(1280, 900)
            browser.open(server.url)
            browser.wait("finray.then(p => p.logs[0].end > 5)")
            self.assertEqual(browser.run("document.getElementById('connection').textContent"), "live")
            self.assertIn("latency", browser.run("document.getElementById('latency').textContent"))
            self.assertFalse(browser.run("finray.then(p => p.logs[0].shapeAt(p.logs[0].end - 1).places === null)"))
            browser.run("document.getElementById('zero').click()")
            browser.wait("document.getElementById('message').textContent.startsWith('Zeroed by 100 rows')")
            self.server.free = False
            browser.wait("finray.then(p => p.logs[0].value('normal_1_N', p.logs[0].end - 1) > 0.1)")
            cursor = browser.run("finray.then(p => p.view.cursor)")
            browser.wait(f"finray.then(p => p.view.cursor > {cursor})")  # it follows
            first, entries = browser.run("finray.then(p => [p.logs[0].time(p.logs[0].first), p.logs[0].end])")
            browser.open(server.url)  # once more
            browser.wait(f"finray.then(p => p.logs[0].end > {entries})")
            self.assertEqual(browser.run("finray.then(p => p.logs[0].time(p.logs[0].first))"), first)
            self.assertLessEqual(browser.run("finray.then(p => p.logs[0].end)"), entries + 200)  # each update once
            browser.run("finray.then(p => p.scrub(p.view.least))")
            self.assertEqual(browser.run("document.getElementById('follow').getAttribute('aria-pressed')"), "false")
            server.ending = True
            browser.wait("document.getElementById('connection').textContent === 'the input has ended'")
            server.thread.join()
            self.assertEqual(browser.run("finray.then(p => p.logs[0].rows)"), server.rows)
            browser.window(390, 844, phone=True)
            self.assertLessEqual(browser.run("document.documentElement.scrollWidth"), 390)
            self.assertEqual(browser.errors, [])

    def test_page_says_that_its_server_is_lost_or_full(self):
        if missing := chromium.missing():
            self.skipTest(missing)
        server = self.start()
        connection, message = (f"document.getElementById('{name}').textContent" for name in ("connection", "message"))
        with chromium.Browser() as browser:
            browser.window(1280, 900)
            streams = []
            for _ in range(8):
                client = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
                client.request("GET", "/events")
                streams.append((client, client.getresponse()))
            browser.open(server.url)
            browser.wait(f"{connection} === 'refused' && {message}.startsWith('8 live pages are open')")
            for client, answer in streams:
                answer.close()
                client.close()
            browser.wait(f"{connection} === 'live' && {message} === ''")  # by itself
            server.process.send_signal(signal.SIGSTOP)  # the connection stays, and nothing comes
            browser.wait(f"{connection} === 'server lost'")
            server.process.send_signal(signal.SIGCONT)
            browser.wait(f"{connection} === 'live' && {message} === ''")
            server.process.kill()
            browser.wait(f"{connection} === 'server lost'")
            self.assertIn("has not answered since", browser.run(message))
            self.assertEqual(browser.run("document.getElementById('rate').textContent"), "")
            self.assertTrue(browser.run("document.getElementById('zero').disabled"))
        self.server = None
        server.finish()


if __name__ == "__main__":
    unittest.main()

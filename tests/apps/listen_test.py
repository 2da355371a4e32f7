#!/usr/bin/env python3
"""finray_estimate --listen: a session for each client of a socket, and nothing that a client can break."""
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/test")) / "finray_estimate"
FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
HEADER = "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n"
PATIENCE_S = 120  # only a test that fails waits for so long


class Server:
    """The executable, once it listens."""

    def __init__(self, address, *more):
        self.process = subprocess.Popen(
            [BINARY, "--follow", "--finger", FINGER, "--listen", address, *more], cwd=ROOT, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
        self.before = []
        for line in self.process.stderr:
            self.before.append(line)
            if line.startswith("listening"):
                self.address = line.split()[1]
                break

    def connect(self, buffer=None):
        """A client, for whose rows the system keeps so many bytes."""
        if self.address.startswith("unix:"):
            client = socket.socket(socket.AF_UNIX)
            client.connect(self.address[5:])
        else:
            host, port = self.address.rsplit(":", 1)
            client = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
            if buffer:
                client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
            client.connect((host.strip("[]"), int(port)))
        client.settimeout(PATIENCE_S)
        return client

    def ask(self, data):
        """All that a client gets which sends data and no more."""
        with self.connect() as client:
            client.sendall(data if isinstance(data, bytes) else data.encode())
            client.shutdown(socket.SHUT_WR)
            return client.makefile(errors="replace").read()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(PATIENCE_S), self.process.stderr.read()


@contextlib.contextmanager
def serving(address="0", *more):
    server = Server(address, *more)
    try:
        yield server
    finally:
        server.process.kill()
        server.process.wait()
        server.process.stderr.close()


class ListenTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "scene.yaml"
        self.scene.write_text("contacts: 1\n")
        self.log = (ROOT / "datasets/simulated_r15/holdout.csv").read_text().splitlines(keepends=True)[:40]

    def follow(self, text):
        return subprocess.run([BINARY, "--follow", "--finger", FINGER, "--scene", self.scene], cwd=ROOT, input=text,
                              capture_output=True, text=True, check=True).stdout

    def test_rows_are_those_of_standard_input(self):
        text = "".join(self.log)
        expected = self.follow(text)
        path = f"unix:{self.folder}/socket"
        for address in ("0", "127.0.0.1:0", path):
            with serving(address, "--scene", self.scene) as server:
                self.assertEqual(server.ask(text), expected)
                self.assertEqual(server.stop()[0], 0)
        self.assertFalse((self.folder / "socket").exists())

    def test_each_client_has_a_session(self):
        with serving("0", "--scene", self.scene) as server:
            clients = [server.connect() for _ in range(3)]
            files = [client.makefile("rw") for client in clients]
            alone = self.follow("".join(self.log)).splitlines(keepends=True)
            # One row of each client after the other.
            for line, row in zip(self.log, alone):
                for file in files:
                    file.write(line)
                    file.flush()
                    self.assertEqual(file.readline(), row)
            for number, (client, file) in enumerate(zip(clients, files), 1):
                client.shutdown(socket.SHUT_WR)
                self.assertEqual(file.read(), "", f"client {number}")
                file.close()
                client.close()

    def test_malformed_clients_are_harmless(self):
        hostile = {
            "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n": "# error: client 2: no column 'gauge_1_V'",
            "": "# error: client 3: is empty, expected a header and rows\n",
            "gauge_1_V,gauge_1_V\n": "# error: client 4:1:2: header 'gauge_1_V' appears twice\n",
            b"\x00\xff\xfe" * 5000 + b"\n": "# error: client 5:",
            b"x" * (17 << 20): "",  # longer than a line may be; the connection may be cut before it is sent
        }
        with serving("0", "--scene", self.scene) as server:
            with server.connect() as good, good.makefile("rw") as file:
                file.write(HEADER)
                file.flush()
                self.assertTrue(file.readline().startswith("time_s,gauge_1_V,"))
                for data, answer in hostile.items():
                    with contextlib.suppress(ConnectionError):
                        found = server.ask(data)
                        self.assertTrue(found.startswith(answer), (data[:40], found))
                        self.assertLessEqual(found.count("\n"), 1)
                with server.connect() as gone:  # in the middle of a row
                    gone.sendall(HEADER.encode() + b"1,0.0")
                    gone.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")  # by RST
                for line, status in (("1,oops,0,0,0\n", "bad_input"), ("2,0,0,0,0\n", "no_contact")):
                    file.write(line)
                    file.flush()
                    self.assertEqual(file.readline().rstrip().rsplit(",", 1)[1], status)
            code, errors = server.stop()
            self.assertEqual(code, 0)
            self.assertIn("finray_estimate: client 1:2:2: gauge_1_V: expected a number, found 'oops'\n", errors)

    def test_lines_of_a_session_stand_together_and_name_it(self):
        self.scene.write_text("contacts: 1\nsearch_iteration_limit: 30\n")
        # No contact makes gauges read so, and a line of each client is bad.
        rows = "".join(f"{i},0.2,-0.2,{0.1 + 0.01 * i},0.2\n" for i in range(40)) + "x\n"
        numbers = range(1, 9)
        with serving("0", "--scene", self.scene) as server:
            with contextlib.ExitStack() as stack:
                clients = []
                for number in numbers:  # one after the other, so that names are known
                    client = stack.enter_context(server.connect())
                    client.sendall(HEADER.encode())
                    file = stack.enter_context(client.makefile("rw"))
                    file.readline()
                    clients.append((client, file))
                for client, _ in clients:
                    client.sendall(rows.encode())
                for client, _ in clients:
                    client.shutdown(socket.SHUT_WR)
                for _, file in clients:
                    found = file.read().splitlines()
                    self.assertEqual((len(found), found[-1].rsplit(",", 1)[1]), (41, "bad_input"))
            code, errors = server.stop()
        self.assertEqual(code, 0)
        lines = errors.splitlines()
        for number in numbers:
            self.assertIn(f"finray_estimate: client {number}:42: ", errors)
            at = next(i for i, line in enumerate(lines) if line.startswith(f"client {number}  "))
            self.assertRegex(lines[at], rf"^client {number}       p50 \S+ us, .* over 41 frames$")
            self.assertRegex(lines[at + 1], rf"^client {number} searches \d+ ended by the scene's limit of 30$")
            self.assertRegex(lines[at + 2], rf"^warning: .* of client {number} .*; \S")
        kinds = ("finray_estimate: client ", "client ", "warning: ")
        self.assertEqual([line for line in lines if not line.startswith(kinds)], [])

    def test_no_more_clients_than_sixteen(self):
        with serving("0", "--scene", self.scene) as server:
            clients = [server.connect() for _ in range(17)]
            with clients[16].makefile() as refused:
                self.assertEqual(refused.read(), "# error: 16 clients are connected, which is the most\n")
            clients[0].sendall(HEADER.encode() + b"1,0,0,0,0\n")
            with clients[0].makefile() as file:
                file.readline()
                self.assertTrue(file.readline().startswith("1,"))
            for client in clients:
                client.close()
            self.assertEqual(server.stop()[0], 0)

    def test_silent_clients_make_room(self):
        with serving("0", "--scene", self.scene) as server:
            with contextlib.ExitStack() as stack:
                follower = stack.enter_context(server.connect())  # says nothing either, but for its header
                follower.sendall(HEADER.encode())
                follower_file = stack.enter_context(follower.makefile("rw"))
                follower_file.readline()
                silent = [stack.enter_context(server.connect()) for _ in range(15)]
                silent[1].sendall(b"time_s,gauge_1_V")  # a header that does not end
                self.assertIn("16 clients are connected", server.ask(HEADER))
                time.sleep(6)
                self.assertEqual(len(server.ask("".join(self.log)).splitlines()), len(self.log))
                self.assertRegex(silent[0].makefile().read(),
                                 r"^# error: client 2: silent for \d+ s, and another client needs the place\n$")
                follower_file.write("1,0,0,0,0\n")
                follower_file.flush()
                self.assertTrue(follower_file.readline().startswith("1,"))
            self.assertEqual(server.stop()[0], 0)

    def long_rows(self, count):
        note = "x" * 1000
        return HEADER.strip() + ",note\n" + "".join(f"{i},0,0,0,0,{note}\n" for i in range(count))

    def check_rows(self, answer, count):
        """So many rows of the log above, each of them whole."""
        header, *rows = answer.splitlines(keepends=True)
        columns = header.count(",")
        for i, row in enumerate(rows[:count]):
            self.assertEqual((row.split(",", 1)[0], row.count(","), row[-1]), (str(i), columns, "\n"))
        return rows[count:]

    def test_a_client_may_write_all_before_it_reads(self):
        count = 8000  # 10 MB of rows, more than the system takes
        with serving("0", "--scene", self.scene) as server, server.connect(1 << 16) as client:
            client.sendall(self.long_rows(count).encode())
            client.shutdown(socket.SHUT_WR)
            time.sleep(12)
            self.assertEqual(self.check_rows(client.makefile().read(), count), [])
            self.assertEqual(server.stop()[0], 0)

    def test_a_client_that_never_reads_is_told_so(self):
        with serving("0", "--scene", self.scene) as server, server.connect() as client:
            start = time.monotonic()
            client.sendall(self.long_rows(40000).encode())
            client.shutdown(socket.SHUT_WR)
            self.assertLess(time.monotonic() - start, 60)
            header, *rows, last = client.makefile().read().splitlines(keepends=True)
            self.assertEqual(last, "# error: client 1: 4 MiB of rows and 8 MiB of lines wait, as it writes and does not read; "
                                   "expected a client that reads while it writes\n")
            self.assertEqual({row.count(",") for row in rows}, {header.count(",")})
            self.assertGreater(len(rows), 4000)
            status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text()
            self.assertLess(int(re.search(r"VmHWM:\s+(\d+)", status)[1]), 120_000)
            self.assertEqual(server.stop()[0], 0)

    def test_lines_are_whole_when_the_server_stops(self):
        with serving("0", "--scene", self.scene) as server, server.connect(1 << 16) as client:
            client.sendall(self.long_rows(10000).encode())
            time.sleep(2)
            self.assertEqual(server.stop()[0], 0)
            answer = client.makefile().read()
            self.check_rows(answer, 10000)
            self.assertEqual(answer[-1], "\n")

    def test_tables_are_those_of_the_server(self):
        def cpu_s():
            fields = pathlib.Path(f"/proc/{server.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        with serving("0") as server:
            before = cpu_s()
            for _ in range(30):
                self.assertIn("no_contact", server.ask(HEADER + "1,0,0,0,0\n"))
            self.assertLess(cpu_s() - before, 0.6)  # of 30 clients
            self.assertEqual(server.stop()[0], 0)

    def test_a_client_that_does_not_read_ends_with_the_server(self):
        with serving("0", "--scene", self.scene) as server:
            with server.connect() as client:
                client.setblocking(False)
                client.send(HEADER.encode())
                with contextlib.suppress(BlockingIOError):
                    for _ in range(20):
                        client.send(b"1,0,0,0,0\n" * 2000)
                self.assertEqual(server.stop()[0], 0)

    def test_a_path_that_is_served_or_no_socket_is_left_alone(self):
        path = self.folder / "socket"
        with serving(f"unix:{path}") as server:
            self.assertEqual(path.stat().st_mode & 0o777, 0o600)
            self.assertEqual(self.run_for_error(f"unix:{path}"),
                             (2, f"finray_estimate: cannot listen at unix:{path}: another process serves it\n"))
            self.assertIn("time_s", server.ask(HEADER))
            server.process.kill()  # it leaves its path behind
            server.process.wait()
        with serving(f"unix:{path}") as server:
            self.assertIn("time_s", server.ask(HEADER))
        path.unlink()
        path.write_text("mine")
        self.assertEqual(self.run_for_error(f"unix:{path}"),
                         (2, f"finray_estimate: cannot listen at unix:{path}: the path is there and is no socket\n"))
        self.assertEqual(path.read_text(), "mine")

    def run_for_error(self, address, *more):
        ended = subprocess.run([BINARY, "--follow", "--finger", FINGER, "--listen", address, *more], cwd=ROOT,
                               capture_output=True, text=True, timeout=PATIENCE_S)
        return ended.returncode, ended.stderr

    def test_wrong_use(self):
        for address in ("eighty", "127.0.0.1:", ":80", "127.0.0.1:70000", "127.0.0.1:-1"):
            code, error = self.run_for_error(address)
            self.assertEqual((code, f"found '{address}'" in error), (1, True), error)
        self.assertEqual(self.run_for_error("unix:" + "x" * 200)[0], 1)
        for flag in ("--strict", "--serve=0", "--most_unexplained_percent=1"):
            code, error = self.run_for_error("0", flag)
            self.assertEqual(code, 1)
            self.assertIn(f"{flag.split('=')[0]} does not go with --listen", error)

    def test_an_address_for_others_is_warned_of(self):
        with serving("0.0.0.0:0") as server:
            self.assertTrue(any("other machines reach 0.0.0.0:" in line for line in server.before), server.before)


if __name__ == "__main__":
    unittest.main()

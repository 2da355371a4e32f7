#!/usr/bin/env python3
"""scripts/check_names: what it sees, in a clone and elsewhere."""
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = "namespace finray {{\nnamespace {{\n\n{}\n\n}}  // namespace\n}}  // namespace finray\n"


class CheckNamesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)

    def check(self, a, b, folder="room", b_file="b.cc"):
        """What the script prints of two sources of a folder."""
        (self.tree / folder).mkdir(parents=True, exist_ok=True)
        (self.tree / folder / "a.cc").write_text(SOURCE.format(a))
        (self.tree / folder / b_file).write_text(b if b_file.endswith(".h") else SOURCE.format(b))
        done = subprocess.run([ROOT / "scripts/check_names", self.tree], capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 1 if done.stdout else 0)
        return done.stdout.splitlines()

    def test_every_declarator_is_seen(self):
        for first in ("double a, b_mm;", "double a = 1, b_mm = 2;", "double a = F(1, 2), b_mm{3}, c;", "double* a, *b_mm;",
                      "constexpr double kA[] = {1, 2}, b_mm[2][2] = {{1, 2}, {3, 4}};", "std::map<int, int> a, b_mm;",
                      "const auto kF = [](int a, int c) { return a; };\nint b_mm;",
                      "void F(int a) {\n  int c, d;\n}\nint a, b_mm;", "template <typename T>\nT a, b_mm;",
                      'const char kA[] = "{(", b_mm[] = "x"; // {', "enum E { kA, b_mm };", "using b_mm = int;",
                      "struct b_mm {\n  int a;\n};"):
            self.assertEqual(self.check(first, "double b_mm, a_N;"), ["room: b_mm is in a.cc, b.cc"], first)

    def test_values_parameters_and_members_are_no_names(self):
        for first in ("double a = b_mm, c = F(b_mm);", "double a[] = {b_mm, b_mm};", "void F(int a, int b_mm) {\n  int c, b_mm;\n}",
                      "struct A {\n  double a, b_mm;\n};", "void F(int a, int b_mm);", "// double b_mm;",
                      "bool operator==(A a, A b_mm) {\n  return true;\n}"):
            self.assertEqual(self.check(first, "double b_mm;"), [], first)

    def test_functions_clash_by_their_parameters(self):
        self.assertEqual(self.check("int Of(int a) {\n}", "int Of(double a) {\n}"), [])
        self.assertEqual(self.check("int Of(int a) {\n}", "int Of(int b) {\n}"), ["room: Of is in a.cc, b.cc"])
        self.assertEqual(self.check("int Of(int a) {\n}", "int G, Of;"), ["room: Of is in a.cc, b.cc"])

    def test_a_type_of_a_header_is_hidden(self):
        self.assertEqual(self.check("int Of(int a) {\n}", "struct Of {\n};\n", b_file="b.h"), ["room: Of is in a.cc, b.h"])

    def test_executables_and_builds_do_not_count(self):
        self.assertEqual(self.check("int a;", "int a;", "apps"), [])
        self.assertEqual(self.check("int a;", "int a;", "build/generated"), ["build/generated: a is in a.cc, b.cc"])
        (self.tree / "build/CMakeCache.txt").touch()
        self.assertEqual(self.check("int a;", "int a;", "build/generated"), [])

    def test_in_a_clone_git_says_which_are_sources(self):
        subprocess.run(["git", "init", "-q", self.tree], check=True)
        self.assertEqual(self.check("int a;", "int a;"), [])
        subprocess.run(["git", "add", "."], cwd=self.tree, check=True)
        self.assertEqual(self.check("int a;", "int a;"), ["room: a is in a.cc, b.cc"])


if __name__ == "__main__":
    unittest.main()

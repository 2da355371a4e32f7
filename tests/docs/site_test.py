#!/usr/bin/python3
"""scripts/docs_site: it builds strictly, and every link and anchor of its pages leads somewhere."""
import html.parser
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/site"))
import pages  # noqa: E402

NEEDS = ["/usr/bin/mkdocs", "/usr/bin/doxygen", "/usr/share/doxygen-awesome-css", "/usr/lib/python3/dist-packages/mkdocstrings"]


class Links(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.ids, self.links = set(), set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.ids.update(attributes[name] for name in ("id", "name") if attributes.get(name))
        target = attributes.get("href") or attributes.get("src")
        if target and tag in ("a", "img", "link", "script"):
            self.links.add(target)


class SiteTest(unittest.TestCase):
    def test_site(self):
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name) / "site"
            built = subprocess.run([ROOT / "scripts/docs_site", out], capture_output=True, text=True)
            self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
            self.check_links(out)
            index = json.loads((out / "search/search_index.json").read_text())
            places = {entry["location"].split("#")[0] for entry in index["docs"]}
            for page in [*(ROOT / "docs").rglob("*.md"), ROOT / "CHANGELOG.md"]:
                place = str(page.relative_to(ROOT).with_suffix(".html")).replace("README.html", "index.html")
                self.assertTrue((out / place).exists(), place)
                self.assertIn(place, places)
            self.assertIn("LiveEstimator", (out / "api/cpp/annotated.html").read_text())
            self.assertIn("LiveEstimator", (out / "api/cpp.html").read_text())
            python = (out / "api/python.html").read_text()
            for name in ("Live", "calibrate", "simulate", "reconstruct", "plot_finger", "InputError"):
                self.assertRegex(python, rf'id="finray\.\w+\.{name}"', name)
            self.assertTrue((out / pages.MARKER).is_file())

    def test_a_site_takes_the_place_of_an_earlier_one_and_of_nothing_else(self):
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name) / "site"
            pages.empty(out)
            (out / "page.html").write_text("of an earlier site")
            pages.empty(out)
            self.assertEqual([path.name for path in out.iterdir()], [pages.MARKER])
            # Another's site.
            (out / pages.MARKER).unlink()
            (out / "sitemap.xml").write_text("")
            refused = subprocess.run([ROOT / "scripts/docs_site", out], capture_output=True, text=True)
            self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))
            self.assertIn("not marked as an earlier site", refused.stderr)
            self.assertEqual([path.name for path in out.iterdir()], ["sitemap.xml"])

    def check_links(self, out):
        links_of = {path: Links(path) for path in out.rglob("*.html") if "api/cpp/" not in str(path)}
        self.assertGreater(len(links_of), 60)
        lost = []
        for path, page in links_of.items():
            if path.name == "404.html":
                continue
            for link in page.links:
                parts = urllib.parse.urlsplit(link)
                if parts.scheme or parts.netloc:
                    continue
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                target = target / "index.html" if target.is_dir() else target
                if not target.exists():
                    lost.append(f"{path.relative_to(out)}: {link}")
                elif parts.fragment and target in links_of and urllib.parse.unquote(parts.fragment) not in links_of[target].ids:
                    lost.append(f"{path.relative_to(out)}: {link}: no such anchor")
        self.assertEqual(lost, [])


if __name__ == "__main__":
    if not all(pathlib.Path(path).exists() for path in NEEDS):
        print("skipped: scripts/install_dependencies site")
        sys.exit(77)
    unittest.main()

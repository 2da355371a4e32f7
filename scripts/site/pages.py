"""Copies the pages of the repository for mkdocs: Markdown as GitHub reads it becomes Markdown as Python-Markdown does.

Pages keep their paths, so links between them hold. Sources that they link to are copied beside them.
"""

import pathlib
import re
import shutil

MARKER = ".finray_docs_site"  # in folders that a run may delete
FENCE = re.compile(r"^\s*(```|~~~)")
ITEM = re.compile(r"^(\s*)([-*+]|\d+[.)])\s")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)")
# Links may lead to files with these endings, beside pages.
SOURCE_SUFFIXES = {".h", ".cc", ".py", ".yaml", ".txt", ".pyi", ".json", ".cmake", ".in"}


def spaced(text):
    """Blank lines before lists and tables, and nested items by four spaces."""
    out, fenced, before = [], False, ""
    for line in text.splitlines():
        if FENCE.match(line):
            if not fenced and before.strip() and not ITEM.match(before):
                out.append("")
            fenced = not fenced
        elif not fenced:
            item = ITEM.match(line)
            if item and len(item[1]) in (2, 3):
                line = "    " + line.lstrip()
            starts_list = item and not item[1] and before.strip() and not ITEM.match(before) and not before.startswith(" ")
            starts_table = line.startswith("|") and before.strip() and not before.startswith("|")
            if starts_list or starts_table:
                out.append("")
        out.append(line)
        before = line
    return "\n".join(out) + "\n"


def source_page(path):
    """A source file as a page."""
    kind = {".h": "cpp", ".cc": "cpp", ".py": "python", ".pyi": "python", ".yaml": "yaml"}.get(path.suffix, "")
    text = path.read_text(encoding="utf-8")
    return f"# {path.name}\n\n~~~~{kind}\n{text}~~~~\n"


class Pages:
    """Pages of `root` in `out`, and the sources that they link to."""

    def __init__(self, root, out):
        self.root, self.out, self.sources, self.lost = root, out, set(), []

    def copy(self, names):
        for name in names:
            source, target = self.root / name, self.out / name
            target.parent.mkdir(parents=True, exist_ok=True)
            text = LINK.sub(lambda link, source=source: self._link(source, link), source.read_text(encoding="utf-8"))
            target.write_text(spaced(text), encoding="utf-8")
        for path in sorted(self.sources):
            target = self.out / path.relative_to(self.root)
            target.parent.mkdir(parents=True, exist_ok=True)
            if path.suffix in SOURCE_SUFFIXES:
                target.with_name(target.name + ".md").write_text(source_page(path), encoding="utf-8")
            else:
                shutil.copy(path, target)

    def _link(self, page, link):
        mark, words, target = link.groups()
        name, _, anchor = target.partition("#")
        if not name or re.match(r"[a-z]+:", target):
            return link[0]
        path = (page.parent / name).resolve()
        if path.suffix == ".md" and path.exists():
            return link[0]
        if path.is_file() and self.root in path.parents:
            self.sources.add(path)
            return f"{mark}[{words}]({name}.md)" if path.suffix in SOURCE_SUFFIXES else link[0]
        if path.is_dir():
            readme = path / "README.md"
            return f"[{words}]({name.rstrip('/')}/README.md)" if readme.exists() else words
        if path.is_file() or not path.exists():
            self.lost.append(f"{page.relative_to(self.root)}: {target}")
        return words


def titles_of(shelf):
    """Pages of a shelf in the order of docs/README.md's table: (title, path)."""
    return re.findall(r"^\| \[([^\]]+)\]\(([^)]+\.md)\)", shelf, re.M)


def first_heading(path):
    return next(line[2:].strip() for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("# "))


def navigation(root):
    """The shelves of docs/README.md, decisions and both APIs, as mkdocs wants its nav."""
    overview = (root / "docs/README.md").read_text(encoding="utf-8")
    nav = [{"Home": "README.md"}, {"Documents": "docs/README.md"}]
    for shelf, text in re.findall(r"^## (Guides|Reference|Evidence)\n([\s\S]*?)(?=^## |\Z)", overview, re.M):
        nav.append({shelf: [{first_heading(root / "docs" / path): f"docs/{path}"} for _, path in titles_of(text)]})
    nav.append({"API": [{"C++": "api/cpp.md"}, {"Python": "api/python.md"}, {"ROS 2 nodes": "examples/ros2/README.md"}]})
    nav.append({"Decisions": [{"Overview": "docs/decisions/README.md"}] +
                [{first_heading(path): str(path.relative_to(root))} for path in sorted((root / "docs/decisions").glob("0*.md"))]})
    nav.append({"Project": [{"Changes": "CHANGELOG.md"}, {"Contributing": "CONTRIBUTING.md"}] +
                [{first_heading(path): str(path.relative_to(root))} for path in sorted((root / "datasets").glob("*/README.md"))]})
    return nav


def named_pages(root):
    """All pages of the site, as paths from the root."""
    return ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "examples/ros2/README.md",
            *(str(path.relative_to(root)) for folder in ("docs", "datasets") for path in sorted((root / folder).rglob("*.md")))]


def empty(folder):
    """Leaves a marker in a folder that has nothing else, once it is sure that only an earlier site is lost."""
    folder = pathlib.Path(folder)
    if folder.exists() and any(folder.iterdir()) and not (folder / MARKER).is_file():
        raise SystemExit(f"docs_site: {folder}: is not empty and not marked as an earlier site (no file {MARKER} in it); "
                         "choose another folder")
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    (folder / MARKER).write_text("scripts/docs_site deletes this folder when it runs again.\n")  # mkdocs leaves hidden files

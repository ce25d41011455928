"""The repository and its documents: files at the top level, number of decision pages, references."""

import re
import subprocess
from pathlib import Path

import pytest

from benchmarks.all import PAGE, page

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs" / "decisions").glob("*.md"))
TEXTS = (".py", ".md", ".toml", ".yml", ".yaml", ".html", ".js", ".typ", ".css", ".txt", ".json")
NAMED = re.compile(r"decisions/(\d{3}(?:-[\w-]+)?)|\b[Dd]ecisions? \[?(\d{3})\b|\[(\d{3})\]\(")

OLDER = re.compile(r"`([0-9a-f]{8}:benchmarks/\w+\.py)`")


def files():
    """Return the files of the repository that Git tracks or would add."""
    listed = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    return [ROOT / name for name in names if name and (ROOT / name).is_file()]


def references():
    """Yield file and decision page, `001` or `001-name`, for each mention of one."""
    for path in files():
        if path.suffix in TEXTS or path.is_relative_to(ROOT / ".ci"):
            for found in NAMED.finditer(path.read_text(encoding="utf-8")):
                yield path.relative_to(ROOT), next(filter(None, found.groups()))


def test_the_top_level_is_short():
    top = {path.relative_to(ROOT).parts[0] for path in files()}
    assert {name for name in top if not name.startswith(".")} == {
        *("pyproject.toml", "constraints.txt", "mkdocs.yml", "README.md"),
        *("app", "templates", "cad", "tests", "docs", "benchmarks"),
    }
    assert {name for name in top if name.startswith(".")} <= {".ci", ".gitignore", ".github", ".dockerignore"}


def test_decisions_are_few():
    assert 0 < len(PAGES) <= 25


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_decision_is_short(page):
    assert len(page.read_text(encoding="utf-8").split()) <= 400


def test_every_reference_to_a_decision_finds_its_page():
    there = {page.stem for page in PAGES} | {page.stem[:3] for page in PAGES}
    mentioned = list(references())
    assert len(mentioned) > 20
    assert [(str(path), name) for path, name in mentioned if name not in there] == []


def test_every_benchmark_that_is_named_can_be_run():
    named = {(path, name) for path in files() if path.suffix in TEXTS for name in scripts(path)}
    assert len(named) > 20
    missing = [name for _, name in named if not exists(name)]
    assert missing == []


def scripts(path):
    """Yield the name of each benchmark that a file says how to run."""
    yield from re.findall(r"python -m (benchmarks[.\w]*\w)", path.read_text(encoding="utf-8"))


def exists(name):
    """Return whether a module or package of this dotted name is in the repository."""
    place = ROOT / name.replace(".", "/")
    return place.with_suffix(".py").is_file() or (place / "__main__.py").is_file()


def test_every_script_of_an_older_commit_is_in_the_history():
    named = {
        old for path in files() if path.suffix in TEXTS for old in OLDER.findall(path.read_text("utf-8"))
    }
    assert len(named) > 10
    count = ["git", "rev-list", "--count", "HEAD"]
    if int(subprocess.run(count, cwd=ROOT, capture_output=True, text=True).stdout or 0) < 100:
        pytest.skip("a copy without the history")
    for old in named:
        subprocess.run(["git", "cat-file", "-e", old], cwd=ROOT, check=True)


def test_the_page_of_costs_shows_the_run_that_is_kept():
    text = PAGE.read_text(encoding="utf-8")
    assert text == page(text)

"""Documents hold together: few decision pages, no reference to a missing one, one age of each cost."""

import re
import subprocess
from pathlib import Path

import pytest

from benchmarks.all import table

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs" / "decisions").glob("*.md"))
TEXTS = (".py", ".md", ".toml", ".yml", ".yaml", ".html", ".js", ".typ", ".css", ".txt", ".json")
NAMED = re.compile(r"decisions/(\d{3}(?:-[\w-]+)?)|\b[Dd]ecisions? \[?(\d{3})\b|\[(\d{3})\]\(")


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


def test_the_page_of_costs_shows_the_run_that_is_kept():
    page = (ROOT / "docs" / "costs.md").read_text(encoding="utf-8")
    assert table() in page

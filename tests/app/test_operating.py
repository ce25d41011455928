"""The operator's pages are right: settings, unit, links, licences, the bill of materials, the lock."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from app.settings import Settings
from benchmarks import settings_page, supply_chain

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = (*DOCS.glob("*.md"), *DOCS.glob("operating/*.md"), *DOCS.glob("howto/*.md"), ROOT / "README.md")
GENERATED = {
    "templates/*_v*.md": "templates/*/{}.py",
    "models/*_v*.md": "cad/models/{}.py",
    "notebooks/*.md": "docs/notebooks/{}.py",
    "*/index.md": "mkdocs.yml",
    "reference/*.md": "mkdocs.yml",
}
"""Pages that the build of the site writes, and from what; `mkdocs build --strict` checks their links."""
LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")


def test_the_page_of_settings_is_current():
    assert settings_page.PAGE.read_text() == settings_page.page(), "run python -m benchmarks.settings_page"


def test_every_setting_has_its_line():
    page = settings_page.page()
    for name in Settings.model_fields:
        assert f"| `CRANKWRIGHT_{name.upper()}` | " in page


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_between_pages_lead_somewhere(page):
    for link in LINK.findall(page.read_text()):
        target = page.parent / link
        assert target.exists() or (page.is_relative_to(DOCS) and is_generated(target)), link


def is_generated(target):
    """Whether the build of the site writes this page, from a file that exists."""
    place = target.resolve().relative_to(DOCS)
    sources = (source for pattern, source in GENERATED.items() if place.match(pattern))
    return any(list(ROOT.glob(source.format(place.stem))) for source in sources)


@pytest.mark.skipif(not shutil.which("systemd-analyze"), reason="systemd is not installed")
def test_the_unit_is_one(tmp_path):
    text = (ROOT / "docs" / "operating" / "crankwright.service").read_text()
    unit = tmp_path / "crankwright.service"
    unit.write_text(text.replace("/opt/crankwright/bin/crankwright", shutil.which("true")))
    checked = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", str(unit)], capture_output=True, text=True, check=False
    )
    assert (checked.returncode, checked.stderr) == (0, "")


def test_licences_cover_every_pinned_distribution():
    rows = re.findall(
        r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \|", supply_chain.LICENCES.read_text(), re.MULTILINE
    )
    listed = {name: (version, licence) for name, version, licence in rows[1:]}
    assert {name: version for name, (version, _) in listed.items()} == supply_chain.pins()
    assert [name for name, (_, licence) in listed.items() if licence == "not stated"] == []


def test_the_bill_of_materials_covers_every_pinned_distribution():
    bill = json.loads(supply_chain.BILL.read_text())
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.6")
    assert {one["name"]: one["version"] for one in bill["components"]} == supply_chain.pins()
    references = {one["bom-ref"] for one in bill["components"]} | {"crankwright"}
    assert len(references) == len(bill["components"]) + 1
    assert {one["ref"] for one in bill["dependencies"]} == references
    assert all(set(one["dependsOn"]) <= references for one in bill["dependencies"])
    assert supply_chain.BILL.stat().st_size < 2**20


def test_the_lock_pins_what_the_constraints_pin():
    lines = [line for line in supply_chain.LOCK.read_text().splitlines() if not line.startswith("#")]
    pinned = dict(line.partition(" ")[0].split("==") for line in lines)
    assert pinned == supply_chain.pins()
    assert len(supply_chain.locked()) == len(lines)
    assert "://" not in supply_chain.LOCK.read_text()


def test_the_constraints_hold_names_and_versions_only():
    for line in supply_chain.CONSTRAINTS.read_text().splitlines():
        assert re.fullmatch(r"[\w.-]+==[\w.+]+", line), line

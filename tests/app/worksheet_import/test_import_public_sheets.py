"""Public sheets in the folder of CRANKWRIGHT_MATHCAD_SHEETS; none is in this repository."""

import os
from pathlib import Path

import pytest

from app.worksheets.imports.job import imported
from templates.core.sheets import read

FOLDER = os.environ.get("CRANKWRIGHT_MATHCAD_SHEETS", "")
SHEETS = sorted(Path(FOLDER).rglob("*.mcdx")) if FOLDER else []

pytestmark = pytest.mark.skipif(
    not SHEETS, reason="set CRANKWRIGHT_MATHCAD_SHEETS to a folder of public .mcdx files to test with them"
)


@pytest.fixture(scope="module")
def records():
    sheets = {path: imported(path.read_bytes(), path.stem) for path in SHEETS}
    for one in sheets.values():
        read(one.text)
    return [
        [region for region in one.record["regions"] if region["is_mathematical"]] for one in sheets.values()
    ]


def test_at_least_27_of_35_have_half_of_their_mathematical_regions_translated(records):
    translated = [
        sum(one["state"] in ("verified", "unverified", "differs", "shown") for one in sheet)
        for sheet in records
    ]
    halves = sum(2 * count >= len(sheet) for count, sheet in zip(translated, records, strict=True))
    assert halves * 35 >= 27 * len(records)


def test_95_percent_of_the_compared_results_agree(records):
    states = [one["state"] for sheet in records for one in sheet]
    verified, differ = states.count("verified"), states.count("differs")
    assert verified >= 0.95 * (verified + differ)


def test_every_refusal_has_a_reason_and_every_blocked_region_names_another(records):
    for sheet in records:
        for region in sheet:
            assert region["state"] != "refused" or (region["reason"] and region["remedy"] and region["lines"])
            assert region["state"] != "blocked" or region["blocked_by"]

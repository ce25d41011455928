"""Table cells show short arrays in full, and long ones by range, its positions and a sparkline."""

import re

import pytest
from browsing import from_example
from playwright.sync_api import expect

from app.presentation.environment import course

WAVE = [float((7 * n) % 31) for n in range(31)]


def test_a_course_has_its_ends_their_places_and_gaps():
    shown = course([None, *WAVE], [float(10 * n) for n in range(32)], "deg")
    assert (shown.ends, shown.count) == ("0 … 30", "32 values")
    assert shown.where == "least at 10 °, largest at 230 °"
    assert course(WAVE).where == "least no. 1, largest no. 23"
    assert shown.path.startswith("M3.9,23.0")
    assert course([*WAVE[:10], None, *WAVE[10:]]).path.count("M") == 2
    for other in (WAVE[:20], [[1.0] * 30], 3.0, None, [None] * 40, ["a"] * 40):
        assert course(other) is None
    assert "M0.0,12.0" in course([2.0] * 25).path


@pytest.mark.parametrize(
    "template", ["torsional_vibration/1", pytest.param("bearing_load/1", marks=pytest.mark.slow)]
)
def test_the_browser_writes_arrays_as_the_server_does(watched, http, template):
    place = from_example(http, template)
    name = template.partition("/")[0]
    watched.open(f"/templates/{template}", wait_until="networkidle")
    page = watched.page
    rows = page.locator("[data-output] td.text")
    expect(rows.first).to_be_attached()
    assert page.locator("[data-output] .where").count() > 0 or name == "torsional_vibration"
    shown = rows.evaluate_all("(cells) => cells.map((cell) => cell.innerHTML)")
    written = re.findall(r'<td class="value text"[^>]*>(.*?)</td>', http.get(f"/templates/{template}").text)
    plain = [" ".join(re.sub(r"<(?!path)[^>]*>|/>|>", " ", text).split()) for text in shown]
    expected = [" ".join(re.sub(r"<(?!path)[^>]*>|/>|>", " ", text).split()) for text in written]
    assert [text.replace("</path", "") for text in plain] == expected
    assert place
    assert watched.faults() == []


def test_natural_frequencies_are_readable_in_page_comparison_and_report(http):
    place = from_example(http, "torsional_vibration/1")
    step = http.get(f"/api/v1{place}/revisions/1").json()["steps"]["torsional_vibration"]
    frequencies = step["outputs"]["natural_frequencies"]["value"]
    wanted = ", ".join(f"{value:.5g}" for value in frequencies[1:3])
    used = step["inputs"]["inertias"]
    heavier = {"value": [2 * value for value in used["value"]], "unit": used["unit"]}
    patch = {"steps": {"torsional_vibration": {"inputs": {"inertias": heavier}}}}
    headers = {"If-Match": '"1"', "Prefer": "wait=30"}
    http.patch(f"/api/v1{place}", json=patch, headers=headers).raise_for_status()
    for path in (
        f"/api/v1{place}/revisions/1/report.html",
        f"{place}/revisions/1",
        f"{place}/revisions/2?with=1",
    ):
        assert wanted in http.get(path).text, path

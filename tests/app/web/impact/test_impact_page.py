"""The pages of a version's impact and of upgrades work without scripts and in a browser."""

import re

import pytest
from patience import patient, until
from serving import API, created

INPUTS = {
    "radial_load": "25 kN", "diametral_clearance": "0.055 mm", "bearing_diameter": "48 mm",
    "bearing_width": "18 mm", "speed": "5000 rpm", "oil_inlet_temperature": "80 degC",
    "oil_outlet_temperature": "87.762 degC",
}  # fmt: skip
PAGE = "/templates/oil_film/2/impact"
FORM = re.compile(r'<form method="post" action="(/designs/[^"]+/upgrade)">(.*?)</form>', re.DOTALL)
HIDDEN = re.compile(r'name="([^"]+)" value="([^"]*)"')


def bearing(http, name, **changes):
    """A design with version 1 of the oil film; its id."""
    step = {"template": "oil_film", "version": 1, "inputs": {**INPUTS, **changes}}
    criteria = {"thick": {"require": "film.minimum_film_thickness >= 2.8 um"}}
    return created(http, {"name": name, "steps": {"film": step}, "criteria": criteria})["id"]


def sent(http, path, **fields):
    return http.post(path, data=fields, headers={"Origin": str(http.base_url).rstrip("/")})


def found(http, **fields):
    """The page once its calculation has ended."""
    answer = sent(http, PAGE, **fields)
    if answer.status_code == 303:
        place = answer.headers["location"]
        answer = until(lambda: http.get(place), lambda now: "data-job" not in now.text, patient(60))
    assert answer.status_code == 200
    return answer.text


def row(page, design):
    return re.search(rf'<tr data-design="{design}".*?</tr>', page, re.DOTALL)[0]


def test_a_design_is_upgraded_by_forms(http):
    design = bearing(http, "bearing to be upgraded")
    page = found(http, name="to be upgraded")
    line = row(page, design)
    assert 'data-effect="moved"' in line
    assert "film: version 1" in line
    assert "undecided" in line
    assert "not met" in line
    assert f"/designs/{design}/upgrade?template=oil_film&amp;version=2" in line
    [(action, inside)] = FORM.findall(line)
    fields = dict(HIDDEN.findall(inside))
    assert fields == {"template": "oil_film", "version": "2", "revision": "1"}
    assert http.get(f"{API}/designs/{design}").json()["revision"] == 1
    assert sent(http, action, **fields).headers["location"] == f"/designs/{design}"
    after = http.get(f"{API}/designs/{design}").json()
    assert (after["revision"], after["steps"]["film"]["version"]) == (2, 2)
    assert after["steps"]["film"]["inputs"] == INPUTS
    assert "0 designs use another version" in found(http, name="to be upgraded")


def test_a_refused_design_says_what_to_give(http):
    inputs = {name: value for name, value in INPUTS.items() if "temperature" not in name}
    step = {"template": "oil_film", "version": 2, "inputs": {**inputs, "dynamic_viscosity": "9 mPa*s"}}
    design = created(http, {"name": "by viscosity", "steps": {"film": step}})["id"]
    path = "/templates/oil_film/1/impact"
    answer = sent(http, path, name="by viscosity")
    place = answer.headers["location"]
    page = until(lambda: http.get(place), lambda now: "data-job" not in now.text, patient(60)).text
    line = row(page, design)
    assert 'data-effect="refused"' in line
    assert "Remove film.dynamic_viscosity" in line
    assert FORM.findall(line) == []
    preview = http.get(f"/designs/{design}/upgrade", params={"template": "oil_film", "version": "1"})
    assert preview.status_code == 422
    assert "film.dynamic_viscosity" in preview.text
    assert "save as revision" not in preview.text


def test_the_design_says_that_there_is_a_newer_version(http):
    old = http.get(f"/designs/{bearing(http, 'old version')}").text
    assert 'data-upgrade="film"' in old
    assert "version 2 is available" in old
    step = {"template": "oil_film", "version": 2, "inputs": INPUTS}
    new = created(http, {"name": "new version", "steps": {"film": step}})["id"]
    assert "data-upgrade" not in http.get(f"/designs/{new}").text


def test_an_upgrade_of_a_design_that_was_changed_meanwhile_is_refused(http):
    design = bearing(http, "changed meanwhile")
    patch = {"steps": {"film": {"inputs": {"radial_load": "24 kN"}}}}
    assert http.patch(f"{API}/designs/{design}", json=patch, headers={"If-Match": '"1"'}).status_code == 200
    answer = sent(http, f"/designs/{design}/upgrade", template="oil_film", version="2", revision="1")
    assert answer.status_code == 412
    assert "Nothing was saved" in answer.text
    assert "save as revision 3" in answer.text  # looked at again, it may be saved
    assert http.get(f"{API}/designs/{design}").json()["revision"] == 2


@pytest.mark.parametrize("query", [
    {}, {"template": "oil_film", "version": "x"}, {"template": "oil_film", "version": "9"},
    {"template": "journal_friction", "version": "1"}, {"template": "../oil_film", "version": "1"},
])  # fmt: skip
def test_an_upgrade_to_nothing_is_not_found(http, query):
    design = bearing(http, "to nothing")
    assert http.get(f"/designs/{design}/upgrade", params=query).status_code == 404


def test_a_cancelled_calculation_is_shown(http):
    answer = sent(http, PAGE)
    place = answer.headers["location"]
    job = place.rpartition("job=")[2]
    assert sent(http, f"{PAGE}/cancel", job=job).status_code == 303
    page = until(lambda: http.get(place), lambda now: "data-job" not in now.text, patient(60))
    assert page.status_code == 200
    assert "cancelled" in page.text or "data-impact" in page.text


@pytest.mark.slow
def test_the_impact_in_a_browser(http, watched):
    design = bearing(http, "in the browser")
    watched.open("/templates/oil_film/2")
    page = watched.page
    page.get_by_role("link", name="Impact on designs").click()
    page.get_by_label("Name contains").fill("in the browser")
    page.get_by_role("button", name="Calculate").click()
    page.locator(f'tr[data-design="{design}"]').get_by_role("link", name="Preview").click()
    page.get_by_role("heading", name="Upgrade to oil_film version 2").wait_for()
    row = page.locator('tr[data-criterion="thick"]')
    assert row.locator("td").all_inner_texts()[:2] == ["undecided", "not met"]
    assert "2.657 µm is below 2.8 µm: not met" in row.inner_text()
    page.get_by_role("button", name="Upgrade: save as revision 2").click()
    page.wait_for_url(f"**/designs/{design}")
    assert http.get(f"{API}/designs/{design}").json()["steps"]["film"]["version"] == 2
    assert watched.faults() == []

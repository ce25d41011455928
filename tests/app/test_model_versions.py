"""A model with two versions: which is the latest, a withdrawn version, designs of both, impact."""

import io
from textwrap import dedent

import httpx
import pytest
from pypdf import PdfReader
from serving import API, DOUBLE, created, patched, revision, serving
from two_versions import folder_of_two_versions

from app.settings import Settings
from cad.model import CadModel
from cad.regenerate import regenerate_class
from templates.core.catalogue.digests import digest
from templates.core.catalogue.discovery import find

PLATE = {"id": "plate", "version": 1, "parameters": {"size": "20 mm"}}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder: both versions of the plate, and two of a template, which multiply by 2 and 3."""
    folder = folder_of_two_versions(tmp_path_factory.mktemp("team") / "plates")
    double = dedent(DOUBLE).lstrip()
    (folder / "double_v1.py").write_text(double)
    (folder / "double_v2.py").write_text(double.replace("2 * self.a", "3 * self.a"))
    return folder


@pytest.fixture(scope="module")
def plates(folder):
    return find([folder], CadModel)


@pytest.fixture(scope="module")
def http(folder, tmp_path_factory):
    settings = Settings(data=tmp_path_factory.mktemp("served"), template_folders=(folder,), wait_seconds=20)
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
        yield http


def version(design):
    """Return the version of the plate that a design or one of its revisions has."""
    return design["models"]["model"]["version"]


def volume(http, design):
    """Return the volume of the plate in the newest revision [mm³]."""
    measured = http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]["volume"]
    assert measured["unit"] == "mm**3"
    return measured["value"]


def paper_of(http, design):
    """Return the words of the report of the newest revision."""
    place = f"{API}/designs/{design['id']}/revisions/{design['revision']}/report.pdf"
    pdf = http.get(place, headers={"Prefer": "wait=60"})
    assert pdf.status_code == 200, pdf.text
    return " ".join(" ".join(one.extract_text() for one in PdfReader(io.BytesIO(pdf.content)).pages).split())


def test_both_versions_stand_side_by_side_and_the_latest_is_not_withdrawn(plates):
    assert sorted(plates.of("plate")) == [1, 2]
    assert plates.latest("plate").version == 2
    assert plates.get("plate", 1).withdrawn == "too thin, use 2"
    assert digest(plates.get("plate", 1)) != digest(plates.get("plate", 2))


def test_a_withdrawn_version_is_built_as_before(plates):
    first, second = (regenerate_class(plates.get("plate", n), {"size": "20 mm"}) for n in (1, 2))
    assert first.measures["volume"] == pytest.approx(800, rel=1e-9)
    assert second.measures["volume"] == pytest.approx(1600, rel=1e-9)


def test_the_interface_lists_both_and_says_which_is_withdrawn(http):
    items = http.get(f"{API}/models/plate").json()["items"]
    assert {one["version"]: (one["status"], one["latest"]) for one in items} == {
        1: ("withdrawn", False),
        2: ("released", True),
    }
    described = [http.get(f"{API}/models/plate/versions/{number}").json() for number in (1, 2)]
    assert [one["withdrawn"] for one in described] == ["too thin, use 2", None]


def test_the_page_of_the_withdrawn_version_says_why(http):
    assert "Withdrawn: too thin, use 2" in http.get("/models/plate/1").text
    assert "too thin" not in http.get("/models/plate/2").text


def test_pages_and_report_of_a_design_say_that_its_model_is_withdrawn(http):
    """The report on screen and on paper, the page of the design, and that of its revision."""
    design = created(http, {"name": "plate", "model": PLATE})
    page = f"/designs/{design['id']}"
    for shown in (page, f"{page}/revisions/1", f"{API}{page}/revisions/1/report"):
        assert "ithdrawn: too thin, use 2" in http.get(shown).text, shown
    assert "withdrawn: too thin, use 2" in paper_of(http, design)
    upgraded = patched(http, design, {"model": {"version": 2}})
    for shown in (page, f"{page}/revisions/2", f"{API}{page}/revisions/2/report"):
        assert "too thin" not in http.get(shown).text, shown
    assert "too thin" not in paper_of(http, upgraded)


def test_a_design_keeps_its_version_until_it_is_upgraded(http):
    old = created(http, {"name": "plate", "model": PLATE})
    thin = revision(http, old)["models"]["model"]
    assert (version(old), volume(http, old)) == (1, pytest.approx(800, rel=1e-9))
    new = patched(http, old, {"model": {"version": 2}})
    assert (new["revision"], version(new)) == (2, 2)
    assert volume(http, new) == pytest.approx(1600, rel=1e-9)
    assert revision(http, new, 1)["models"]["model"] == thin
    assert revision(http, new)["models"]["model"]["build"] != thin["build"]


def test_an_upgraded_design_can_go_back_to_the_withdrawn_version(http):
    design = patched(
        http, created(http, {"name": "plate", "model": {**PLATE, "version": 2}}), {"model": PLATE}
    )
    assert version(design) == 1
    assert volume(http, design) == pytest.approx(800, rel=1e-9)


def test_latest_is_pinned_to_the_version_that_is_not_withdrawn(http):
    design = created(http, {"name": "plate", "model": {**PLATE, "version": "latest"}})
    assert version(design) == 2


def test_impact_of_a_template_names_the_parameter_that_moves_and_leaves_the_model_its_version(http):
    step = {"template": "double", "version": 1, "inputs": {"length": "10 mm"}}
    plate = {**PLATE, "parameters": {"size": "= double.twice_the_length"}}
    design = created(http, {"name": "of a step", "steps": {"double": step}, "model": plate})
    asked = {"designs": [design["id"]]}
    path = f"{API}/templates/double/versions/2/impact"
    impact = http.post(path, json=asked, headers={"Prefer": "wait=60"}).json()
    [moved] = impact["designs"][0]["parameters"]
    assert (moved["name"], moved["old"]["unit"]) == ("model.size", "mm")
    assert (moved["old"]["value"], moved["new"]["value"]) == pytest.approx((20, 30))
    upgraded = patched(http, design, {"steps": {"double": {"version": 2}}})
    assert version(upgraded) == 1
    assert volume(http, upgraded) == pytest.approx(30 * 30 * 3, rel=1e-9)

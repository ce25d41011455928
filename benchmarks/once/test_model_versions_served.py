"""A model with two versions: which is the latest, what a withdrawn one says, designs of either."""

import httpx
import pytest
from serving import API, created, patched, revision, serving
from two_versions import folder_of_two_versions

from app.settings import Settings
from cad.model import CadModel
from cad.regenerate import regenerate_class
from templates.core.catalogue.digests import digest
from templates.core.catalogue.finding import find


@pytest.fixture(scope="module")
def plates(tmp_path_factory):
    return find([folder_of_two_versions(tmp_path_factory.mktemp("team") / "plates")], CadModel)


@pytest.fixture(scope="module")
def http(tmp_path_factory):
    place = tmp_path_factory.mktemp("served")
    folder = folder_of_two_versions(place / "plates")
    settings = Settings(data=place / "data", template_folders=(folder,), wait_seconds=20)
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
        yield http


def design(version):
    return {"name": "plate", "model": {"id": "plate", "version": version, "parameters": {"size": "20 mm"}}}


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
    assert "too thin, use 2" in http.get("/models/plate/1").text
    assert "too thin, use 2" not in http.get("/models/plate/2").text


def test_a_design_keeps_its_version_until_it_is_upgraded(http):
    old = created(http, design(1))
    assert old["model"]["version"] == 1
    thin = revision(http, old)["model"]["measures"]["mass"]["value"]
    new = patched(http, old, {"model": {"version": 2}})
    assert (new["revision"], new["model"]["version"]) == (2, 2)
    assert revision(http, new)["model"]["measures"]["mass"]["value"] == pytest.approx(2 * thin, rel=1e-9)
    assert revision(http, new, 1)["model"]["measures"]["mass"]["value"] == thin


def test_latest_is_pinned_to_the_version_that_stays(http):
    assert created(http, design("latest"))["model"]["version"] == 2

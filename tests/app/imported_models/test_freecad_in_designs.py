"""Models of FreeCAD in designs and assemblies: what comes out empty is refused, and the last good is kept."""

import json
from math import pi

import pytest
from freecad_files import documents, ended, imported, needs_freecad, post
from serving import API, created, patched

pytestmark = needs_freecad


@pytest.fixture(scope="module")
def files():
    return documents(
        {
            "bored_block": ("cut", {"hole": "8 mm"}),
            "plain_ring": ("unitless", {"outside": 60, "d1": 24, "count": 4, "unused": 7}),
        }
    )


@pytest.fixture(scope="module")
def block(http, files):
    return imported(http, "bored_block", files["bored_block"], file="block.FCStd")


def measured(http, design):
    return http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]


def test_an_empty_last_feature_keeps_the_last_good_model(http, block):
    model = {"id": "bored_block", "version": 1, "parameters": {"hole": "8 mm"}}
    design = created(http, {"name": "bored", "models": {"model": model}})
    assert design["state"] == "current"
    mass = measured(http, design)["mass"]["value"]
    assert mass == pytest.approx((40**3 - pi * 64 * 40) * 7850e-9, rel=1e-6)
    after = patched(http, design, {"models": {"model": {"parameters": {"hole": "55 mm"}}}})
    assert after["state"] == "failed"
    assert after["problem"]["errors"][0]["code"] == "no_solid"
    assert "Bored has no solid at these values" in after["problem"]["detail"]
    assert measured(http, design)["mass"]["value"] == mass
    again = patched(http, after, {"models": {"model": {"parameters": {"hole": "9 mm"}}}})
    assert again["state"] == "current"


def test_the_origin_tells_ends_findings_and_what_parameters_move(http, block, files):
    origin = http.get(f"{block}/origin").json()
    assert origin["ends"] == ["Bored"]
    assert origin["findings"][0].startswith("Written again and read back, a volume changes by ")
    ring = imported(http, "plain_ring", files["plain_ring"], file="ring.FCStd")
    origin = http.get(f"{ring}/origin").json()
    moves = {one["name"]: one["moves"] for one in origin["parameters"]}
    assert moves["d1"].startswith("24 → 24.24: diameter 48 → 48.48 mm")
    assert moves["unused"] == "nothing"
    words = http.get(ring).json()["parameters"]["properties"]
    assert words["d1"]["title"] == "d1 (radius in mm)"
    assert words["unused"]["title"] == "unused (moves nothing)"
    page = http.get("/models/plain_ring/1").text
    assert "diameter 48 → 48.48 mm" in page
    assert "Found at the import" in page


def test_a_model_of_freecad_is_a_component_by_its_id(http, block):
    said = {
        "program": "assembly",
        "title": "Two blocks",
        "components": [
            {"name": "lower", "model": "bored_block"},
            {"name": "upper", "model": "bored_block", "version": 1, "z": "41 mm"},
        ],
    }
    assembly = imported(http, "two_blocks", json.dumps(said).encode(), file="two.json")
    answer = http.post(f"{assembly}/build", json={"parameters": {}}, headers={"Prefer": "wait=60"}).json()
    volume = answer["measurements"]["volume"]["value"]
    assert volume == pytest.approx(2 * (40**3 - pi * 64 * 40), rel=1e-9)
    (clearance,) = answer["measurements"]["clearances"]
    assert clearance["distance"]["value"] == pytest.approx(1, abs=1e-9)
    whole = {
        "program": "assembly",
        "title": "Three blocks",
        "components": [
            {"name": "first", "model": "two_blocks"},
            {"name": "one", "model": "bored_block", "x": "1 m"},
        ],
    }
    itself = {**whole, "components": [{"name": "first", "model": "two_blocks"}]}
    job = ended(http, post(http, "two_blocks", json.dumps(itself).encode()))
    assert job["problem"]["errors"][0]["code"] == "cycle"
    nested = imported(http, "three_blocks", json.dumps(whole).encode(), file="three.json")
    answer = http.post(f"{nested}/build", json={"parameters": {}}, headers={"Prefer": "wait=60"}).json()
    assert answer["measurements"]["volume"]["value"] == pytest.approx(1.5 * volume, rel=1e-9)

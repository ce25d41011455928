"""One variant with its curves equals a separate design; refused where it cannot be calculated."""

import asyncio

import pytest
from row_designs import CURVES
from serving import API, created, problem

from app.client import AsyncClient

DESIGNS = f"{API}/designs"
VARIANTS = {"slow": {"speed": "2000 rpm"}, "wide": {"bore": "90 mm", "clearance": "= 0.06 mm"}}
COURSE = "loads.main_load_x"


def engine(**parameters):
    """The loads of an engine along its crank angle."""
    own = {**CURVES["parameters"], **parameters}
    loads = {**CURVES["steps"]["loads"]}
    return {
        "name": "engine",
        "parameters": {name: own[name] for name in ("speed", "bore", "clearance")},
        "steps": {"loads": loads},
    }


@pytest.fixture(scope="module")
def design(http):
    return created(http, {**engine(), "variants": VARIANTS})["id"]


def detail(http, design, name, tail="variants", **params):
    answer = http.get(f"{DESIGNS}/{design}/{tail}/{name}", params=params)
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.mark.parametrize(("name", "own"), [("slow", {"speed": "2000 rpm"}), ("base", {})])
def test_curves_are_those_of_a_design_of_its_own(http, design, name, own):
    one = detail(http, design, name)
    alone = created(http, engine(**own))["id"]
    step = http.get(f"{DESIGNS}/{alone}/revisions/1").json()["steps"]["loads"]["outputs"]
    assert one["outputs"].keys() == {f"loads.{output}" for output in step}
    curve, wanted = one["outputs"][COURSE], step["main_load_x"]
    assert curve["unit"] == wanted["unit"]
    assert len(curve["value"]) > 1
    assert curve["value"] == pytest.approx(wanted["value"], rel=1e-12)


def test_variants_differ_and_say_what_they_override(http, design):
    slow, wide = (detail(http, design, name, output=COURSE) for name in VARIANTS)
    assert slow["outputs"].keys() == {COURSE}
    assert slow["outputs"][COURSE] != wide["outputs"][COURSE]
    assert slow["values"] == {"speed": {"value": 2000, "unit": "rpm"}}
    assert (wide["name"], wide["revision"]) == ("wide", 1)
    assert detail(http, design, "slow", "revisions/1/variants", output=COURSE) == slow


def test_in_american_units(http, design):
    si, us = (
        detail(http, design, "slow", output=COURSE, units=units)["outputs"][COURSE] for units in ("si", "us")
    )
    assert us["unit"] == "lbf"
    newtons = {"N": 1, "kN": 1000}[si["unit"]]
    assert us["value"] == pytest.approx([value * newtons / 4.4482216152605 for value in flat(si["value"])])


def flat(values):
    assert all(isinstance(value, float | int) for value in values)
    return values


def test_an_unknown_variant_or_output_is_named(http, design):
    refusal = problem(http.get(f"{DESIGNS}/{design}/variants/fast"), 404, "not-found")
    assert "there are base, slow, wide" in refusal["detail"]
    wrong = http.get(f"{DESIGNS}/{design}/variants/slow", params={"output": "loads.main_lod_x"})
    assert [fault["name"] for fault in problem(wrong, 422, "invalid-inputs")["errors"]] == [
        "outputs.loads.main_lod_x"
    ]
    assert http.get(f"{DESIGNS}/{design}/revisions/9/variants/slow").status_code == 404


def test_nobody_waits_and_a_job_answers(http, design):
    path = f"{DESIGNS}/{design}/variants/wide"
    answer = http.get(path, params={"output": COURSE}, headers={"Prefer": "respond-async"})
    assert answer.status_code in (200, 202)  # 200: remembered, or too quick to be left to a job
    assert http.get(path, params={"output": COURSE}, headers={"Prefer": "wait=30"}).status_code == 200


def test_both_clients_ask_for_it(served, client, http, design):
    one = client.variant(design, "slow", outputs=[COURSE])
    assert one.plain() == detail(http, design, "slow", output=COURSE)

    async def ask():
        async with AsyncClient(served.url) as other:
            return await other.variant(design, "slow", 1, outputs=[COURSE], units="us")

    assert asyncio.run(ask()).outputs[COURSE].unit == "lbf"

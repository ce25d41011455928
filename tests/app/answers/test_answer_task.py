"""Answers in one process: chosen values, verdicts after snapping, fits, options, targets, what binds."""

import json

import numpy as np
import pytest

from app.answers.bodies import PAPER_BEARING
from app.answers.fits import Fit
from app.answers.tasks import answer_request
from app.catalogue.catalogues import Catalogues
from app.catalogue.discovery import find_templates
from app.designs.gallery.gallery import GALLERY
from app.designs.graph import read_document, resolved
from app.designs.tasks import DesignTask
from cad.catalogue import models
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

CATALOGUES = Catalogues(find_templates(()), models())
BEARING = {
    "name": "Petroff",
    "parameters": {"radius": "25 mm", "speed": "3000 rpm"},
    "steps": {
        "idle": {
            "template": "journal_friction",
            "version": 1,
            "inputs": {
                "journal_diameter": "= 2 * radius",
                "bearing_width": "20 mm",
                "radial_clearance": "30 um",
                "speed": "= speed",
                "dynamic_viscosity": "10 mPa*s",
            },
        }
    },
}


def answered(design=BEARING, **body):
    raw = GALLERY[design].document if isinstance(design, str) else design
    document = resolved(read_document(raw), CATALOGUES).model_dump(mode="json")
    return answer_request(DesignTask.of(document, CATALOGUES), 7, json.dumps({"design": "", **body}))


def power(radius_mm, width_mm):
    inputs = BEARING["steps"]["idle"]["inputs"]
    given = {**inputs, "journal_diameter": f"{2 * radius_mm} mm", "bearing_width": f"{width_mm} mm"}
    cls = CATALOGUES.templates.get("journal_friction", 1)
    return evaluate(cls, {**given, "speed": "3000 rpm"}).outputs["power_loss"].value


def test_values_lie_on_their_grids_and_no_other_point_of_the_grid_is_better():
    """Petroff's power grows with width and radius; the area has to be at least 4000 mm²."""
    answer = answered(
        free={
            "radius": {"between": ["20.2 mm", "29.9 mm"], "step": "0.5 mm"},
            "idle.bearing_width": {"between": ["15.3 mm", "40 mm"], "step": "2 mm"},
        },
        require=["radius * idle.bearing_width >= 700 mm**2"],
        minimise="idle.power_loss",
    )
    grid = [(r, w) for r in np.arange(20.5, 29.6, 0.5) for w in range(16, 41, 2) if r * w >= 700]
    best = min(grid, key=lambda at: power(*at))
    values = [answer.values[name].value.value for name in ("radius", "idle.bearing_width")]
    assert values == pytest.approx(best)
    assert answer.state == "confirmed"
    assert answer.objective.value.value == pytest.approx(power(*best), rel=1e-9)


def test_a_binding_requirement_states_what_its_relaxation_gains():
    body = {
        "free": {"idle.bearing_width": {"between": ["10 mm", "40 mm"]}},
        "require": ["idle.bearing_width >= 20 mm"],
        "minimise": "idle.power_loss",
    }
    answer = answered(**body)
    assert answer.values["idle.bearing_width"].value.value == pytest.approx(20)
    relaxed = answered(**{**body, "require": ["idle.bearing_width >= 19.8 mm"]})
    gain = answer.objective.value.value - relaxed.objective.value.value
    assert answer.binding.by == 0.01
    assert answer.binding.limit.value == pytest.approx(19.8)
    assert answer.binding.gain.value == pytest.approx(gain, rel=1e-3)
    assert answer.binding.name in answer.sentence


def test_a_fit_is_judged_at_its_least_and_its_greatest_clearance():
    least, greatest = (1e3 * one for one in Fit.read("H7/f7").clearance(0.048))
    assert (least, greatest) == pytest.approx((0.025, 0.075))
    free = {
        "idle.radial_clearance": {
            "standard": "ISO 286",
            "size": "48 mm",
            "fits": ["H7/f7", "H7/e8", "H7/g6"],
        }
    }
    wide = answered(free=free, require=["idle.radial_clearance >= 24 um"], minimise="idle.power_loss")
    assert wide.values["idle.radial_clearance"].fit in ("H7/f7", "H7/e8")
    narrow = answered(free=free, require=["idle.radial_clearance <= 74 um"], minimise="idle.power_loss")
    assert narrow.values["idle.radial_clearance"].fit == "H7/g6"
    value = narrow.patch["steps"]["idle"]["inputs"]["radial_clearance"]
    assert value["value"] + value["plus"] == pytest.approx(0.05 if value["unit"] == "mm" else 50)


def test_a_designation_is_chosen_among_its_options():
    design = {
        "name": "ball bearing",
        "models": {
            "bearing": {"id": "deep_groove_bearing", "version": 1, "parameters": {"designation": "6210"}}
        },
    }
    options = ["6206", "6207", "6208", "6209", "6210"]
    answer = answered(
        design,
        free={"bearing.designation": {"options": options}},
        require=["bearing.inner_diameter >= 37 mm"],
        minimise="bearing.outer_diameter",
    )
    assert answer.values["bearing.designation"].value.value == "6208"
    assert answer.patch["models"]["bearing"]["parameters"]["designation"] == "6208"
    standard = answered(
        design,
        free={"bearing.designation": {"standard": "ISO 15"}},
        require=["bearing.inner_diameter >= 37 mm", "bearing.width >= 20 mm"],
        minimise="bearing.outer_diameter",
    )
    assert standard.feasible
    assert standard.values["bearing.designation"].value.value == "6210"


def test_a_target_is_met_within_its_tolerance():
    width = {"idle.bearing_width": {"between": ["10 mm", "40 mm"]}}
    wanted = power(25, 23)
    answer = answered(free=width, targets={"idle.power_loss": f"{wanted!r} ± {wanted / 100!r} W"})
    assert answer.values["idle.bearing_width"].value.value == pytest.approx(23, rel=1e-3)
    assert [one.verdict for one in answer.requirements] == ["met", "met"]
    assert answer.state == "unconfirmed"  # Petroff's formula states no error


def test_an_infeasible_request_names_the_conflict_and_a_relaxation_that_is_feasible():
    """The width alone decides both: a power of at most that of 20 mm excludes 30 mm."""
    limit = power(25, 20)
    body = {
        "free": {"idle.bearing_width": {"between": ["10 mm", "40 mm"]}},
        "require": [
            "idle.bearing_width >= 30 mm",
            "idle.bearing_width >= 12 mm",
            f"idle.power_loss <= {limit!r} W",
        ],
        "minimise": "idle.power_loss",
    }
    answer = answered(**body)
    assert (answer.state, answer.feasible) == ("infeasible", False)
    conflict = answer.conflict
    assert sorted(conflict.requirements) == ["idle_bearing_width_least", "idle_power_loss_most"]
    reach = {one.name: one.best.value for one in conflict.reachable}
    assert reach["idle_bearing_width_least"] == pytest.approx(20, rel=1e-3)
    assert reach["idle_power_loss_most"] == pytest.approx(power(25, 30), rel=1e-3)
    assert conflict.relaxation.by == pytest.approx(1 / 3, rel=0.02)
    for option in (conflict.relaxation, *conflict.alternatives):
        names = {one.name: one.require for one in answer.requirements}
        relaxed = [relaxed_text(names[name], option.limits.get(name)) for name in names]
        assert answered(**{**body, "require": relaxed}).feasible


def relaxed_text(require, limit):
    if limit is None:
        return require
    sign = ">=" if ">=" in require else "<="
    return f"{require.partition(sign)[0]}{sign} {limit.value!r} {limit.unit}"


def test_an_error_that_is_unknown_is_never_confirmed():
    """The power of level mass_conserving has no stated error in a heat balance."""
    inputs = {
        "radial_load": "10 kN",
        "bearing_diameter": "48 mm",
        "bearing_width": "20 mm",
        "diametral_clearance": "60 um",
        "speed": "5000 rpm",
        "supply_temperature": "80 degC",
    }
    film = {"name": "film", "steps": {"film": {"template": "oil_film", "version": 2, "inputs": inputs}}}
    body = {
        "free": {"film.diametral_clearance": {"between": ["50 um", "100 um"], "step": "10 um"}},
        "require": ["film.power_loss <= 5 kW"],
        "minimise": "film.diametral_clearance",
    }
    answer = answered(film, **body)
    assert answer.state == "unconfirmed"
    assert not any(one.confirmed for one in answer.requirements)
    assert answer.requirements[0].error is None
    assert answered(film, **body, tolerance=0.01).state == "confirmed"


@pytest.mark.parametrize(
    ("body", "name", "code", "words"),
    [
        ({"free": {}}, "free", "missing", "name the places"),
        ({"free": {"speed": {}}}, "free.speed", "missing", "bounds"),
        ({"free": {"speed": {"between": ["2 rpm", "1 rpm"]}}}, "free.speed.between", "not_ascending", "swap"),
        ({"free": {"speed": {"between": ["1", "2"]}}}, "free.speed", "missing_unit", "rpm"),
        ({"free": {"speed": {"between": ["1 mm", "2 mm"]}}}, "free.speed", "wrong_unit", "rpm"),
        (
            {"free": {"idle.speed": {"between": ["1 rpm", "2 rpm"]}}},
            "free.idle.speed",
            "follows_from",
            "set_aside",
        ),
        ({"free": {"spede": {"between": ["1 rpm", "2 rpm"]}}}, "free.spede", "unknown_name", "speed"),
        (
            {"free": {"speed": {"between": ["1 rpm", "2 rpm"], "standard": "DIN 1"}}},
            "free.speed.standard",
            "unknown_standard",
            "ISO 286",
        ),
        ({"free": {"radius": {"standard": "ISO 286"}}}, "free.radius.size", "missing", "size"),
        (
            {"free": {"radius": {"standard": "ISO 286", "size": "48 mm", "fits": ["H7/q7"]}}},
            "free.radius",
            "unknown_zone",
            "q7",
        ),
        (
            {"free": {"radius": {"between": ["20.1 mm", "20.2 mm"], "step": "1 mm"}}},
            "free.radius.step",
            "no_value",
            "multiple",
        ),
        ({"require": ["idle.powr <= 3 W"]}, "require.0", "unknown_name", "power_loss"),
        ({"require": ["idle.power_loss <= 3 N"]}, "require.0", "unit_mismatch", "N"),
        ({"require": ["nothing"]}, "require.nothing", "unknown_name", "requirement"),
        ({"targets": {"idle.power_loss": "3"}}, "targets.idle.power_loss", "unit_mismatch", "W"),
        ({"minimise": "idle.power"}, "minimise.idle.power", "unknown_name", "power_loss"),
        ({"maximise": "idle.power_loss"}, "maximise", "contradiction", "one objective"),
        ({"with": {"radius": "1 mm"}}, "with.radius", "conflict", "free"),
    ],
)
def test_a_wrong_request_is_refused_by_name_with_its_remedy(body, name, code, words):
    usual = {
        "free": {"radius": {"between": ["20 mm", "30 mm"]}},
        "require": ["radius >= 25 mm"],
        "minimise": "idle.power_loss",
    }
    with pytest.raises(InvalidInputs) as refusal:
        answered(**{**usual, **body})
    fault = next(one for one in refusal.value.faults if one.name == name)
    assert fault.code == code
    assert words in fault.detail


def test_the_bearing_of_the_paper_has_its_width_on_half_millimetres():
    body = {name: part for name, part in PAPER_BEARING.items() if name != "design"}
    answer = answered("shell", **body)
    width = answer.values["film.bearing_width"].value
    assert (2 * width.value) % 1 == 0
    assert answer.state == "confirmed"
    assert answer.confirmed_at.levels == {"film": "mass_conserving"}
    assert answer.binding.gain.value > 0

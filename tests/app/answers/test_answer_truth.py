"""Answers checked independently: brute force at the reference level, dense samples, relaxations.

The bearings are those of the sizing ensemble (`benchmarks.sizing`), with and without a heat balance.
"""

import json

import numpy as np
import pytest

from app.answers.tasks import answer_request
from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine
from app.designs.graph import read_document, resolved
from app.designs.tasks import DesignTask
from app.reference import Reference
from app.studies.methods.points import sobol_sequence
from benchmarks.answers import CATALOGUES, FILM, LOSS, bearing, within

FINE = {"film": "mass_conserving"}
STEPS = (6, 7)  # values of width and clearance


def answered(raw, **body):
    document = resolved(read_document(raw), CATALOGUES).model_dump(mode="json")
    return answer_request(DesignTask.of(document, CATALOGUES), None, json.dumps({"design": "", **body}))


def rows_of(raw, names, rows, levels):
    """The film and the loss of rows [SI], with the relative error of the film."""
    engine = DesignEngine.of(Document.model_validate(raw), CATALOGUES, [Reference(name) for name in names])
    given = {Reference(name): column for name, column in zip(names, rows.T, strict=True)}
    table = engine(given, [FILM, LOSS], levels=levels)
    return table.columns[FILM], table.columns[LOSS], table.errors[FILM]


@pytest.mark.slow
@pytest.mark.parametrize("number", range(12))
def test_no_point_of_the_grid_is_better_at_the_reference_level(number):
    one, raw = bearing(number)
    (low, high), (least, most) = within(one)[1:]
    widths = np.round(np.linspace(low, high, STEPS[0]) * 1e3 * 2) / 2  # mm, on half millimetres
    clearances = np.unique(np.round(np.linspace(least, most, STEPS[1]) * 1e6))  # um
    widths = np.unique(widths)
    grid = np.array([(w / 1e3, c / 1e6) for w in widths for c in clearances])
    film, loss, error = rows_of(raw, ("width", "clearance"), grid, FINE)
    limit = float(np.quantile(film, 0.6))
    safe = film / (1 + np.nan_to_num(error)) >= limit
    answer = answered(
        raw,
        free={
            "width": {"values": [f"{w} mm" for w in widths]},
            "clearance": {"values": [f"{c} um" for c in clearances]},
        },
        require=[f"film.minimum_film_thickness >= {limit!r} m"],
        minimise="film.power_loss",
    )
    assert answer.feasible == safe.any()
    best = float(loss[safe].min())
    stated = answer.objective.error or 0.0
    assert answer.objective.value.value <= best * (1 + max(stated, 1e-3))
    chosen = (answer.values["width"].value.value, answer.values["clearance"].value.value)
    scale = {"mm": 1.0, "um": 1e3}[answer.values["clearance"].value.unit]
    row = np.argmin(np.abs(grid[:, 0] * 1e3 - chosen[0]) + np.abs(grid[:, 1] * 1e3 * scale - chosen[1]))
    assert film[row] >= limit


def infeasible(number):
    """A bearing of the ensemble with a film and a loss that can each be met, but not both."""
    one, raw = bearing(number)
    names, ends = ("diameter", "width", "clearance"), np.array(within(one))
    rows = ends[:, 0] + sobol_sequence(3, number, 0, 2048) * (ends[:, 1] - ends[:, 0])
    film, loss, _ = rows_of(raw, names, rows, {"film": "map"})
    random = np.random.default_rng(number)
    limit = float(np.quantile(film, random.uniform(0.7, 0.95)))
    alone, least = float(loss.min()), float(loss[film >= limit].min())
    return one, raw, limit, alone + random.uniform(0.2, 0.8) * (least - alone), (film, loss, rows)


def body_of(one, requirements):
    ends = dict(zip(("diameter", "width", "clearance"), within(one), strict=True))
    free = {name: {"between": [f"{low!r} m", f"{high!r} m"]} for name, (low, high) in ends.items()}
    return {"free": free, "require": requirements, "minimise": "film.power_loss", "tolerance": 0.01}


@pytest.mark.slow
@pytest.mark.parametrize("number", range(50))
def test_an_infeasible_bearing_names_its_conflict_and_a_relaxation_that_is_feasible(number):
    """Two limits that the film and the loss cannot both meet, beside two that are easily met."""
    one, raw, film, loss, (films, losses, _) = infeasible(number)
    assert not ((films >= film) & (losses <= loss)).any()  # dense sampling agrees
    texts = [
        f"film.minimum_film_thickness >= {film!r} m",
        "film.minimum_film_thickness >= 0.01 um",
        f"film.power_loss <= {loss!r} W",
        "film.maximum_pressure <= 100 GPa",
    ]
    answer = answered(raw, **body_of(one, texts))
    assert answer.state == "infeasible"
    names = dict(zip([each.name for each in answer.requirements], texts, strict=True))
    assert sorted(names[each] for each in answer.conflict.requirements) == sorted([texts[0], texts[2]])
    relaxed = answer.conflict.relaxation
    again = [
        f"{text.rpartition('= ')[0]}= {relaxed.limits[name].value!r} {relaxed.limits[name].unit}"
        if name in relaxed.limits
        else text
        for name, text in names.items()
    ]
    assert answered(raw, **body_of(one, again)).feasible

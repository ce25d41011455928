"""Designs with varied values, and each of their rows as a separate design."""

from collections.abc import Mapping

import numpy as np
import pytest

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.design_engine import DesignEngine
from app.designs.graph import Catalogues, build_graph
from app.reference import Reference
from cad.catalogue import models
from templates.core.errors import InvalidInputs
from templates.core.units.units import unit
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
ref = Reference.parse

BEARING = {
    "name": "main bearing",
    "parameters": {"diameter": "48 mm", "width": "18 mm", "clearance": "0.055 mm", "load": "25 kN"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "outputs": ["minimum_film_thickness", "power_loss"],
            "inputs": {
                "radial_load": "= load",
                "bearing_diameter": "= diameter",
                "bearing_width": "= width",
                "speed": "5000 rpm",
                "diametral_clearance": "= clearance",
                "supply_temperature": "80 degC",
            },
        },
        "idle": {
            "template": "journal_friction",
            "version": 1,
            "outputs": ["power_loss"],
            "inputs": {
                "journal_diameter": "= film.journal_diameter",
                "bearing_width": "= width",
                "speed": "5000 rpm",
                "radial_clearance": "= clearance / 2",
                "dynamic_viscosity": "= film.dynamic_viscosity",
            },
        },
    },
}
FILM, LOSS = ref("film.minimum_film_thickness"), ref("film.power_loss")

CURVES = {
    "name": "engine chain",
    "parameters": {
        "speed": "3000 rpm",
        "bore": "86 mm",
        "clearance": "0.055 mm",
        "factor": {"value": np.linspace(0.9, 1.1, 24).tolist(), "unit": "1"},
    },
    "steps": {
        "loads": {
            "template": "bearing_load",
            "version": 1,
            "outputs": ["main_load_x"],
            "inputs": {
                **built_in().get("bearing_load", 1).example,
                "speed": "= speed",
                "bore": "= bore",
            },
        },
        "film": {
            "template": "oil_film_cycle",
            "version": 1,
            "outputs": ["minimum_film_thickness"],
            "inputs": {
                "crank_angle": "= loads.crank_angle",
                "load_x": "= loads.main_load_x * factor",
                "load_y": "= loads.main_load_y * (bore / 86 mm)",
                "speed": "= speed",
                "bearing_diameter": "48 mm",
                "bearing_width": "18 mm",
                "diametral_clearance": "= clearance",
                "dynamic_viscosity": "10 mPa*s",
                "oil_supply": "flooded_ends",
            },
        },
    },
}


def engine_of(raw, *varied, **options):
    """The engine of a raw document in which places of these names vary."""
    return DesignEngine.of(Document.model_validate(raw), CATALOGUES, list(map(ref, varied)), **options)


def spread(engine, count, low=0.9, high=1.1, seed=0):
    """Rows between shares of the nominal values; those of a curve keep its form."""
    random, rows = np.random.default_rng(seed), {}
    for place in sorted(engine.varied, key=str):
        nominal = np.asarray(engine.nominal(place))
        share = random.uniform(low, high, (count,) + (1,) * nominal.ndim)
        rows[place] = nominal * share
    return rows


def alone(raw, rows, row, engine):
    """The document with the values of one row."""
    plain = Document.model_validate(raw).model_dump()
    for place, column in rows.items():
        base = unit(engine.unit(place)).base
        value = {"value": np.asarray(column[row]).tolist(), "unit": f"{base:~C}" or "1"}
        holder: Mapping = plain["parameters"]
        name = place.block
        if place.output is not None:
            is_step = place.block in plain["steps"]
            block = plain["steps" if is_step else "models"][place.block]
            holder, name = block["inputs" if is_step else "parameters"], place.output
        holder[name] = value
    return plain


def calculated(raw):
    """A document calculated as one design."""
    graph, faults = build_graph(Document.model_validate(raw), CATALOGUES)
    assert not faults
    return calculate(graph, lambda shape: None, lambda *question: None)


def assert_equal_to_designs(raw, engine, rows, wanted, table, within=1e-12):
    """Every row has the values, errors and levels of a design of its own; refused rows are refused there."""
    refused = 0
    for row in range(table.count):
        one = calculated(alone(raw, rows, row, engine))
        if one.faults:
            refused += 1
            assert table.refusals[row].place == one.faults[0].name
            assert table.refusals[row].code == one.faults[0].code
            continue
        assert row not in table.refusals
        for reference in wanted:
            expected, got = np.asarray(one.value(reference)), table.columns[reference][row]
            assert got.shape == expected.shape
            np.testing.assert_allclose(got, expected, rtol=within, atol=within * np.max(np.abs(expected)))
        _assert_equal_errors(one, row, table)
    return refused


def _assert_equal_errors(one, row, table):
    for reference, errors in table.errors.items():
        stated = one.evaluations[reference.block].error.get(reference.member)
        np.testing.assert_array_equal(errors[row], np.nan if stated is None else stated)
    for step, level in table.levels.items():
        assert one.evaluations[step].level == level


def codes(raw, *varied, **options):
    """The faults with which rows are refused, name → code, and the message."""
    with pytest.raises(InvalidInputs) as refused:
        engine_of(raw, *varied, **options)
    return {fault.name: fault.code for fault in refused.value.faults}, str(refused.value)

"""Every template and model in a design of many rows gives the results of separate designs."""

import numpy as np
import pytest
from row_designs import CATALOGUES, assert_equal_to_designs, engine_of, ref

from templates.core.language.intake import is_single
from templates.core.language.spec import Choice, Table, Text

TEMPLATES = sorted(CATALOGUES.templates.versions)
MODELS = sorted(CATALOGUES.models.versions)


EXACT = {
    "forced_torsion": {"crank_angle"},
    "bearing_assembly": {"journal_diameter", "diametral_clearance", "wall", "housing_bore"},
}
"""Inputs that are refused unless they are exact: a cycle has 720 deg, shells fit a housing within 20 µm."""


def quantities(cls):
    """The inputs of the example that may be any number."""
    return [
        name
        for name in cls.example
        if not isinstance(cls.inputs[name], (Choice, Table))
        and not cls.inputs[name].meaning.integer
        and not is_single(cls.inputs[name])
        and name not in EXACT.get(cls.id, ())
    ]


def varied(engine, count):
    """Rows of nominal values that differ by up to one per cent."""
    random, rows = np.random.default_rng(5), {}
    for place in sorted(engine.varied, key=str):
        nominal = np.asarray(engine.nominal(place))
        share = random.uniform(0.999, 1.001, (count,) + (1,) * nominal.ndim)
        rows[place] = nominal * share
    return rows


@pytest.mark.sampled(16)
@pytest.mark.parametrize("template", TEMPLATES, ids=lambda key: f"{key[0]} {key[1]}")
@pytest.mark.parametrize("count", [2, pytest.param(5, marks=pytest.mark.slow)])
def test_property_rows_of_a_template_equal_designs(template, count):
    cls = CATALOGUES.templates.get(*template)
    # without a level a design starts higher where an input, such as a groove, asks for it
    level = {"level": cls.default_level} if cls.levels else {}
    step = {"template": template[0], "version": template[1], **level, "inputs": dict(cls.example)}
    raw = {"name": cls.id, "steps": {"step": step}}
    engine = engine_of(raw, *(f"step.{name}" for name in quantities(cls)))
    rows = varied(engine, count)
    wanted = [ref(f"step.{name}") for name, one in cls.formulas.items() if not isinstance(one, Text)]
    table = engine(rows, wanted, levels={"step": cls.default_level or None})
    assert assert_equal_to_designs(raw, engine, rows, wanted, table, within=cls.precision) == 0


@pytest.mark.parametrize("model", MODELS, ids=lambda key: f"{key[0]} {key[1]}")
def test_property_rows_of_a_model_equal_designs(model):
    cls = CATALOGUES.models.get(*model)
    raw = {"name": cls.id, "models": {"part": {"id": model[0], "version": model[1]}}}
    raw["models"]["part"]["parameters"] = dict(cls.example)
    engine = engine_of(raw, *(f"part.{name}" for name in quantities(cls)))
    rows = varied(engine, 4)
    names = [n for n, one in cls.inputs.items() if not isinstance(one, (Choice, Table))]
    wanted = [ref(f"part.{name}") for name in names]
    table = engine(rows, wanted)
    assert assert_equal_to_designs(raw, engine, rows, wanted, table) == 0

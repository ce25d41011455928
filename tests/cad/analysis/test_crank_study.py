"""Literature: the signs and the order of the paper's four changes to a crankshaft (Punewale et al. 2015)."""

import pytest

from benchmarks.crank_study import CHANGES, SLENDER
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import regenerate


def stiffness_and_mass(parameters: dict[str, str]) -> tuple[float, float]:
    """By finite elements [N·m/rad], and as measured on the file [kg]."""
    shape = Crankshaft.from_quantities(parameters)
    built, shaft = regenerate("crankshaft", 1, shape.inputs_si()), shape.shaft()
    assert shaft is not None
    result = analyse(built.step, shaft, AnalysisRequest(), ["stiffness"], lambda done, what: None).outputs[
        "stiffness"
    ]
    return result["value"], built.measures["mass"]


@pytest.mark.slow
def test_the_changes_have_the_signs_and_the_order_of_the_paper() -> None:
    base, mass = stiffness_and_mass(SLENDER)
    changed = [stiffness_and_mass({**SLENDER, **change.parameters}) for change in CHANGES]
    pin, journal, throw, face = (stiffness / base - 1 for stiffness, _ in changed)
    assert face > journal > pin > 0 > throw
    gains = [(stiffness / base - 1) / (heavier - mass) for stiffness, heavier in changed]
    assert max(gains) == gains[3]

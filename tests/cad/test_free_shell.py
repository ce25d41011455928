"""The free spread of half shells agrees with measurements that share no code with the model."""

import numpy as np
import pytest

from cad.catalogue import models
from cad.drafting.measures import Measure
from cad.drafting.parameter_match import matched
from cad.regenerate import Build, as_text, regenerate, regenerate_class
from cad.shells.spread import half_angle
from cad.step import read_step
from cad.surfaces import Place, Size
from templates.core.errors import InvalidInputs
from templates.core.language.spec import Choice

CLS = models().get("plain_bearing", 1)
PLAIN = {
    "inner_diameter": "48 mm", "wall": "2.4 mm", "width": "24 mm", "tang_width": "0 mm",
    "oil_groove_width": "0 mm", "oil_groove_depth": "0 mm", "oil_hole_diameter": "0 mm",
    "relief_depth": "0 mm", "inner_chamfer": "0 mm", "outer_chamfer": "0 mm", "shells": "upper",
}  # fmt: skip


def built(**given: str) -> Build:
    return regenerate_class(CLS, as_text(CLS.from_quantities({**PLAIN, **given})))


def refused(**given: str) -> set[str]:
    with pytest.raises(InvalidInputs) as caught:
        as_text(CLS.from_quantities({**PLAIN, **given}))
    return {name for fault in caught.value.faults for name in fault.names}


@pytest.mark.parametrize("crush", ["0 mm", "0.06 mm"])
def test_a_free_shell_is_wider_than_its_seat_by_its_spread(crush: str) -> None:
    """Over the vertices of the finished solid at its joints, as a caliper measures it."""
    build = built(state="free", free_spread="0.64 mm", crush_height=crush)
    back = next(body for body in read_step(build.step) if body.name == "upper_back")
    ends = [vertex.X for vertex in back.shape.Vertices()]
    assert max(ends) - min(ends) == pytest.approx(52.8 + 0.64, abs=1e-6)
    assert build.dimensions["free_spread"] == pytest.approx(0.64, abs=1e-6)


@pytest.mark.parametrize("crush", ["0 mm", "0.06 mm"])
def test_bending_keeps_the_volume_of_a_plain_wall(crush: str) -> None:
    """The middle of the wall keeps its length, so by Pappus back and lining together keep their volume."""
    free, fitted = (built(state=state, crush_height=crush) for state in ("free", "fitted"))
    assert free.measures["volume"] == pytest.approx(fitted.measures["volume"], rel=1e-9)
    assert free.measures["high_x"] > fitted.measures["high_x"]


def test_a_small_spread_approaches_the_shell_in_its_seat() -> None:
    free, fitted = built(state="free", free_spread="0.024 mm"), built(state="fitted")
    for name, value in fitted.measures.items():
        if name in ("volume", "high_x", "high_y", "high_z", "inertia_zz"):
            assert free.measures[name] == pytest.approx(value, rel=1e-3), name


@pytest.mark.slow
def test_equal_parameters_give_equal_bytes() -> None:
    """Once as typed, once from SI as rows hold them, whose last digits differ."""
    model = CLS.from_quantities({**CLS.example, "state": "free"})
    typed = regenerate_class(CLS, as_text(model))
    assert regenerate("plain_bearing", 1, model.inputs_si()) == typed
    assert regenerate("plain_bearing", 1, typed.parameters) == typed


@pytest.mark.parametrize("shells", ["upper", "lower", "pair"])
def test_every_number_is_read_back_from_a_free_shell(shells: str) -> None:
    chosen = {**CLS.example, "state": "free", "shells": shells}
    seen = regenerate_class(CLS, as_text(CLS.from_quantities(chosen))).dimensions
    oil = {name for name in seen if name.startswith("oil_")}
    numbers = {name for name, declared in CLS.inputs.items() if not isinstance(declared, Choice)}
    assert set(seen) | {n for n in numbers if n.startswith("oil_")} == numbers - {"reduction_height"}
    assert bool(oil) == (shells != "lower")


def test_its_spread_changes_no_solid_that_its_housing_holds() -> None:
    """With every feature."""
    spreads = ("0 mm", "0.6 mm")
    one, other = (
        regenerate_class(CLS, as_text(CLS.from_quantities({**CLS.example, "free_spread": spread})))
        for spread in spreads
    )
    assert one.measures == other.measures
    assert one.dimensions == other.dimensions


@pytest.mark.parametrize(("wall", "crush", "spread"), [(0.05, 0.0, 1e-4), (0.05, 0.002, 0.03), (0.2, 0, 0.1)])
def test_the_angle_is_that_of_bisection(wall: float, crush: float, spread: float) -> None:
    """Shells about a bore of 1 m: Newton's method against halving an interval 60 times."""
    length, width = np.pi / 4 * (1 + wall), 1 + 2 * wall + spread
    low, high = 0.5, np.pi / 2
    for _ in range(60):
        angle = (low + high) / 2
        over = 2 * ((length / angle + wall / 2) * np.sin(angle) + crush * np.cos(angle)) > width
        low, high = (angle, high) if over else (low, angle)
    assert float(half_angle(length, wall, crush, width)) == pytest.approx(low, abs=1e-12)
    assert low < np.pi / 2


def test_without_spread_the_arc_is_a_half_circle() -> None:
    model = CLS.from_quantities({**PLAIN, "free_spread": "0 mm"})
    assert float(model.phi_f) == pytest.approx(np.pi / 2, abs=1e-12)
    assert float(model.r_f) == pytest.approx(0.024, rel=1e-12)


@pytest.mark.parametrize(
    "given",
    [
        {"state": "free", "free_spread": "0 mm"},
        {"free_spread": "5 mm"},
        {"state": "free", "free_spread": "1 um"},
    ],
)
def test_a_spread_that_no_shell_has_is_refused_by_name(given: dict[str, str]) -> None:
    assert "free_spread" in refused(**given)


def test_the_default_tang_keeps_off_the_sides_of_the_groove() -> None:
    """A tang of 0.12 of the width has a side in the plane of the groove's, and is refused."""
    given = {"inner_diameter": 0.02205, "width": 0.005806, "oil_hole_diameter": 0.001787}
    assert float(CLS.from_si(given).w_t) == pytest.approx(0.09 * 0.005806)
    with pytest.raises(InvalidInputs, match="planes of the groove"):
        CLS.from_si({**given, "tang_width": 0.12 * given["width"]}).inputs_si()


def test_a_drawing_gives_the_spread_as_a_parameter_and_not_as_another_length() -> None:
    """The lining of the example is as thick as its spread."""
    bore, back = ("upper_lining", 0), ("upper_lining", 1)
    ends = ((0.0, 0.0), (0.0, 0.6))
    measure = Measure("gap", 0.6, "section", "aligned", ends, 1, frozenset({bore}), frozenset({back}))
    sizes = {"lining_thickness": Size(0.6, "distance", Place((bore,), (back,)))}
    texts = {"lining_thickness": "0.6 mm", "free_spread": "0.6 mm"}
    matches, unseen = matched(texts, sizes, [measure], {})
    assert [match.name for match in matches] == ["lining_thickness"]
    assert unseen == ["free_spread"]

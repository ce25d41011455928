"""The assembly has the clearance of the film template, and an interference names the parts."""

from dataclasses import replace

import pytest
from cadquery import Location, Vector

from cad.checks import check_overlaps
from cad.errors import GeometryError
from cad.models.bearing_assembly_v1 import BearingAssembly
from cad.models.plain_bearing_v1 import PlainBearing
from cad.overlaps import gap, overlaps
from cad.regenerate import Build, regenerate
from cad.step import Body, read_step
from templates.core.errors import InvalidInputs
from templates.oil_film.oil_film_v2 import OilFilm

WITHOUT_CRUSH = {**BearingAssembly.example, "crush_height": "0 mm", "housing_bore": "52.855 mm"}


def built(**quantities: str) -> Build:
    chosen = {**WITHOUT_CRUSH, **quantities}
    return regenerate("bearing_assembly", 1, BearingAssembly.from_quantities(chosen).inputs_si())


@pytest.fixture(scope="module")
def bodies() -> dict[str, Body]:
    return {body.name: body for body in read_step(built().step)}


def test_clearance_on_the_solid_is_the_film_templates_input() -> None:
    film = OilFilm.from_quantities(OilFilm.example)
    clearance, size = float(film.c), float(film.D)
    quantities = {"journal_diameter": f"{size - clearance} m", "diametral_clearance": f"{clearance} m"}
    model = BearingAssembly.from_quantities(quantities)
    build = regenerate("bearing_assembly", 1, model.inputs_si())
    assert build.dimensions["diametral_clearance"] == pytest.approx(clearance * 1e3, abs=1e-6)
    by_name = {body.name: body for body in read_step(build.step)}
    for lining in ("upper_lining", "lower_lining"):
        assert gap(by_name["journal"], by_name[lining]) == pytest.approx(clearance * 5e2, abs=1e-6)


def test_parts_that_touch_do_not_interfere(bodies: dict[str, Body]) -> None:
    assert gap(bodies["upper_back"], bodies["block"]) == pytest.approx(0, abs=1e-6)
    assert list(overlaps(list(bodies.values()))) == []


def test_cap_stands_off_by_the_crush_of_both_shells() -> None:
    build = built(crush_height="0.03 mm")
    by_name = {body.name: body for body in read_step(build.step)}
    assert gap(by_name["block"], by_name["cap"]) == pytest.approx(0.06, abs=1e-6)
    assert gap(by_name["upper_back"], by_name["lower_back"]) == pytest.approx(0, abs=1e-6)
    assert build.dimensions["crush_height"] == pytest.approx(0.03, abs=1e-6)


def test_an_interference_names_both_parts(bodies: dict[str, Body]) -> None:
    up = Location(Vector(0, 0.05, 0))
    moved = [replace(body, places=(up,)) if body.name == "journal" else body for body in bodies.values()]
    with pytest.raises(GeometryError) as refused:
        check_overlaps(BearingAssembly.from_quantities(WITHOUT_CRUSH), moved)
    assert refused.value.code == "interference"
    assert "journal and upper_lining overlap by" in refused.value.detail
    assert "lower" not in refused.value.detail


def test_a_tight_housing_is_refused_by_name() -> None:
    with pytest.raises(InvalidInputs) as refused:
        BearingAssembly.from_quantities({**WITHOUT_CRUSH, "housing_bore": "52.8 mm"})
    (fault,) = refused.value.faults
    assert "housing_bore" in fault.names
    assert "interfere" in fault.detail


def test_a_pair_of_shells_is_twice_the_lower_one_but_for_groove_and_hole() -> None:
    plain = {"inner_diameter": "48 mm", "oil_hole_diameter": "0 mm"}
    pair, lower = (
        regenerate("plain_bearing", 1, PlainBearing.from_quantities({**plain, "shells": which}).inputs_si())
        for which in ("pair", "lower")
    )
    assert pair.measures["volume"] == pytest.approx(2 * lower.measures["volume"], rel=1e-9)
    assert pair.measures["low_y"] == -pair.measures["high_y"] == pytest.approx(-26.4, abs=1e-5)

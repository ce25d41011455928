"""Crank models agree with closed forms, symmetry and recorded measurements, and refuse wrong parameters."""

from math import isclose, pi, radians, tan
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from cad.cranks.outline import Outline
from cad.cranks.volume import drilling, fillet
from cad.inspect import look_at
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import Build, regenerate
from cad.shaft import STEEL_DENSITY
from cad.step import read_step
from templates.core.errors import InvalidInputs

# The throw of the references: finite elements and both formulas are known for it.
REFERENCE = {
    "journal_diameter": "55 mm", "journal_length": "40 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "throw": "42 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "3 mm",
}  # fmt: skip
PLAIN = {**REFERENCE, "fillet": "0 mm"}
ONE_PIN = "[0] deg"


def build(cls: Any, given: dict[str, str]) -> Build:
    return regenerate(cls.id, cls.version, cls.from_quantities(given).inputs_si())


def refused(cls: Any, given: dict[str, str]) -> set[str]:
    with pytest.raises(InvalidInputs) as caught:
        cls.from_quantities(given)
    return {name for fault in caught.value.faults for name in fault.names}


class TestClosedForms:
    def test_analytic_polar_inertia_of_a_throw_without_fillets(self) -> None:
        h, R, t = 40.0, 42.0, 18.0
        journals = pi / 2 * 27.5**4 * 40
        pin = pi * 24**2 * 32 * (24**2 / 2 + R**2)
        cap = pi / 2 * h**2 * (h**2 / 2)  # a half disc about the middle of its straight side
        about_pin = cap + pi / 2 * h**2 * R**2 + 2 * R * (2 / 3 * h**3)  # shifted; the arm is along its axis
        web = cap + about_pin + 2 * h * R * (R**2 / 3 + h**2 / 3)
        wanted = STEEL_DENSITY * 1e-15 * (journals + pin + 2 * t * web)
        measures = build(CrankThrow, PLAIN).measures
        assert measures["polar_inertia"] == pytest.approx(wanted, rel=1e-9)
        offset = measures["mass"] * (measures["centre_x"] * 1e-3) ** 2
        assert measures["inertia_zz"] + offset == pytest.approx(wanted, rel=1e-9)

    def test_analytic_fillet_is_the_integral_of_its_section(self) -> None:
        r, f = 24.0, 3.0
        rings, _ = quad(lambda s: 2 * pi * (r + s) * (f - np.sqrt(f**2 - (f - s) ** 2)), 0, f, epsabs=1e-12)
        assert fillet(r, f) == pytest.approx(rings, rel=1e-9)

    def test_analytic_narrow_drilling_is_a_cylinder_from_mouth_to_mouth(self) -> None:
        throw = CrankThrow.from_quantities({**REFERENCE, "oil_drilling_diameter": "0.2 mm"}).drawn()
        run = (42 + 24 + 27.5, 16 + 18 + 10)
        assert drilling(throw) == pytest.approx(pi * 0.1**2 * np.hypot(*run), rel=1e-5)

    @pytest.mark.parametrize("rectangular", [False, True])
    @pytest.mark.parametrize("half_angle", [30, 45, 60, 90])
    def test_analytic_area_is_that_of_the_polygon_along_the_outline(
        self, rectangular: bool, half_angle: float
    ) -> None:
        outline = Outline(42, 40, rectangular, 75, radians(half_angle))
        points = np.concatenate([along(run) for run in outline.runs()])
        x, y = points.T
        shoelace = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2
        assert outline.area == pytest.approx(shoelace, rel=1e-6)

    @pytest.mark.parametrize("rectangular", [False, True])
    @pytest.mark.parametrize("start", [5, 42, 60])
    def test_analytic_moment_beyond_a_line(self, rectangular: bool, start: float) -> None:
        outline = Outline(42, 40, rectangular, 0, 0)

        def width(x: float) -> float:
            return 80.0 if rectangular or x < 42 else 2 * np.sqrt(40**2 - (x - 42) ** 2)

        wanted, _ = quad(lambda x: (x - start) * width(x), start, 82, points=[max(start, 42)], epsrel=1e-11)
        assert outline.moment_beyond(start) == pytest.approx(wanted, rel=1e-8)

    def test_analytic_inclination_takes_a_wedge_off_a_rectangular_web(self) -> None:
        flat = {**REFERENCE, "web_shape": "rectangular"}
        whole, less = (build(CrankThrow, {**flat, "face_inclination": f"{b} deg"}) for b in (0, 10))
        length = 42 + 40 - (0.51 * 55 + 3)
        wedges = 2 * 80 * length**2 / 2 * tan(radians(10))
        assert whole.measures["volume"] - less.measures["volume"] == pytest.approx(wedges, rel=1e-9)

    def test_analytic_bores_through_everything(self) -> None:
        given = {"pin_angles": ONE_PIN, "journal_diameter": "40 mm", "throw": "45 mm"}
        solid, bored = (build(Crankshaft, {**given, "journal_bore": bore}) for bore in ("0 mm", "10 mm"))
        length = bored.measures["high_z"] - bored.measures["low_z"] - 0.6 * 40  # not where the pin is beside
        gone = solid.measures["volume"] - bored.measures["volume"]
        assert gone == pytest.approx(pi * 5**2 * length, rel=1e-8)


def along(run: tuple[tuple[float, float], ...]) -> Any:
    """Points along a line or an arc, without its end."""
    if len(run) == 2:
        return np.array(run[:1])
    (x1, y1), (x2, y2), (x3, y3) = run
    matrix = np.array([[x2 - x1, y2 - y1], [x3 - x1, y3 - y1]])
    centre = np.linalg.solve(2 * matrix, [x2**2 + y2**2 - x1**2 - y1**2, x3**2 + y3**2 - x1**2 - y1**2])
    start, middle, end = (np.arctan2(y - centre[1], x - centre[0]) for x, y in run)
    turn = (end - start) % (2 * pi)
    turn = turn if (middle - start) % (2 * pi) < turn else turn - 2 * pi
    angles = start + turn * np.linspace(0, 1, 4000, endpoint=False)
    radius = np.hypot(x1 - centre[0], y1 - centre[1])
    return np.stack([centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)], axis=1)


class TestSolids:
    def test_throw_without_drilling_is_its_own_mirror_image(self) -> None:
        measures = build(CrankThrow, {**CrankThrow.example, "oil_drilling_diameter": "0 mm"}).measures
        for name in ("centre_y", "centre_z"):
            assert measures[name] == pytest.approx(0, abs=1e-9)
        for name in ("inertia_xy", "inertia_xz", "inertia_yz"):
            assert measures[name] == pytest.approx(0, abs=1e-10)

    def test_pin_lies_on_the_side_of_x(self) -> None:
        assert build(CrankThrow, REFERENCE).measures["high_x"] == 82
        assert build(CrankThrow, REFERENCE).measures["low_x"] == -40

    def test_counterweight_moves_the_centre_towards_the_shaft(self) -> None:
        plain, balanced = (
            build(CrankThrow, {**REFERENCE, "counterweight_radius": r}) for r in ("0 mm", "85 mm")
        )
        assert plain.measures["centre_x"] > balanced.measures["centre_x"]
        assert balanced.dimensions["counterweight_angle"] == 120
        assert "counterweight_angle" not in plain.dimensions

    def test_less_inclination_is_more_material(self) -> None:
        masses = [
            build(CrankThrow, {"journal_diameter": "40 mm", "face_inclination": f"{angle} deg"}).measures[
                "mass"
            ]
            for angle in (0, 5, 10, 15)
        ]
        assert (np.diff(masses) < 0).all()

    def test_overlap_and_its_absence(self) -> None:
        for throw, overlap in (("42 mm", 9.5), ("51.5 mm", 0.0), ("70 mm", -18.5)):
            model = CrankThrow.from_quantities({**REFERENCE, "throw": throw})
            assert 1e3 * model.s == pytest.approx(overlap, abs=1e-9)
            assert build(CrankThrow, {**REFERENCE, "throw": throw}).dimensions["throw"] == float(throw[:-3])

    def test_nose_and_flange_are_where_they_should_be(self) -> None:
        given = {"journal_diameter": "40 mm", "nose_length": "50 mm", "flange_thickness": "20 mm"}
        measures = build(Crankshaft, {**given, "pin_angles": ONE_PIN, "flange_diameter": "90 mm"}).measures
        journal, rest = 0.7 * 40, (0.6 + 2 * 0.33) * 40  # rest: of the pitch
        assert measures["low_z"] == pytest.approx(-journal / 2 - 50, abs=1e-6)
        assert measures["high_z"] == pytest.approx(rest + 1.5 * journal + 20, abs=1e-6)
        assert measures["high_y"] == 45

    def test_end_as_thick_as_the_journal_is_separated_from_it(self) -> None:
        given = {"pin_angles": ONE_PIN, "journal_diameter": "40 mm", "flange_diameter": "40 mm"}
        result = build(Crankshaft, given).dimensions
        assert (result["flange_diameter"], result["flange_thickness"]) == (40, 12)
        assert result["journal_length"] == 28

    @pytest.mark.slow
    def test_drilling_whose_mouth_touches_the_bore_at_the_web_is_whole(self) -> None:
        # With bores drawn part by part, OpenCASCADE lost nearly all of this shaft.
        given = {
            "journal_diameter": "3.7156 mm", "pin_length": "1.8532 mm", "web_thickness": "1.6412 mm",
            "web_width": "5.8961 mm", "journal_bore": "1.8398 mm", "pin_bore": "0.5687 mm",
            "oil_drilling_diameter": "0.3936 mm", "web_shape": "rectangular", "nose_length": "1.8361 mm",
            "flange_diameter": "2.4562 mm", "flange_thickness": "2.97248 mm", "pin_angles": ONE_PIN,
        }  # fmt: skip
        for width in np.linspace(0.39, 0.396, 7):
            drilled = build(Crankshaft, {**given, "oil_drilling_diameter": f"{width:.4f} mm"})
            assert isclose(drilled.dimensions["oil_drilling_diameter"], width, abs_tol=1e-6)

    @pytest.mark.parametrize("given", [CrankThrow.example, REFERENCE, PLAIN])
    def test_surfaces_are_those_of_a_drawing(self, given: dict[str, str]) -> None:
        seen = look_at(read_step(build(CrankThrow, dict(given)).step))["crank_throw"]
        assert len(seen.tori) == (0 if given is PLAIN else 4)


class TestRefusals:
    @pytest.mark.parametrize(
        ("given", "named"),
        [
            ({"journal_bore": "55 mm"}, {"journal_bore", "journal_diameter"}),
            ({"pin_bore": "48 mm"}, {"pin_bore", "pin_diameter"}),
            ({"pin_bore": "24 mm"}, {"pin_bore", "journal_diameter", "throw", "fillet"}),
            ({"journal_bore": "30 mm"}, {"journal_bore", "pin_diameter", "throw", "fillet"}),
            ({"throw": "0 mm"}, {"throw"}),
            ({"throw": "0.2 mm"}, {"throw", "journal_diameter"}),
            ({"web_width": "55 mm"}, {"web_width", "journal_diameter", "fillet"}),
            ({"pin_diameter": "78 mm"}, {"web_width", "pin_diameter", "fillet"}),
            ({"fillet": "13 mm"}, {"fillet", "web_width"}),
            ({"fillet": "15 mm", "web_width": "100 mm"}, {"fillet", "pin_length"}),
            ({"fillet": "19 mm", "pin_length": "60 mm", "web_width": "120 mm"}, {"fillet", "journal_length"}),
            ({"fillet": "10 nm"}, {"fillet", "journal_diameter"}),
            ({"oil_drilling_diameter": "25 mm"}, {"oil_drilling_diameter", "pin_diameter"}),
            ({"oil_drilling_diameter": "20 mm"}, {"oil_drilling_diameter", "pin_length", "journal_length"}),
            (
                {"oil_drilling_diameter": "5 mm", "pin_length": "90 mm"},
                {"oil_drilling_diameter", "pin_length"},
            ),
            ({"oil_drilling_diameter": "5 mm", "throw": "300 mm"}, {"oil_drilling_diameter", "pin_diameter"}),
            ({"oil_drilling_diameter": "5 mm", "pin_bore": "5 mm"}, {"oil_drilling_diameter", "pin_bore"}),
            ({"counterweight_radius": "40 mm"}, {"counterweight_radius", "web_width", "web_shape"}),
            (
                {"counterweight_radius": "85 mm", "counterweight_angle": "179.95 deg"},
                {"counterweight_angle", "web_shape"},
            ),
            ({"counterweight_angle": "0 deg"}, {"counterweight_angle"}),
            ({"counterweight_angle": "360 deg"}, {"counterweight_angle"}),
            ({"face_inclination": "90 deg"}, {"face_inclination"}),
            ({"face_inclination": "20 deg"}, {"face_inclination", "web_thickness"}),
            ({"face_inclination": "1e-5 deg"}, {"face_inclination"}),
            ({"web_shape": "round"}, {"web_shape"}),
        ],
    )
    def test_what_cannot_be_built_is_refused_by_name(self, given: dict[str, str], named: set[str]) -> None:
        assert named <= refused(CrankThrow, {**REFERENCE, **given})

    @pytest.mark.parametrize(
        ("given", "named"),
        [
            ({"nose_diameter": "10 mm", "journal_bore": "12 mm"}, {"nose_diameter", "journal_bore"}),
            ({"flange_diameter": "40.001 mm"}, {"flange_diameter", "journal_diameter"}),
            ({"flange_thickness": "0 mm"}, {"flange_thickness"}),
        ],
    )
    def test_ends_that_cannot_be_built(self, given: dict[str, str], named: set[str]) -> None:
        shaft = {"pin_angles": ONE_PIN, "journal_diameter": "40 mm", "throw": "45 mm"}
        assert named <= refused(Crankshaft, {**shaft, **given})

"""What holds for one model: standard sizes, limits that are known in closed form, and rules."""

from math import isclose, pi
from typing import Any

import numpy as np
import pytest
from netgen.occ import OCCGeometry

from cad.inspect import look_at
from cad.models.ball_bearing_v1 import SIZES, BallBearing, standard_outer_diameter, standard_width
from cad.models.plain_bearing_v1 import PlainBearing, Shell
from cad.regenerate import Build, regenerate
from cad.step import read_step
from templates.core.errors import InvalidInputs

QUICK = SIZES[[0, len(SIZES) // 3, len(SIZES) // 2, -1]]


def build(cls: Any, **quantities: str) -> Build:
    return regenerate(cls.id, cls.version, cls.from_quantities(quantities).inputs_si())


def faults(cls: Any, **quantities: str) -> dict[str, str]:
    with pytest.raises(InvalidInputs) as refused:
        cls.from_quantities({"inner_diameter": "48 mm", **quantities})
    return {name: fault.detail for fault in refused.value.faults for name in fault.names}


class TestBallBearing:
    def size(self, row: Any) -> None:
        """A row of the table builds, and every number of it is read back from the STEP file."""
        names = ("inner_diameter", "outer_diameter", "width")
        result = build(BallBearing, **{name: f"{row[name]} mm" for name in names}).dimensions
        assert [result[name] for name in names] == [row[name] for name in names]

    @pytest.mark.parametrize("row", QUICK, ids=lambda row: row["designation"])
    def test_literature_some_standard_sizes_build(self, row: Any) -> None:
        self.size(row)

    @pytest.mark.slow
    @pytest.mark.parametrize("row", SIZES, ids=lambda row: row["designation"])
    def test_literature_all_standard_sizes_build(self, row: Any) -> None:
        self.size(row)

    @pytest.mark.parametrize(
        ("bore", "outside", "width"), [(3, 10, 4), (25, 52, 15), (50, 90, 20), (300, 540, 85)]
    )
    def test_literature_series_02_of_iso_15(self, bore: int, outside: int, width: int) -> None:
        result = build(BallBearing, inner_diameter=f"{bore} mm").dimensions
        assert (result["outer_diameter"], result["width"]) == (outside, width)

    def test_6210_has_about_the_mass_of_a_catalogue(self) -> None:
        # SKF 6210: 0.46 kg with its cage and 10 balls of 12.7 mm. Ours has no cage, and 11 balls of 12 mm.
        assert build(BallBearing, inner_diameter="50 mm").measures["mass"] == pytest.approx(0.46, rel=0.05)

    def test_size_between_standard_bores_lies_between(self) -> None:
        assert standard_outer_diameter(np.float64(0.048)) == pytest.approx(0.088)  # 45: 85, 50: 90
        assert standard_width(np.float64(0.048)) == pytest.approx(0.0196)

    def test_size_beyond_the_table_keeps_its_proportions(self) -> None:
        assert standard_outer_diameter(np.float64(0.6)) == pytest.approx(2 * 0.540)
        assert standard_width(np.float64(0.0015)) == pytest.approx(0.004 / 2)

    def test_outside_grows_with_the_bore(self) -> None:
        bores = np.linspace(1e-3, 2, 5000)
        assert (np.diff(standard_outer_diameter(bores)) > 0).all()

    def test_no_cylinder_is_smaller_than_the_bore(self) -> None:
        seen = look_at(read_step(build(BallBearing, inner_diameter="50 mm").step))
        assert min(cylinder.diameter for part in seen.values() for cylinder in part.cylinders) == 50

    def test_second_kernel_finds_the_bore(self, tmp_path: Any) -> None:
        file = tmp_path / "bearing.step"
        file.write_bytes(build(BallBearing, inner_diameter="37.123456 mm").step)
        boxes = [face.bounding_box for face in OCCGeometry(str(file)).shape.faces]
        spans = [high[0] - low[0] for low, high in boxes]
        assert any(isclose(span, 37.123456, abs_tol=1e-6) for span in spans)

    def test_wanted_inside_is_drawn(self) -> None:
        result = build(BallBearing, inner_diameter="50 mm", balls="10", ball_diameter="12.7 mm").dimensions
        assert (result["balls"], result["ball_diameter"]) == (10, 12.7)

    def test_turns_alike_in_all_directions(self) -> None:
        measures = build(BallBearing, inner_diameter="50 mm").measures
        assert measures["inertia_xx"] == pytest.approx(measures["inertia_yy"], rel=1e-7)
        assert [measures[f"centre_{axis}"] for axis in "xyz"] == pytest.approx([0, 0, 0], abs=1e-9)

    @pytest.mark.parametrize(
        ("given", "named"),
        [
            ({"outer_diameter": "48 mm"}, {"outer_diameter", "inner_diameter"}),
            ({"outer_diameter": "40 mm"}, {"outer_diameter", "inner_diameter"}),
            ({"ball_diameter": "20 mm"}, {"ball_diameter", "outer_diameter", "inner_diameter", "width"}),
            ({"ball_diameter": "19 mm", "width": "40 mm"}, {"ball_diameter", "outer_diameter"}),
            ({"ball_diameter": "13 mm", "width": "12 mm"}, {"ball_diameter", "width"}),
            ({"balls": "19"}, {"balls", "ball_diameter", "outer_diameter", "inner_diameter"}),
            ({"balls": "1000000000"}, {"balls"}),
            ({"balls": "7.5"}, {"balls"}),
            ({"width": "0 mm"}, {"width"}),
        ],
    )
    def test_what_cannot_be_built_is_refused_by_name(self, given: dict[str, str], named: set[str]) -> None:
        assert named <= set(faults(BallBearing, **given))


class TestPlainBearing:
    @pytest.mark.parametrize("shell", ["half", "full"])
    @pytest.mark.parametrize("hole", ["0 mm", "3 mm", "5 mm", "5.1 mm", "12 mm"])
    @pytest.mark.parametrize(("groove", "depth"), [("0 mm", "0 mm"), ("5 mm", "0 mm"), ("5 mm", "0.8 mm")])
    @pytest.mark.sampled(8)
    def test_every_combination_is_the_solid_it_should_be(
        self, shell: str, hole: str, groove: str, depth: str
    ) -> None:
        result = build(
            PlainBearing, inner_diameter="48 mm", shell=shell, oil_hole_diameter=hole,
            oil_groove_width=groove, oil_groove_depth=depth,
        )  # fmt: skip
        assert f"{result.dimensions['oil_hole_diameter']:g} mm" == hole
        assert result.dimensions.get("oil_groove_depth", 0.0) == (0.8 if depth == "0.8 mm" else 0.0)
        assert result.measures["low_y"] == (0 if shell == "half" else -26.4)

    def test_analytic_half_ring(self) -> None:
        result = build(PlainBearing, inner_diameter="48 mm", oil_hole_diameter="0 mm").measures
        outer, inner = 26.4, 24.0
        assert result["volume"] == pytest.approx(pi / 2 * (outer**2 - inner**2) * 24, rel=1e-9)
        centroid = 4 / (3 * pi) * (outer**3 - inner**3) / (outer**2 - inner**2)
        assert result["centre_y"] == pytest.approx(centroid, rel=1e-9)

    def test_analytic_two_halves_are_a_whole(self) -> None:
        half, full = (build(PlainBearing, inner_diameter="48 mm", shell=shell) for shell in ("half", "full"))
        hole = Shell(24, 24.72, 26.4, 12, 2.4, 1.92, 180).hole_volume()
        assert full.measures["volume"] == pytest.approx(2 * half.measures["volume"] + hole, rel=1e-6)

    def test_analytic_small_hole_is_a_cylinder_through_the_wall(self) -> None:
        shell = Shell(bore=24, groove=24, outside=26, half_width=10, half_groove=0, hole=1e-4, turn=360)
        assert shell.hole_volume() == pytest.approx(pi * 1e-8 * 2, rel=1e-6)

    def test_analytic_groove_wider_than_the_hole_is_a_larger_bore(self) -> None:
        deep = Shell(bore=24, groove=25, outside=26, half_width=10, half_groove=5, hole=4, turn=360)
        wide = Shell(bore=25, groove=25, outside=26, half_width=10, half_groove=0, hole=4, turn=360)
        assert deep.hole_volume() == pytest.approx(wide.hole_volume(), rel=1e-10)

    @pytest.mark.parametrize(
        ("given", "named"),
        [
            ({"wall": "0 mm"}, {"wall"}),
            ({"wall": "-1 mm"}, {"wall"}),
            ({"oil_hole_diameter": "24 mm"}, {"oil_hole_diameter", "width"}),
            ({"oil_hole_diameter": "47 mm", "width": "100 mm"}, {"oil_hole_diameter", "inner_diameter"}),
            (
                {"oil_hole_diameter": "5.00001 mm", "oil_groove_width": "5 mm"},
                {"oil_hole_diameter", "oil_groove_width"},
            ),
            ({"oil_hole_diameter": "1 nm"}, {"oil_hole_diameter"}),
            ({"oil_groove_depth": "2.4 mm"}, {"oil_groove_depth", "wall"}),
            ({"oil_groove_width": "23 mm"}, {"oil_groove_width", "width"}),
            (
                {"oil_groove_width": "0 mm", "oil_groove_depth": "1 mm"},
                {"oil_groove_width", "oil_groove_depth"},
            ),
            ({"shell": "third"}, {"shell"}),
            ({"colour": "red"}, {"colour"}),
        ],
    )
    def test_what_cannot_be_built_is_refused_by_name(self, given: dict[str, str], named: set[str]) -> None:
        assert named <= set(faults(PlainBearing, **given))

    def test_refusal_says_the_values_and_the_remedy(self) -> None:
        detail = faults(PlainBearing, oil_groove_depth="2.4 mm")["oil_groove_depth"]
        assert "2.4 mm" in detail
        assert "shallower" in detail

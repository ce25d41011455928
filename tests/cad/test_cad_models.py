"""Single models agree with standard sizes and closed forms at their limits, and obey their rules."""

from math import isclose
from typing import Any

import numpy as np
import pytest
from netgen.occ import OCCGeometry

from cad.inspect import look_at
from cad.models.ball_bearing_v1 import SIZES, BallBearing, standard_outer_diameter, standard_width
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

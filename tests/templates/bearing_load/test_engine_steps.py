"""Greatest loads, energy and mean torque do not depend on the step at which curves are returned.

References: the case list (values at 1 deg), curves at 0.1 deg, work by geometry that no template holds.
"""

import numpy as np
import pytest
from test_engine_random_layouts import CRANKCASE, KINDS, engine

from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.bearing_load.engine_v1 import Engine
from templates.bearing_load.flywheel_v1 import Flywheel
from templates.core.language.evaluate import evaluate

FOUR = {
    **{name: value for name, value in Engine.example.items() if name not in {
        "masters", "articulation_radius", "articulation_angle", "pin_angles", "bank_angles", "throws",
        "crank_radius",
    }},
    "firing_order": [1, 3, 4, 2], "stroke": "86 mm", "rod_length": "145 mm", "cylinder_offset": "1 mm",
    "cylinder_positions": {"value": [47, 141, 235, 329], "unit": "mm"},
    "rod_mass": "0.6 kg", "rod_centre": "42 mm", "rod_inertia": "2200 kg*mm**2",
    "main_positions": {"value": [0, 94, 188, 282, 376], "unit": "mm"},
    "web_positions": {"value": [22, 72, 116, 166, 210, 260, 304, 354], "unit": "mm"},
}  # fmt: skip
LOADS = {"crankpin_load_max": "crankpin_load", "main_load_max": "main_load",
         "shaking_force_max": "shaking_force"}  # fmt: skip


def values(cls, raw, names):
    return {n: np.asarray(o.value) for n, o in evaluate(cls, raw, outputs=list(names)).outputs.items()}


def codes(cls, raw):
    return {notice.code for notice in evaluate(cls, raw).warnings}


class TestCases:
    """The examples that answered a third low at their steps of 60 deg."""

    def test_the_articulated_example(self):
        out = values(Engine, Engine.example, ["mean_torque", "crankpin_load_max"])
        assert out["mean_torque"] == pytest.approx(81.4, abs=0.05)
        assert out["crankpin_load_max"].max() == pytest.approx(24.8e3, abs=50)

    def test_the_example_in_line(self):
        assert values(Engine, FOUR, ["mean_torque"])["mean_torque"] == pytest.approx(160.7, abs=0.05)

    @pytest.mark.parametrize("cls", [Engine, BearingLoad, Flywheel])
    def test_curves_above_five_degrees_carry_a_warning(self, cls):
        assert "coarse_curves" not in codes(cls, {**cls.example, "crank_angle_step": "5 deg"})
        assert "coarse_curves" in codes(cls, {**cls.example, "crank_angle_step": "6 deg"})


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("kind", KINDS)
class TestRandomEngines:
    """Engines of unequal, offset cylinders, each with its own factor of the pressure."""

    def test_property_the_step_changes_no_greatest_value(self, kind, seed):
        """Against the largest of curves at 0.1 deg; energy converges with the square of the grid's step."""
        raw, _ = engine(kind, seed)
        names = [*LOADS, "energy_fluctuation"]
        coarse = values(Engine, {**raw, "crank_angle_step": "60 deg"}, names)
        for name, value in values(Engine, {**raw, "crank_angle_step": "5 deg"}, names).items():
            assert value == pytest.approx(coarse[name], rel=1e-12), name
        fine = {**raw, "crank_angle_step": "0.1 deg"}
        for name, curve in LOADS.items():
            x, y = values(Engine, fine, [f"{curve}_x", f"{curve}_y"]).values()
            share = coarse[name] / np.hypot(x, y).max(axis=-1)
            assert np.all((share > 1 - 5e-4) & (share < 1 + 2e-3)), name  # the curve may miss a jump
        energy = values(Engine, fine, ["energy_fluctuation"])["energy_fluctuation"]
        assert coarse["energy_fluctuation"] == pytest.approx(energy, rel=5e-4)

    def test_second_method_mean_torque_is_the_work_of_each_piston(self, kind, seed):
        """Sum of the integrals of (p f - p0) A ds with the pistons' ways from geometry alone."""
        raw, layout = engine(kind, seed)
        fine = {**raw, "crank_angle_step": "0.1 deg"}
        out = values(Engine, fine, ["gas_pressure", "crankpin_angles", "mean_torque"])
        r, length, e, bore = (
            np.array(raw[name]["value"])[:, None]
            for name in ("crank_radius", "rod_length", "cylinder_offset", "bore")
        )
        theta = np.radians(np.arange(0, layout.cycle, 0.1))
        pin = r * np.exp(1j * (theta + np.radians(out["crankpin_angles"])[:, None] - layout.bank[:, None]))
        s = pin.real + np.sqrt(length**2 - (e - pin.imag) ** 2)
        factor = np.array(raw["pressure_factor"])[:, None]
        force = (np.atleast_2d(out["gas_pressure"]) * 1e5 * factor - CRANKCASE) * np.pi * bore**2 / 4
        after = np.roll(force, -1, axis=1)
        work = -((force + after) / 2 * (np.roll(s, -1, axis=1) - s)).sum()
        assert out["mean_torque"] == pytest.approx(work / np.radians(layout.cycle), rel=2e-4)


class TestJumps:
    def test_property_energy_closes_whatever_the_jumps(self):
        """The running integral returns to its first value: the last area ends where the first begins."""
        for gas in (
            {"gas_cycle": "otto"},
            {"exhaust_opens": "560 deg"},
            {"gas_cycle": "diesel", "cutoff": 2},
        ):
            grid = evaluate(Engine, {**FOUR, **gas}).template
            running, T = grid.energies, grid.torques
            order = np.argsort(grid.grid.theta)
            angles = np.append(grid.grid.theta[order], 4 * np.pi)
            swing = np.append(T[order], T[order][0])
            mean = np.trapezoid(swing, angles) / (4 * np.pi)
            closing = running[order][-1] + (swing[-2:].mean() - mean) * np.diff(angles)[-1]
            assert abs(closing) < 1e-9 * np.abs(running).max()

    def test_analytic_a_spike_of_a_table_is_not_missed(self):
        """A pressure of 90 bar for 0.02 deg at 372.43 deg: the axial force there, in closed form."""
        angle = [0, 100, 200, 300, 340, 372.42, 372.43, 372.44, 420, 500, 600, 700]
        p = [1, 1, 1, 8, 18, 40, 90, 40, 12, 4, 1, 1]
        raw = {
            **BearingLoad.example, "gas_cycle": "table", "pressure_angle": {"value": angle, "unit": "deg"},
            "pressure": {"value": p, "unit": "bar"},
        }  # fmt: skip
        out = values(BearingLoad, raw, ["wristpin_load_max", "peak_gas_pressure"])
        assert out["peak_gas_pressure"] == pytest.approx(90, rel=1e-9)
        theta, r, n = np.radians(12.43), 0.043, 3.4
        q = np.sqrt(n**2 - np.sin(theta) ** 2)
        a = -((3000 * np.pi / 30) ** 2) * r * (
            np.cos(theta) + ((n**2 - 1) * np.cos(2 * theta) + np.cos(theta) ** 4) / q**3
        )  # fmt: skip
        along = 0.48 * a + 89e5 * np.pi / 4 * 0.086**2
        assert out["wristpin_load_max"] == pytest.approx(along * np.hypot(1, np.sin(theta) / q), rel=0.002)
        for step in ("0.5 deg", "5 deg"):
            again = values(BearingLoad, {**raw, "crank_angle_step": step}, ["wristpin_load_max"])
            assert again["wristpin_load_max"] == pytest.approx(out["wristpin_load_max"], rel=1e-9)

    @pytest.mark.parametrize("cls", [Engine, BearingLoad, Flywheel])
    def test_property_points_with_jumps_of_their_own(self, cls):
        """Each point of an array answers as it does alone, with its own valve timing and cut."""
        raw = {**cls.example, "gas_cycle": "four_stroke", "combustion_pressure": "70 bar",
               "exhaust_opens": "492 deg", "crank_angle_step": "20 deg"}  # fmt: skip
        names = [n for n in cls.formulas if n.endswith("_max") or n.startswith(("energy_fl", "mean_t"))]
        names += [n for n in ("torque", "running_energy", "energy_area") if n in cls.formulas]
        varied = {"cutoff": [1.1, 1.2, 1.3], "exhaust_opens": ["480 deg", "492 deg", "555 deg"]}
        for name, points in varied.items():
            given = points if name == "cutoff" else {"value": [480, 492, 555], "unit": "deg"}
            many = values(cls, {**raw, name: given}, names)
            for k, point in enumerate(points):
                alone = values(cls, {**raw, name: point}, names)
                for output in names:
                    one, other = many[output][k] if many[output].ndim else many[output], alone[output]
                    scale = np.abs(other).max()
                    assert one == pytest.approx(other, rel=1e-9, abs=1e-9 * scale), (name, output)


class TestSilentOptimism:
    """What is left out, or read in one of two ways, is said in the answer."""

    WEIGHTS = {Engine: ("web_unbalance", "counterweights"),
               BearingLoad: ("crankpin_mass", "crank_mass", "counterweight_mass"),
               Flywheel: ("crankpin_mass", "crank_mass", "counterweight_mass")}  # fmt: skip

    @pytest.mark.parametrize("cls", [Engine, BearingLoad, Flywheel])
    def test_a_crank_that_weighs_nothing_is_named(self, cls):
        bare = {name: value for name, value in cls.example.items() if name not in self.WEIGHTS[cls]}
        assert "massless_crank" in codes(cls, bare)
        assert "massless_crank" not in codes(cls, cls.example)

    @pytest.mark.parametrize("cls", [Engine, BearingLoad, Flywheel])
    def test_a_crankcase_without_air_is_named(self, cls):
        """Absolute pressures of the cycle and none in the crankcase: loads too large by an atmosphere."""
        bare = {name: value for name, value in cls.example.items() if name != "crankcase_pressure"}
        assert "vacuum_in_crankcase" in codes(cls, bare)
        assert "vacuum_in_crankcase" not in codes(cls, cls.example)

    @pytest.mark.parametrize("cls", [Engine, BearingLoad, Flywheel])
    @pytest.mark.parametrize(
        ("lowest", "crankcase", "is_named"),
        [(0.9, "0 bar", True), (0.9, "1 bar", False), (-0.1, "0 bar", False), (-0.1, "1 bar", True)],
    )
    def test_a_table_and_a_crankcase_of_two_kinds_are_named(self, cls, lowest, crankcase, is_named):
        angle = np.arange(0, 720, 15)
        p = lowest + 40 * np.exp(-(((angle - 370) / 40) ** 2))
        raw = {**cls.example, "gas_cycle": "table", "crankcase_pressure": crankcase,
               "pressure": {"value": p.tolist(), "unit": "bar"}}  # fmt: skip
        assert ("gauge_or_absolute" in codes(cls, raw)) == is_named

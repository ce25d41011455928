"""engine: articulated rods against the energy of rigid bodies, mains with play against exact bars."""

import numpy as np
import pytest

from benchmarks.in_line_four import IN_LINE_FOUR
from templates.bearing_load.engine_v1 import Engine
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.crankshaft.crank_supports import Flexibility, support_reactions
from templates.physics.crankshaft.main_bearings import ShaftLoads, elastic_loads
from templates.physics.crankshaft.main_clearance import supports_of, with_play

FOUR = {**IN_LINE_FOUR, "crank_angle_step": "5 deg", "cylinder_offset": "0 mm"}
OMEGA = 4500 * np.pi / 30


def mm(*values):
    return {"value": list(values), "unit": "mm"}


def deg(*values):
    return {"value": list(values), "unit": "deg"}


V_TWO = {
    **FOUR,
    "crank_angle_step": "1 deg",
    "gas_cycle": "none",
    "firing_order": [1, 2],
    "pin_angles": deg(10, 10),
    "bank_angles": deg(0, 60),
    "throws": [1, 1],
    "masters": [0, 1],
    "articulation_radius": "40 mm",
    "articulation_angle": "62 deg",
    "cylinder_positions": mm(47, 47),
    "cylinder_offset": mm(7, 0),
    "crank_radius": "43 mm",
    "rod_length": mm(145, 105),
    "rod_mass": {"value": [0.6, 0.35], "unit": "kg"},
    "rod_centre": mm(42, 35),
    "rod_inertia": {"value": [2200, 600], "unit": "kg*mm**2"},
    "piston_mass": {"value": [0.48, 0.45], "unit": "kg"},
    "main_positions": mm(0, 94),
    "web_positions": mm(22, 72),
}
del V_TWO["stroke"]
RADIAL = {
    **V_TWO,
    "firing_order": [1, 3, 5, 2, 4],
    "pin_angles": deg(0, 0, 0, 0, 0),
    "bank_angles": deg(0, 72, 144, 216, 288),
    "throws": [1] * 5,
    "masters": [0, 1, 1, 1, 1],
    "articulation_angle": deg(0, 72, 144, 216, 288),
    "cylinder_positions": mm(*[47] * 5),
    "cylinder_offset": "0 mm",
    "rod_length": mm(145, *[105] * 4),
    "rod_mass": {"value": [0.6, *[0.35] * 4], "unit": "kg"},
    "rod_centre": mm(42, *[35] * 4),
    "rod_inertia": {"value": [2200, *[600] * 4], "unit": "kg*mm**2"},
    "piston_mass": "0.45 kg",
}
ARTICULATED = pytest.mark.parametrize("raw", [V_TWO, RADIAL], ids=["V2", "radial 5"])


def run(raw, outputs=None):
    return evaluate(Engine, raw, outputs=outputs)


def values(raw, outputs=None):
    return {name: answer.value for name, answer in run(raw, outputs).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        run(raw)
    return {name: fault.detail for fault in refusal.value.faults for name in fault.names}


def vectors(out, name):
    return out[f"{name}_x"] + 1j * out[f"{name}_y"]


def slope(curve, turns=2):
    """The derivative by the crank angle of a curve over so many turns, by its Fourier series."""
    waves = 1j * np.fft.fftfreq(curve.size, 1 / curve.size) / turns
    return np.fft.ifft(waves * np.fft.fft(curve)).real


class Bodies:
    """The rigid bodies of an engine, built from their geometry alone, in the engine's axes."""

    def __init__(self, raw, theta):
        count = len(raw["throws"])

        def each(name, factor):
            given = raw[name]["value"] if isinstance(raw[name], dict) else float(str(raw[name]).split()[0])
            return np.broadcast_to(np.asarray(given, dtype=float) * factor, count)

        r, pin = 0.043, np.radians(raw["pin_angles"]["value"][0])
        crank = r * np.exp(1j * (theta + pin))
        self.points, self.turns, lengths = [], [], each("rod_length", 1e-3)
        offsets, banks = each("cylinder_offset", 1e-3), np.radians(raw["bank_angles"]["value"])
        for j, master in enumerate(raw["masters"]):
            foot = crank
            if master:
                rod = self.points[master - 1][1] - crank
                arm = each("articulation_radius", 1e-3)[j]
                gamma = np.radians(each("articulation_angle", 1.0))[j]
                foot = crank + arm * rod / np.abs(rod) * np.exp(1j * gamma)
            own = foot * np.exp(-1j * banks[j])
            lean = own.imag - offsets[j]
            wrist = own.real + np.sqrt(lengths[j] ** 2 - lean**2) + 1j * offsets[j]
            wrist = wrist * np.exp(1j * banks[j])
            self.points.append((foot, wrist))
            self.turns.append(np.unwrap(np.angle(wrist - foot)))
        self.lengths = lengths
        self.centres = each("rod_centre", 1e-3)
        self.masses, self.pistons = each("rod_mass", 1.0), each("piston_mass", 1.0)
        self.inertias = each("rod_inertia", 1e-6)

    def moving(self):
        """Yield mass, place, inertia and angle of each body."""
        for j, (foot, wrist) in enumerate(self.points):
            centre = foot + (wrist - foot) * self.centres[j] / self.lengths[j]
            yield self.masses[j], centre, self.inertias[j], self.turns[j]
            yield self.pistons[j], wrist, 0.0, np.zeros(foot.size)

    def energy(self):
        return sum(
            (m * np.abs(_complex_slope(place)) ** 2 + inertia * _free_slope(turn) ** 2) / 2 * OMEGA**2
            for m, place, inertia, turn in self.moving()
        )

    def momentum(self):
        return sum(m * _complex_slope(place) for m, place, *_ in self.moving()) * OMEGA

    def angular_momentum(self):
        return sum(
            m * (np.conj(place) * _complex_slope(place)).imag + inertia * _free_slope(turn)
            for m, place, inertia, turn in self.moving()
        ) * OMEGA  # fmt: skip


def _complex_slope(curve):
    return slope(curve.real) + 1j * slope(curve.imag)


def _free_slope(turn):
    return slope(turn)


class TestArticulated:
    @ARTICULATED
    def test_conservation_torque_is_the_change_of_energy_of_rigid_bodies(self, raw):
        out = values(raw, ["torque", "crank_angle"])
        energy = Bodies(raw, np.radians(out["crank_angle"])).energy()
        assert np.abs(out["torque"] + slope(energy)).max() < 1e-10 * energy.max()  # two series lose digits
        assert np.abs(out["torque"]).max() > 0.01 * energy.max()

    @ARTICULATED
    def test_conservation_shaking_force_is_the_change_of_momentum(self, raw):
        raw = {**raw, "web_unbalance": "0 kg*mm", "counterweights": "0 kg*mm"}
        out = values(raw, ["shaking_force_x", "shaking_force_y", "crank_angle"])
        changed = _complex_slope(Bodies(raw, np.radians(out["crank_angle"])).momentum()) * OMEGA
        F = vectors(out, "shaking_force")
        assert np.abs(F + changed).max() < 1e-10 * np.abs(F).max()

    @ARTICULATED
    def test_conservation_shaking_force_is_what_bearings_and_walls_leave(self, raw):
        out, template = values(raw), run(raw).template
        banks = np.exp(1j * np.radians(raw["bank_angles"]["value"]))[:, None]
        mains = vectors(out, "main_load")
        total = -mains.sum(axis=0) + template.grid.returned((1j * template.wall * banks).sum(axis=0))
        assert total == pytest.approx(vectors(out, "shaking_force"), abs=1e-10 * np.abs(mains).max())

    @ARTICULATED
    def test_conservation_roll_moment_takes_up_torque_and_angular_momentum(self, raw):
        out = values(raw, ["torque", "roll_moment", "crank_angle"])
        bodies = Bodies(raw, np.radians(out["crank_angle"]))
        left = out["roll_moment"] + out["torque"] + slope(bodies.angular_momentum()) * OMEGA
        assert np.abs(left).max() < 1e-10 * bodies.energy().max()

    @ARTICULATED
    def test_conservation_orders_are_those_of_the_pistons(self, raw):
        """Fourier parts of the pistons' momentum at orders 1 to 4."""
        raw = {**raw, "orders": [1, 2, 3, 4], "harmonics": "exact"}
        out, template = values(raw), run(raw).template
        force = template.m_rec[:, None] * OMEGA**2 * -template.grid.returned(template.motion.x2)
        force = (force * np.exp(1j * template.layout.bank)[:, None]).sum(axis=0)
        spectrum = np.fft.fft(force) / force.size
        scale = np.abs(spectrum).max()
        for k, order in enumerate(raw["orders"]):
            assert abs(spectrum[2 * order]) == pytest.approx(out["order_force_forward"][k], abs=1e-9 * scale)
            assert abs(spectrum[-2 * order]) == pytest.approx(
                out["order_force_backward"][k], abs=1e-9 * scale
            )

    @ARTICULATED
    def test_analytic_each_cylinder_fires_where_its_piston_is_highest(self, raw):
        out = values(raw, ["ignition_angles"])
        motion = run(raw).template
        at_firing = motion.layout.alpha(np.radians(out["ignition_angles"]))
        own = motion.crank.at(at_firing)
        for j in range(len(raw["throws"])):
            assert abs(own.x1[j, j]) < 1e-12
            assert own.x[j, j] == pytest.approx(motion.motion.x[j].max(), rel=2e-5)

    def test_analytic_the_master_bears_all_rods(self):
        out, template = values(RADIAL), run(RADIAL).template
        loads = vectors(out, "crankpin_load")
        pins = template.grid.returned(template.pins)
        assert loads[0] == pytest.approx(pins.sum(axis=0), rel=1e-12)
        assert loads[1] == pytest.approx(pins[1], rel=1e-12)
        assert out["crankpin_load_max"][0] > 1.5 * out["crankpin_load_max"][1:].max()

    def test_limit_an_arm_of_nothing_is_a_rod_on_the_crankpin(self):
        """The pin of the rod on the crankpin: fork and blade, to the order of the arm."""
        without = {
            k: v
            for k, v in V_TWO.items()
            if k not in {"masters", "articulation_radius", "articulation_angle"}
        }
        wanted = {n: o.value for n, o in evaluate(Engine, without).outputs.items()}
        near = values({**V_TWO, "articulation_radius": "1e-6 mm"})
        for name in ("torque", "main_load_x", "main_load_y", "shaking_force_x", "roll_moment"):
            assert near[name] == pytest.approx(wanted[name], abs=1e-6 * np.abs(wanted[name]).max()), name

    def test_property_gas_pushes_articulated_pistons(self):
        """The mean of the curve is the work of the gas in all cylinders: ∮ p dV of each, by its own way."""
        gas = {name: FOUR[name] for name in ("gas_cycle", "combustion_pressure", "compression_ratio")}
        raw = {**V_TWO, **gas, "crank_angle_step": "0.5 deg"}
        out, template = values(raw), run(raw).template
        step = np.radians(0.5)
        work = -template.grid.returned(template.gas_forces * template.motion.x1).sum() * step
        assert out["torque"].mean() * 4 * np.pi == pytest.approx(work, rel=1e-10)
        assert out["mean_torque"] > 50

    @pytest.mark.parametrize(
        ("change", "name", "words"),
        [
            ({"masters": [0, 3]}, "masters", "cylinder whose rod"),
            ({"masters": [2, 1]}, "masters", "cylinder whose rod"),
            ({"masters": [0, 2]}, "masters", "cylinder whose rod"),
            ({"articulation_radius": "0 mm"}, "articulation_radius", "crankpin"),
            ({"articulation_radius": None}, "articulation_radius", "crankpin"),
            ({"rod_length": mm(145, 70), "articulation_angle": "150 deg"},
             "articulation_radius", "longer rod"),
            ({"cylinder_positions": mm(40, 54)}, "cylinder_positions", "one position"),
            ({"throws": [1, 2]}, "throws", "throws"),
            ({"crank_radius": mm(43, 42)}, "masters", "throws"),
            ({"pin_angles": deg(10, 20), "pins_of_a_throw": "split"}, "pin_angles", "pin_angles"),
        ],
    )  # fmt: skip
    def test_property_contradictions_are_refused_by_name(self, change, name, words):
        raw = {key: value for key, value in {**V_TWO, **change}.items() if value is not None}
        faults = refused(raw)
        assert name in faults, faults
        assert words in faults[name]


def bar(places, loads, mains, EI=1e4):
    """Flexibility of a straight bar held at its outermost mains: a simple beam, alike across."""
    length = mains[-1] - mains[0]

    def bend(x, a):  # displacement at x of a unit force at a, simply supported (Euler-Bernoulli)
        x, a, b = x - mains[0], a - mains[0], mains[-1] - a
        if x > a:
            x, a, b = length - x, b, a
        return b * x * (length**2 - b**2 - x**2) / (6 * EI * length)

    plane = np.eye(2)
    return Flexibility(
        np.kron([[bend(x, a) for a in mains] for x in mains], plane),
        np.kron([[bend(x, a) for a in places] for x in mains], plane),
    )


class TestPlay:
    """A straight bar on three or four supports, and whole engines."""

    mains, places = np.array([0.0, 0.5, 1.0]), np.array([0.5])
    theta = np.radians(np.arange(0, 360, 30))

    def reactions(self, force, clearance, stiffness=np.inf, offset=0.0, mains=None, places=None):
        mains = self.mains if mains is None else mains
        places = self.places if places is None else places
        forces = np.asarray(force, dtype=complex).reshape(places.size, -1)
        supports = supports_of(
            mains, np.asarray(stiffness), np.asarray(clearance), np.asarray(offset), np.array(0.0)
        )
        shaft = bar(places, forces, mains)
        answer = with_play(
            mains, ShaftLoads(places, forces), [shaft], supports, self.theta[: forces.shape[1]]
        )
        assert answer.residual.max() < 1e-8
        return answer.forces

    def test_analytic_a_middle_main_bears_what_bends_the_bar_further_than_its_clearance(self):
        """Deflection of the bar P l³/(48 E I); R = P − Δ 48 E I/l³ on rigid supports, none below."""
        k = 48 * 1e4
        for force in (100.0, 400.0, 1000.0, 5000.0):
            R = self.reactions([force], [0.0, 1e-3, 0.0])
            expected = max(0.0, force - 1e-3 * k)
            assert -R[1, 0].real == pytest.approx(expected, abs=1e-5 * force)
            assert R[0, 0] == pytest.approx(R[2, 0], abs=1e-9 * force)
            assert R.sum() == pytest.approx(-force, rel=1e-12)

    def test_analytic_springs_share_with_the_bar(self):
        """Outer supports yield by R/k each, the middle one by R/k beyond its clearance."""
        k, bend, gap, force = 2e6, 1 / (48 * 1e4), 1e-3, 3000.0
        outer = lambda middle: (force - middle) / 2  # noqa: E731
        # (P − R) f + (P − R)/(2 k) = Δ + R/k at the middle
        expected = (force * (bend + 1 / (2 * k)) - gap) / (bend + 1.5 / k)
        R = self.reactions([force], [0.0, gap, 0.0], stiffness=k)
        assert -R[1, 0].real == pytest.approx(expected, rel=1e-8)
        assert -R[0, 0].real == pytest.approx(outer(expected), rel=1e-8)

    def test_analytic_equal_clearances_shift_a_bar_that_is_pushed_one_way(self):
        loads = [1000.0, 700.0]
        places = np.array([0.3, 0.6])
        with_none, with_some = (
            self.reactions(np.array(loads)[:, None], [c] * 3, stiffness=1e7, places=places)
            for c in (1e-12, 1e-3)
        )
        assert with_some == pytest.approx(with_none, abs=1e-6 * 1000)

    def test_analytic_a_bore_off_the_line_loads_the_bar_without_other_forces(self):
        """The middle support off by o: R = 48 E I o / l³, half of it on each outer one."""
        R = self.reactions([1e-9], [0.0, 0.0, 0.0], offset=np.array([0.0, 2e-4, 0.0]))
        assert R[1, 0].real == pytest.approx(48 * 1e4 * 2e-4, rel=1e-9)
        assert R[0, 0].real == pytest.approx(-24 * 1e4 * 2e-4, rel=1e-9)

    def test_property_the_answer_turns_with_the_load(self):
        """The supports are alike all round: the same load at each crank angle, seen from the frame."""
        turning = 3000 * np.exp(1j * self.theta)
        R = self.reactions(turning[None], [1e-4, 1e-3, 3e-4], stiffness=1e7)
        assert np.abs(R) == pytest.approx(np.abs(R[:, :1]) + 0 * np.abs(R), rel=1e-7)
        assert np.angle(R[1] / -turning) == pytest.approx(np.zeros(self.theta.size), abs=1e-6)

    def test_limit_clearance_to_nothing_is_the_linear_answer(self):
        mains, places = np.array([0.0, 0.3, 0.7, 1.0]), np.array([0.2, 0.5, 0.9])
        rng = np.random.default_rng(3)
        forces = rng.normal(size=(3, 4)) + 1j * rng.normal(size=(3, 4))
        shaft = bar(places, forces, mains)
        linear = support_reactions(mains, places, shaft, np.full(4, 1e7))
        wanted = elastic_loads(linear, ShaftLoads(places, forces), self.theta[:4])
        R = self.reactions(forces, [1e-15] * 4, stiffness=1e7, mains=mains, places=places)
        assert R == pytest.approx(wanted, abs=1e-6)

    def test_property_every_main_obeys_its_law(self):
        """Reaction and displacement of each main in an engine: R = k (|u| − c) along u, or none within c."""
        raw = {**FOUR, "crank_angle_step": "20 deg", "main_clearance": mm(0.02, 0.03, 0.06, 0.03, 0.02),
               "bore_offset_y": mm(0, 0.01, -0.02, 0, 0)}  # fmt: skip
        out, template = values(raw), run(raw).template
        assert out["support_law_residual"] < 1e-8
        assert out["elastic_equilibrium_residual"] < 1e-10
        R = vectors(out, "elastic_main_load")
        from templates.physics.crankshaft.main_clearance import flexibilities

        (shaft,) = flexibilities(
            template.z_m, template.places, template.web_places, template.layout.throw, template.layout.pin,
            template.crank.r, template.sections,
        )  # fmt: skip
        turn = np.exp(1j * template.theta)

        def rows(these):
            turned = these / turn
            return np.stack([turned.real, turned.imag], axis=1).reshape(-1, turned.shape[-1])

        moved = shaft.mains @ rows(R) + shaft.loads @ rows(template.grid.returned(template.loads.forces))
        d = (moved[0::2] + 1j * moved[1::2]) * turn
        c = np.array([0.02, 0.03, 0.06, 0.03, 0.02])[:, None] * 1e-3
        bore = 1j * np.array([0, 0.01, -0.02, 0, 0])[:, None] * 1e-3
        # the rigid line follows from the outermost mains, which bear at every angle here
        u = bore - R / 500e6 - c * R / np.abs(R) - d
        z = template.z_m
        line = u[0] + (u[-1] - u[0]) * ((z - z[0]) / (z[-1] - z[0]))[:, None]
        gap = np.abs(u - line)
        bears = np.abs(R) > 1e-4 * np.abs(R).max()
        assert bears[[0, -1]].all()
        assert gap[bears].max() < 1e-7 * c.max() + 1e-12
        within = np.abs(line + d - bore)[~bears]
        assert np.all(within <= np.broadcast_to(c, R.shape)[~bears] * (1 + 1e-3))

    def test_property_speeds_as_an_array_are_each_alone(self):
        names = ["elastic_main_load_max"]
        raw = {**FOUR, "crank_angle_step": "20 deg", "main_clearance": "0.03 mm"}
        together = values({**raw, "speed": {"value": [1000, 4000], "unit": "rpm"}}, names)[names[0]]
        for k, speed in enumerate(("1000 rpm", "4000 rpm")):
            assert together[k] == pytest.approx(values({**raw, "speed": speed}, names)[names[0]], rel=1e-6)

    @pytest.mark.parametrize("name", ["main_clearance", "bore_offset_x", "bore_offset_y"])
    def test_property_another_number_of_mains_is_refused(self, name):
        assert name in refused({**FOUR, name: mm(0.01, 0.02)})

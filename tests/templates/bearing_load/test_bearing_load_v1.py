"""bearing_load 1: a textbook case, equilibrium of free bodies, work and energy, a second method."""

import numpy as np
import pytest

from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

SWUNG = {**BearingLoad.example, "crank_angle_step": "1 deg"}
BASE = {**{n: v for n, v in SWUNG.items() if n != "rod_pendulum_period"}, "rod_inertia": "2.1e-3 kg*m**2"}
LEVELS = ("lumped", "rigid")
RATIOS = (1.2, 2.5, 3.4, 8.0)


def values(raw, **options):
    return {name: answer.value for name, answer in evaluate(BearingLoad, raw, **options).outputs.items()}


def refused(raw, **options):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(BearingLoad, raw, **options)
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


class TestLiterature:
    """Khurmi & Gupta, Theory of Machines, example 15.7: r 0.3, l 1.2, bore 0.5 m, 250 kg, 250 rpm, 60°."""

    RAW = {
        "speed": "250 rpm", "stroke": "0.6 m", "rod_ratio": 4, "bore": "0.5 m", "rod_mass": "0 kg",
        "rod_centre": "0 m", "piston_mass": "250 kg", "strokes": 2, "gas_cycle": "table",
        "pressure": {"value": [0.35] * 12, "unit": "MPa"}, "crank_angle_step": "30 deg",
    }  # fmt: skip

    def test_literature_rod_force_and_torque(self):
        out = values(self.RAW)
        assert out["crank_angle"][2] == pytest.approx(60)
        rod = np.hypot(out["wristpin_load_x"], out["wristpin_load_y"])[2]
        assert rod == pytest.approx(50.641e3, abs=0.5)
        assert out["torque"][2] == pytest.approx(14.4895e3, abs=0.05)


class Mechanism:
    """Where every part is, differentiated by a Fourier series: no formula of the physics is used."""

    def __init__(self, raw, count=144):
        t = BearingLoad.from_quantities(raw)
        self.t, self.r, self.omega = t, float(t.r), float(t.omega)
        self.theta = np.arange(count) * 2 * np.pi / count
        self.length = float(t.n) * self.r
        self.pin = self.r * np.exp(1j * self.theta)
        self.wrist = self.pin.real + np.sqrt(self.length**2 - self.pin.imag**2)
        rod = self.wrist - self.pin
        self.angle = np.angle(rod)
        self.centre = self.pin + rod * float(t.b_g) / self.length

    def rate(self, value, times=1):
        order = np.fft.fftfreq(value.size, 1 / value.size)
        series = np.fft.ifft(np.fft.fft(value) * (1j * order) ** times) * self.omega**times
        return series if np.iscomplexobj(value) else series.real


def no_gas(n, **more):
    return {**BASE, "rod_ratio": n, "gas_cycle": "none", "crank_angle_step": "2.5 deg", "rod_centre": "30 mm",
            **more}  # fmt: skip


class TestSecondMethod:
    """Newton–Euler with accelerations by Fourier differentiation of positions."""

    @pytest.mark.parametrize("n", [1.6, 2.5, 3.4, 8.0])
    def test_analytic_motion(self, n):
        raw = no_gas(n)
        m, out = Mechanism(raw), values(raw)
        a, spin = m.rate(m.wrist, 2), m.rate(m.angle)
        assert out["piston_acceleration"][:144] == pytest.approx(a, abs=1e-10 * np.abs(a).max())
        assert out["rod_angular_velocity"][:144] == pytest.approx(spin, abs=1e-10 * np.abs(spin).max())

    @pytest.mark.parametrize("n", [1.6, 2.5, 3.4, 8.0])
    def test_analytic_rigid_forces_from_newton_and_euler(self, n):
        """Unknown pin and wall forces of rod and piston, solved from three balances at each angle."""
        raw = no_gas(n)
        m, out = Mechanism(raw), values(raw, level="rigid")
        t = m.t
        a_4, a_g, spin = m.rate(m.wrist, 2), m.rate(m.centre, 2), m.rate(m.angle, 2)
        F_34x = float(t.m_4) * a_4
        F_23x = float(t.m_3) * a_g.real + F_34x
        big, small = m.pin - m.centre, m.wrist - m.centre
        # moments about the centre: big × F_23 + small × (−F_34) = I φ̈, F_23y = m a_gy + F_34y
        fixed = -big.imag * F_23x + small.imag * F_34x + big.real * float(t.m_3) * a_g.imag
        F_34y = (float(t.I_3) * spin - fixed) / (big.real - small.real)
        F_23 = F_23x + 1j * (float(t.m_3) * a_g.imag + F_34y)
        scale = 1e-10 * np.abs(F_23).max()
        assert out["wristpin_load_x"][:144] == pytest.approx(F_34x, abs=scale)
        assert out["wristpin_load_y"][:144] == pytest.approx(F_34y, abs=scale)
        assert out["crankpin_load_x"][:144] == pytest.approx(-F_23.real, abs=scale)
        assert out["crankpin_load_y"][:144] == pytest.approx(-F_23.imag, abs=scale)
        torque = m.pin.real * -F_23.imag - m.pin.imag * -F_23.real
        assert out["torque"][:144] == pytest.approx(torque, abs=1e-10 * np.abs(torque).max())

    @pytest.mark.parametrize("n", [1.6, 3.4])
    def test_analytic_torque_is_the_loss_of_kinetic_energy(self, n):
        """Lagrange: without gas, T = −dE/dθ of rod and piston."""
        raw = no_gas(n)
        m = Mechanism(raw)
        t = m.t
        energy = 0.5 * (float(t.m_4) * m.rate(m.wrist) ** 2 + float(t.m_3) * np.abs(m.rate(m.centre)) ** 2
                        + float(t.I_3) * m.rate(m.angle) ** 2)  # fmt: skip
        T = -m.rate(energy) / m.omega
        assert values(raw, level="rigid")["torque"][:144] == pytest.approx(T, abs=1e-10 * np.abs(T).max())


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("n", RATIOS)
class TestFreeBodies:
    """At every angle the forces on each body are its mass times acceleration, to 1e-10 of the largest."""

    def test_analytic_crank(self, level, n):
        t = BearingLoad.from_quantities({**BASE, "rod_ratio": n}).at(level)
        M = t.m_cp + t.m_w * t.g_w / t.r - t.m_cb * t.g_cb / t.r
        inertia = -M * t.omega**2 * t.r
        scale = 1e-10 * t.F_12_max
        assert t.F_12x + t.F_32x == pytest.approx(inertia * np.cos(t.theta), abs=scale)
        assert t.F_12y + t.F_32y == pytest.approx(inertia * np.sin(t.theta), abs=scale)
        arm = t.r * (np.cos(t.theta) * t.F_32y - np.sin(t.theta) * t.F_32x)
        assert t.T == pytest.approx(arm, abs=scale * t.r)

    def test_analytic_piston(self, level, n):
        t = BearingLoad.from_quantities({**BASE, "rod_ratio": n}).at(level)
        scale = 1e-10 * t.F_34_max
        assert t.F_34x - (t.p - t.p_0) * t.A == pytest.approx(t.m_4 * t.a, abs=scale)
        assert t.F_34y - t.F_41y == pytest.approx(0 * t.a, abs=scale)

    def test_analytic_rod(self, level, n):
        """Forces, and moments about the wristpin with the rod's own inertia at level rigid."""
        t = BearingLoad.from_quantities({**BASE, "rod_ratio": n}).at(level)
        phi = np.arcsin(np.sin(t.theta) / t.n)
        wrist = t.m_3B * t.a
        pin = -t.m_3A * t.omega**2 * t.r * np.exp(1j * t.theta)
        scale = 1e-10 * t.F_32_max
        assert -t.F_34x - t.F_32x == pytest.approx(wrist + pin.real, abs=scale)
        assert -t.F_34y - t.F_32y == pytest.approx(pin.imag, abs=scale)
        big = -t.l * np.exp(-1j * phi)  # from wristpin to crankpin
        moment = big.real * (-t.F_32y - pin.imag) - big.imag * (-t.F_32x - pin.real)
        spin = -(t.omega**2) * t.motion.rod_acceleration
        extra = t.I_3 - t.m_3 * t.a_g * (t.l - t.a_g) if level == "rigid" else 0.0
        assert moment == pytest.approx(extra * spin, abs=scale * t.l)


class TestWork:
    @pytest.mark.parametrize("n", RATIOS)
    def test_analytic_lumped_plus_correction_is_rigid(self, n):
        raw = {**BASE, "rod_ratio": n}
        lumped, rigid = values(raw, level="lumped"), values(raw, level="rigid")
        T = lumped["torque"] + lumped["correction_torque"]
        assert T == pytest.approx(rigid["torque"], rel=0, abs=1e-10 * np.abs(T).max())
        assert lumped["correction_torque"] == pytest.approx(rigid["correction_torque"], rel=1e-14)

    @pytest.mark.parametrize("level", LEVELS)
    @pytest.mark.parametrize("n", [1.2, 2.5, 8.0])
    def test_analytic_inertia_does_no_work(self, level, n):
        out = values({**BASE, "rod_ratio": n, "gas_cycle": "none"}, level=level)
        assert abs(out["torque"].sum()) < 1e-12 * np.abs(out["torque"]).sum()
        assert out["mean_torque"] == 0

    @pytest.mark.parametrize(
        ("cycle", "strokes"),
        [
            ("otto", 2),
            ("otto", 4),
            ("diesel", 2),
            ("diesel", 4),
            ("table", 2),
            ("table", 4),
            ("four_stroke", 4),
        ],
    )
    def test_analytic_work_of_the_gas_is_the_integral_of_the_torque(self, cycle, strokes):
        """The torque integrated by Gauss between all kinks, from pressure and positions alone."""
        t = BearingLoad.from_quantities({**BASE, "strokes": strokes, "gas_cycle": cycle, **table(strokes)})
        ends = np.linspace(kinks(t, cycle, strokes)[:-1], kinks(t, cycle, strokes)[1:], 9, axis=-1)
        nodes, weights = np.polynomial.legendre.leggauss(16)
        low, width = ends[:, :-1, None], np.diff(ends)[..., None]
        T = torque_at(t, (low + width * (nodes + 1) / 2).ravel()).reshape(*width.shape[:2], 16)
        assert t.T_mean == pytest.approx((T * weights * width / 2).sum() / (np.pi * strokes), rel=1e-8)

    def test_analytic_sum_of_the_curve_converges_to_the_mean(self):
        errors = []
        for step in (4, 2, 1, 0.5):
            out = values({**BASE, "inlet_opens": "720 deg", "exhaust_closes": "720 deg", "cutoff": 1,
                          "crank_angle_step": f"{step} deg"})  # fmt: skip
            errors.append(abs(out["torque"].mean() / out["mean_torque"] - 1))
        assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 1.8, errors


def table(strokes):
    angle = np.arange(0, 180 * strokes, 5.0)
    peak = 360 if strokes == 4 else 0
    away = (angle - peak - 10 + 90 * strokes) % (180 * strokes) - 90 * strokes
    return {"pressure": {"value": (1 + 50 * np.exp(-((away / 25) ** 2))).tolist(), "unit": "bar"}}


def kinks(t, cycle, strokes):
    """All angles where the pressure has a corner or a step."""
    full = np.pi * strokes
    if cycle == "table":
        return np.linspace(0, full, 36 * strokes + 1)
    gas = t.gas
    corners = [gas.exchange_begins, gas.exchange_ends, gas.inlet_closes, gas.firing, gas.cut,
               gas.exhaust_opens, gas.emptied]  # fmt: skip
    inside = sorted({0.0, full, *(float(c) % full for c in corners)})
    return np.array([*inside])


def torque_at(t, theta):
    """Torque of the gas [N m] at angles, by its pressure and how positions change."""
    p, step = t.gas.pressure(theta, travel(t, theta)), 1e-4
    slope = (8 * (travel(t, theta + step) - travel(t, theta - step))
             - (travel(t, theta + 2 * step) - travel(t, theta - 2 * step))) / (12 * step)  # fmt: skip
    return (p - t.p_0) * t.A * t.s * slope


def travel(t, theta):
    n = float(t.n)
    return (1 + n - np.cos(theta) - np.sqrt(n**2 - np.sin(theta) ** 2)) / 2


class TestRod:
    def test_analytic_pendulum_of_a_slender_rod(self):
        """A slender rod swings about its end with τ = 2π √(2 l/(3 g)); I about its centre is m l²/12."""
        length, mass = 0.1462, 0.62
        tau = 2 * np.pi * np.sqrt(2 * length / (3 * 9.80665))
        raw = {**SWUNG, "rod_centre": f"{length / 2} m", "rod_pendulum_period": f"{tau:.17g} s"}
        assert values(raw)["rod_inertia"] == pytest.approx(mass * length**2 / 12, rel=1e-12)

    def test_property_level_follows_what_is_known_of_the_rod(self):
        unknown = {n: v for n, v in SWUNG.items() if n != "rod_pendulum_period"}
        assert evaluate(BearingLoad, SWUNG).level == "rigid"
        plain = evaluate(BearingLoad, unknown)
        assert plain.level == "lumped"
        assert "rod_inertia" in plain.outputs["correction_torque"].reason
        assert evaluate(BearingLoad, {**unknown, "rod_inertia": "1e-3 kg*m**2"}).level == "rigid"
        assert ("inertia_correction", "outside_domain") in refused(unknown, level="rigid")

    def test_property_impossible_pendulum_is_refused(self):
        assert ("rod_inertia", "outside_domain") in refused({**SWUNG, "rod_pendulum_period": "0.1 s"})

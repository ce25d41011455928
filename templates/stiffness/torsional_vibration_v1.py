"""Torsional vibration of a chain of inertias: natural frequencies, mode shapes, critical speeds.

The model is the free, undamped vibration of a crankshaft or driveline as a chain of inertias joined by
massless shafts. It shows at which speeds resonances occur, not their amplitudes.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Template, Truth, choice, curve, profile, require, text
from templates.physics.shafts.torsion_chain import (
    FIXED,
    FREE,
    angular_frequencies,
    fits,
    manageable,
    mode_shapes,
)
from templates.physics.shafts.torsion_orders import (
    ascending,
    campbell_speeds,
    critical_speeds,
    excitation,
    resonances,
)

HOLZER = "Holzer 1921"
OUT_OF_SCALE = "inertias or stiffnesses are so far apart that frequencies make no sense: check their units"


class TorsionalVibration(Template):
    """Torsional vibration of a chain of inertias: natural frequencies, mode shapes, critical speeds.

    The model is the free, undamped vibration of a crankshaft or driveline as a chain of inertias joined by
    massless shafts. It shows at which speeds resonances occur, not their amplitudes.

    Limits
    ------
    One chain, without branches and gears; refer both sides of a gear stage to one speed first.
    With free ends n inertias have n - 1 stiffnesses, in order; a single inertia has none.
    With a fixed end n inertias have n stiffnesses, the first of them from ground to the first inertia.
    A zero inertia or stiffness is refused: combine the two shafts in series, or calculate two trains.
    Modes are in ascending order; with free ends mode 0 is the rigid-body rotation, with a frequency of
    exactly 0.
    Mode shapes are [mode, inertia], each with 1 as its largest entry; critical speeds are [order, mode].
    A critical speed of 0 belongs to mode 0, which no order excites.
    Several trains at once are the rows of a table of inertias; their frequencies are rows too.
    At most 500 inertias or orders, and 1 000 000 entries in the mode shapes of all trains.

    References
    ----------
    H. Holzer: Die Berechnung der Drehschwingungen, 1921.
    Mendes, Meirelles, Zampieri: J. Multi-body Dynamics, 2008, a six-cylinder diesel as check case.
    Punewale, Khobragade, Chaudhari, Khandre, 2015, for the single-cylinder shaft.
    """

    example = {
        "inertias": {"value": [0.012, 0.0046, 0.35, 0.1], "unit": "kg*m**2"},
        "stiffnesses": {"value": [60, 188.2, 20], "unit": "kN*m/rad"},
        "engine_orders": [2, 4, 6],
        "speed_range": {"value": [1000, 4000], "unit": "rpm"},
    }
    main_results = ("natural_frequencies[1]", "critical_speeds[1]")
    criteria = {
        "separation": {
            "require": "abs(critical_speeds - (1.1 * highest_running_speed + 0.9 * lowest_running_speed) / 2)"
            " >= (1.1 * highest_running_speed - 0.9 * lowest_running_speed) / 2",
            "words": "no critical speed lies in the running range, nor within 10 % of its ends",
            "source": "10 % as in API 617 for torsional criticals; engines pass some, then stresses decide",
            "limits": {
                "lowest_running_speed": {
                    "unit": "rpm",
                    "words": "lowest speed of the running range",
                    "default": "min(speed_range)",
                },
                "highest_running_speed": {
                    "unit": "rpm",
                    "words": "highest speed of the running range",
                    "default": "max(speed_range)",
                },
            },
        },
    }
    precision = 1e-8

    J: Array = curve("kg*m**2", "inertias", along="inertias", gt=0)
    k: Array = curve("N*m/rad", "stiffnesses", along="stiffnesses", alternative=True, gt=0)
    ends: str = choice(FREE, FIXED, words="ends", default=FREE)
    h: Array = curve("1", "engine orders", along="orders", constant=True, optional=True, gt=0, le=1000)
    n: Array = curve("rpm", "speed range", along="two speeds", optional=True, ge=0)

    @require("inertias", "stiffnesses", "ends", missing=True, remedy="count the shafts, or check the ends")
    def a_chain(self) -> Truth:
        """A free train of n inertias has n - 1 stiffnesses, a train with a fixed end has n."""
        return fits(self.J, self.k, self.ends)

    @require("inertias", "engine_orders", missing=True, remedy="take fewer, or fewer trains at once")
    def not_too_long(self) -> Truth:
        """There are at most 500 inertias or orders, and 1 000 000 entries in all mode shapes."""
        return manageable(self.J, self.k, self.h)

    @require("speed_range", remedy="write it as [600, 3000] rpm")
    def two_speeds(self) -> Truth:
        """The speed range consists of two speeds in ascending order."""
        return ascending(self.n)

    @profile("rad/s", "natural angular frequencies", along="natural_angular_frequencies", symbol=r"\omega",
             source=HOLZER, ge=0, lt=1e15, remedy=OUT_OF_SCALE)  # fmt: skip
    def omega(self) -> Array:
        return angular_frequencies(self.J, self.k, self.ends)

    @profile("Hz", "natural frequencies", along="natural_frequencies", symbol="f")
    def f(self) -> Array:
        return self.omega / (2 * np.pi)

    @profile("1", "mode shapes", along="inertias", axes=2, symbol=r"\varphi", remedy=OUT_OF_SCALE)
    def phi(self) -> Array:
        return mode_shapes(self.J, self.k, self.ends)

    @profile("rpm", "critical speeds", along="natural_frequencies", axes=2, symbol=r"n_{c}")
    def n_c(self) -> Array:
        return critical_speeds(self.omega, self.h)

    @text("resonances", absent="give `engine_orders` and `speed_range`")
    def met(self) -> str:
        return resonances(self.n_c, self.h, self.n)

    @profile("rpm", "Campbell speeds", along="campbell_speeds", symbol="n_i")
    def n_i(self) -> Array:
        return campbell_speeds(self.n)

    @profile("Hz", "excitation frequencies", along="campbell_speeds", axes=2, symbol="f_{h}")
    def f_h(self) -> Array:
        return excitation(self.h, self.n_i) / (2 * np.pi)

"""Compare measured curves with calculated ones, and judge how far they differ.

A measurement has its own angles; it is interpolated at the angles of the calculation.
"""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, curve, formula, given, profile, require
from templates.physics.numerics.measured_curve import (
    covers,
    film_at,
    largest_film,
    largest_speed,
    largest_strain,
    mean_film,
    mean_speed,
    mean_strain,
    rises,
    rms_film,
    rms_speed,
    rms_strain,
    speed_at,
    strain_at,
)

CYCLE, MEASURED = "crank_angle", "measured_angle"


class MeasuredCurves(Template):
    """Measured curves compared with calculated ones: film, angular speed or strain over the crank angle.

    A measurement has its own angles; it is interpolated at those of the calculation, and the difference is
    stated. Each curve has two criteria: the root mean square of its difference, and the largest difference,
    each compared with a limit that you give. There is no usual limit: without one a criterion is not checked.

    Limits
    ------
    Calculation and measurement are periodic with one cycle. A measurement is interpolated linearly between
    its points, and from the last to the first; it leaves no gap above a quarter of the cycle. Its angles plus
    measured_shift are those of the calculation. A difference is measured minus calculated. In means every
    calculated angle has the same weight. Nothing is filtered, and the error of the measurement is unknown
    here: a limit below it would judge the instrument. The verdict applies to the calculated angles: a peak
    between two of them is missed.

    References
    ----------
    Own formulas: linear interpolation, mean, root mean square.
    """

    example = {
        "crank_angle": {"value": [0, 90, 180, 270, 360, 450, 540, 630], "unit": "deg"},
        "measured_angle": {"value": [10, 100, 190, 280, 370, 460, 550, 640], "unit": "deg"},
        "measured_shift": "-5 deg",
        "calculated_film": {"value": [3.1, 4.0, 6.2, 5.1, 1.8, 2.6, 4.4, 3.9], "unit": "um"},
        "measured_film": {"value": [3.4, 4.1, 5.9, 5.3, 2.1, 2.5, 4.6, 4.2], "unit": "um"},
        "calculated_speed": {"value": [1500, 1495, 1490, 1502, 1512, 1508, 1499, 1497], "unit": "rpm"},
        "measured_speed": {"value": [1501, 1494, 1492, 1501, 1514, 1506, 1500, 1496], "unit": "rpm"},
        "calculated_strain": {"value": [0, 2e-4, 1e-4, 0, 9e-4, 5e-4, 1e-4, 0], "unit": "1"},
        "measured_strain": {"value": [1e-5, 2.2e-4, 9e-5, 0, 8.5e-4, 5.2e-4, 1e-4, 2e-5], "unit": "1"},
    }

    criteria = {
        "rms_film": {
            "require": "rms_film_difference <= permissible_rms_film_difference",
            "words": "the measured film differs little from the calculated one over the cycle",
            "limits": {
                "permissible_rms_film_difference": {
                    "unit": "um",
                    "words": "root of the mean square of measured less calculated film",
                }
            },
        },
        "largest_film": {
            "require": "largest_film_difference <= permissible_largest_film_difference",
            "words": "the measured film differs little from the calculated one at every angle",
            "limits": {
                "permissible_largest_film_difference": {
                    "unit": "um",
                    "words": "largest difference of measured and calculated film",
                }
            },
        },
        "rms_speed": {
            "require": "rms_speed_difference <= permissible_rms_speed_difference",
            "words": "the measured speed differs little from the calculated one over the cycle",
            "limits": {
                "permissible_rms_speed_difference": {
                    "unit": "rpm",
                    "words": "root of the mean square of measured less calculated speed",
                }
            },
        },
        "largest_speed": {
            "require": "largest_speed_difference <= permissible_largest_speed_difference",
            "words": "the measured speed differs little from the calculated one at every angle",
            "limits": {
                "permissible_largest_speed_difference": {
                    "unit": "rpm",
                    "words": "largest difference of measured and calculated speed",
                }
            },
        },
        "rms_strain": {
            "require": "rms_strain_difference <= permissible_rms_strain_difference",
            "words": "the measured strain differs little from the calculated one over the cycle",
            "limits": {
                "permissible_rms_strain_difference": {
                    "unit": "1",
                    "words": "root of the mean square of measured less calculated strain",
                }
            },
        },
        "largest_strain": {
            "require": "largest_strain_difference <= permissible_largest_strain_difference",
            "words": "the measured strain differs little from the calculated one at every angle",
            "limits": {
                "permissible_largest_strain_difference": {
                    "unit": "1",
                    "words": "largest difference of measured and calculated strain",
                }
            },
        },
    }

    theta: Array = curve("deg", "crank angle", along=CYCLE, symbol=r"\theta", ge=-7200, le=7200)
    theta_m: Array = curve("deg", "measured angle", along=MEASURED, symbol=r"\theta_{m}", ge=-7200, le=7200)
    cycle: Array = given("deg", "cycle", default="720 deg", symbol=r"\Theta", single=True, gt=0, le=7200)
    shift: Array = given(
        "deg", "measured shift", default="0 deg", symbol=r"\Delta\theta", single=True, ge=-720, le=720
    )
    h_c: Array = curve("um", "calculated film", along=CYCLE, optional=True, ge=0, le=1e6)
    h_g: Array = curve("um", "measured film", along=MEASURED, optional=True, ge=0, le=1e6)
    n_c: Array = curve("rpm", "calculated speed", along=CYCLE, optional=True, ge=-1e6, le=1e6)
    n_g: Array = curve("rpm", "measured speed", along=MEASURED, optional=True, ge=-1e6, le=1e6)
    eps_c: Array = curve("1", "calculated strain", along=CYCLE, optional=True, ge=-1, le=1)
    eps_g: Array = curve("1", "measured strain", along=MEASURED, optional=True, ge=-1, le=1)

    @require("crank_angle", remedy="give one list of three angles or more that rise")
    def angles_rise(self) -> Truth:
        """The angles of the calculation are in ascending order."""
        return rises(self.theta)

    @require("measured_angle", remedy="sort the rows of the measurement by their angle")
    def measured_angles_rise(self) -> Truth:
        """The angles of the measurement are in ascending order."""
        return rises(self.theta_m)

    @require("measured_angle", "cycle", remedy="measure one whole cycle, or give its length")
    def measured_all_round(self) -> Truth:
        """The measurement covers one cycle, without a gap above a quarter of it."""
        return covers(self.theta_m, self.cycle)

    @profile("um", "film as measured", along=CYCLE, symbol=r"h_{m}")
    def h_m(self) -> Array:
        return film_at(self.theta, self.theta_m, self.h_g, self.cycle, self.shift)

    @profile("um", "film difference", along=CYCLE, symbol=r"\Delta h")
    def h_d(self) -> Array:
        return self.h_m - self.h_c

    @formula("um", "mean film difference", symbol=r"\Delta h_\mathrm{mean}")
    def h_mean(self) -> Array:
        return mean_film(self.h_d)

    @formula("um", "rms film difference", symbol=r"\Delta h_\mathrm{rms}")
    def h_rms(self) -> Array:
        return rms_film(self.h_d)

    @formula("um", "largest film difference", symbol=r"\Delta h_\mathrm{max}")
    def h_max(self) -> Array:
        return largest_film(self.h_d)

    @profile("rpm", "speed as measured", along=CYCLE, symbol=r"n_{m}")
    def n_m(self) -> Array:
        return speed_at(self.theta, self.theta_m, self.n_g, self.cycle, self.shift)

    @profile("rpm", "speed difference", along=CYCLE, symbol=r"\Delta n")
    def n_d(self) -> Array:
        return self.n_m - self.n_c

    @formula("rpm", "mean speed difference", symbol=r"\Delta n_\mathrm{mean}")
    def n_mean(self) -> Array:
        return mean_speed(self.n_d)

    @formula("rpm", "rms speed difference", symbol=r"\Delta n_\mathrm{rms}")
    def n_rms(self) -> Array:
        return rms_speed(self.n_d)

    @formula("rpm", "largest speed difference", symbol=r"\Delta n_\mathrm{max}")
    def n_max(self) -> Array:
        return largest_speed(self.n_d)

    @profile("1", "strain as measured", along=CYCLE, symbol=r"\epsilon_{m}")
    def eps_m(self) -> Array:
        return strain_at(self.theta, self.theta_m, self.eps_g, self.cycle, self.shift)

    @profile("1", "strain difference", along=CYCLE, symbol=r"\Delta \epsilon")
    def eps_d(self) -> Array:
        return self.eps_m - self.eps_c

    @formula("1", "mean strain difference", symbol=r"\Delta \epsilon_\mathrm{mean}")
    def eps_mean(self) -> Array:
        return mean_strain(self.eps_d)

    @formula("1", "rms strain difference", symbol=r"\Delta \epsilon_\mathrm{rms}")
    def eps_rms(self) -> Array:
        return rms_strain(self.eps_d)

    @formula("1", "largest strain difference", symbol=r"\Delta \epsilon_\mathrm{max}")
    def eps_max(self) -> Array:
        return largest_strain(self.eps_d)

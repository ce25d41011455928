"""Tables of bearings under a constant load, calculated by others: `oil_film` 2."""

from __future__ import annotations

from functools import partial
from math import pi

from templates.validate.case import Case, by_row
from templates.validate.films import (
    DIAMETER,
    PSI,
    SPEED,
    SPLIT_10,
    SPLIT_20,
    coefficients,
    film,
    film_of_paper,
    film_under_constant_cycle,
    place,
    value,
)

STIFFNESS = ("Kxx", "Kxy", "Kyx", "Kyy")
DAMPING = ("Bxx", "Bxy", "Byx", "Byy")

TURNED_FILM = """\
eccentricity and angle agree, the coefficients do not. The table satisfies K t = W/e, with t the direction
across the eccentricity, to 0.5 % in every row but one: it moves the journal as if the film turned with it,
grooves included. With grooves that stay in the bush that does not hold: Lund and Thomsen's tables of the same
bearing violate it by half, and agree with ours. So these coefficients suit a film without fixed grooves."""
OFF_ITS_TREND = """\
only the row of S 0.161 differs; its printed angle lies 2° off the trend of its neighbours, and its
derivatives up to 9 % from ours."""
FIT_OF_THE_PAPER = """\
the fit is the paper's own, for W/D 0.376 and 1 ≤ So ≤ 200; inside this range it errs by 22 % at So 4
([how far to trust a number](trust.md)). Below So 1 the template warns."""
LEMON_HALF = """\
unknown. Already the centred journal differs, by 20 % in Kxy; grooves of 1 to 20° do not explain it."""
LEMON_1 = """\
unknown. Up to S 0.05 nearly all numbers agree; at the heaviest loads the derivatives across the load differ,
by up to a third."""


def raimondi_boyd(row: dict[str, float]) -> dict[str, float]:
    """Return eccentricity and (R/c) f at the Sommerfeld number."""
    ours = film(row["S"], row["length_ratio"])
    return {**place(ours), "friction": value(ours, "friction_coefficient", "1") / PSI}


def butenschoen(row: dict[str, float]) -> dict[str, float]:
    """Return minimum film over clearance, attitude and side flow at the load number So."""
    ours = film(1 / (2 * pi * row["So"]), row["width_ratio"])
    flow = value(ours, "side_flow", "m**3/s") / ((DIAMETER / 2) ** 3 * PSI * SPEED)
    return {"h": 1 - place(ours)["eps"], "beta_deg": place(ours)["phi_deg"], "Q": flow}


def by_the_papers_fit(row: dict[str, float]) -> dict[str, float]:
    """Return minimum film over clearance by `oil_film` 1."""
    oil = film_of_paper(1 / (2 * pi * row["So"]), row["width_ratio"])
    return {"h": 1 - value(oil, "relative_eccentricity", "1")}


def constant_cycle(row: dict[str, float]) -> dict[str, float]:
    """Return minimum film over clearance by `oil_film_cycle` 1 under a load that does not change."""
    cycle = film_under_constant_cycle(1 / (2 * pi * row["So"]), row["width_ratio"])
    return {"h": 1 - value(cycle, "maximum_eccentricity", "1")}


def two_grooves(ratio: float, groove: object, row: dict[str, float]) -> dict[str, float]:
    """Return the place of the journal and the coefficients of a bearing with two axial grooves."""
    ours = film(row["S"], ratio, grooves=groove)
    return {**place(ours), **coefficients(ours, (*STIFFNESS, *DAMPING))}


def lemon(ratio: float, preload: float, groove: object, row: dict[str, float]) -> dict[str, float]:
    """Return the place of the journal and the coefficients of a lemon bore; eps of the smallest clearance."""
    ours = film(row["S"], ratio, preload=preload, bore_shape="lemon", grooves=groove)
    return {**place(ours), **coefficients(ours, (*STIFFNESS, *DAMPING), preload)}


def lemon_of_lund(row: dict[str, float]) -> dict[str, float]:
    """Return the same for the table of 1978, whose eps refers to the clearance of machining."""
    ours = lemon(1.0, 0.5, SPLIT_20, row)
    return {**ours, "eps": ours["eps"] * 0.5}


STATIC_FILMS = (
    *(
        Case(
            f"raimondi_boyd_{name}",
            f"Raimondi, Boyd 1958: plain bearing, L/D {ratio}",
            "raimondi_boyd_1958.csv",
            "oil_film 2",
            "printed table",
            by_row(raimondi_boyd),
            rows={"length_ratio": ratio},
            abscissa="S",
            ordinate="friction",
        )
        for name, ratio in (("1", "1"), ("half", "0.5"), ("quarter", "0.25"))
    ),
    *(
        Case(
            f"butenschoen_{name}",
            f"Butenschön 1976: plain bearing, B/D {ratio}",
            "static_film_butenschoen_1976.csv",
            "oil_film 2",
            "printed table",
            by_row(butenschoen),
            rows={"width_ratio": ratio},
            abscissa="So",
            ordinate="beta_deg",
        )
        for name, ratio in (("1", "1"), ("half", "0.5"), ("quarter", "0.25"))
    ),
    Case(
        "butenschoen_paper_fit",
        "Butenschön 1976: plain bearing, B/D 0.4, by the fit of Bhadke et al. 2015",
        "static_film_butenschoen_1976.csv",
        "oil_film 1",
        "printed table",
        by_row(by_the_papers_fit),
        rows={"width_ratio": "0.4"},
        columns=("h",),
        abscissa="So",
        because=FIT_OF_THE_PAPER,
    ),
    Case(
        "butenschoen_cycle",
        "Butenschön 1976: plain bearing, B/D 0.5, as a cycle of constant load",
        "static_film_butenschoen_1976.csv",
        "oil_film_cycle 1",
        "printed table",
        by_row(constant_cycle),
        rows={"width_ratio": "0.5"},
        columns=("h",),
        abscissa="So",
    ),
    *(
        Case(
            f"lund_thomsen_{name}",
            f"Lund, Thomsen 1978: two axial grooves of 20°, L/D {ratio}",
            "lund_thomsen_1978.csv",
            "oil_film 2",
            "printed table",
            by_row(partial(two_grooves, float(ratio), SPLIT_20)),
            rows={"length_ratio": ratio},
            abscissa="S",
            ordinate="Kxx",
        )
        for name, ratio in (("half", "0.5"), ("1", "1"))
    ),
    Case(
        "lund_thomsen_lemon",
        "Lund, Thomsen 1978: lemon bore, L/D 1, preload ½",
        "lund_thomsen_1978_elliptical.csv",
        "oil_film 2",
        "printed table",
        by_row(lemon_of_lund),
        abscissa="S",
        ordinate="Kxx",
        because=OFF_ITS_TREND,
    ),
    *(
        Case(
            f"someya_two_groove_{name}",
            f"Someya 1989: two axial grooves of 10°, L/D {ratio}",
            f"someya_1989_two_groove_{name}.csv",
            "oil_film 2",
            "printed table",
            by_row(partial(two_grooves, ratio, SPLIT_10)),
            abscissa="S",
            ordinate="Kyx",
            because=TURNED_FILM,
        )
        for name, ratio in (("half", 0.5), ("1", 1.0))
    ),
    *(
        Case(
            f"someya_lemon_{name}",
            f"Someya 1989: lemon bore, L/D {ratio}, preload {words}",
            f"someya_1989_lemon_{name}.csv",
            "oil_film 2",
            "printed table",
            by_row(partial(lemon, ratio, preload, SPLIT_10)),
            abscissa="S",
            ordinate="Kxx",
            because=because,
            is_slow=True,
        )
        for name, ratio, preload, words, because in (
            ("half", 0.5, 0.5, "½", LEMON_HALF),
            ("1", 1.0, 2 / 3, "⅔", LEMON_1),
        )
    ),
)

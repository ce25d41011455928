"""Optimisation problems with a closed form or a published optimum."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from app.studies.methods.answers import Columns, Held, Objective, Problem, exact
from app.studies.methods.space import Interval, Space


@dataclass(frozen=True)
class Case:
    """A function and constraints (function, sign, limit) over a box, with the known optimum."""

    name: str
    box: list[tuple[float, float]]
    function: Callable
    best: float
    at: list[float]
    constraints: list[tuple[Callable, str, float]] = field(default_factory=list)
    sense: str = "minimise"

    @property
    def problem(self) -> Problem:
        variables = tuple(Interval(f"x{number}", *bounds) for number, bounds in enumerate(self.box))
        held = tuple(Held(f"g{number}", sign) for number, (_, sign, _) in enumerate(self.constraints))
        return Problem(Space(variables), (Objective("f", self.sense),), held)

    def answer(self, x) -> Columns:
        values = np.empty((len(x), len(self.constraints)))
        for number, (function, _, _) in enumerate(self.constraints):
            values[:, number] = function(x)
        limits = np.array([[limit for _, _, limit in self.constraints]], dtype=float)
        return exact(self.problem, self.function(x)[:, None], values, limits)


def rosenbrock(x):
    return ((1 - x[:, :-1]) ** 2 + 100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2).sum(axis=1)


ROOT = 0.5**0.5

CASES = [
    Case(
        "bowl", [(0, 1), (0, 2)], lambda x: (x[:, 0] - 0.3) ** 2 + 2 * (x[:, 1] - 0.7) ** 2, 0.0, [0.3, 0.7]
    ),
    Case("rosenbrock", [(-2, 2)] * 4, rosenbrock, 0.0, [1.0] * 4),
    Case(
        "plane on a disc, active",
        [(-2, 2), (-2, 2)],
        lambda x: x[:, 0] + x[:, 1],
        -(2**0.5),
        [-ROOT, -ROOT],
        [(lambda x: x[:, 0] ** 2 + x[:, 1] ** 2, "<=", 1.0)],
    ),
    Case(
        "largest box in a budget, one active and one inactive constraint",
        [(0, 1), (0, 1)],
        lambda x: x[:, 0] * x[:, 1],
        0.125,
        [0.5, 0.25],
        [(lambda x: x[:, 0] + 2 * x[:, 1], "<=", 1.0), (lambda x: x[:, 0], ">=", 0.1)],
        sense="maximise",
    ),
    Case(
        "on the boundary of the box",
        [(0.5, 2), (0.25, 3)],
        lambda x: x[:, 0] ** 2 + x[:, 1],
        0.5,
        [0.5, 0.25],
        [(lambda x: x[:, 0] - x[:, 1], ">=", -1.0)],
    ),
    Case(
        "on a bound and a constraint at once",
        [(0, 1), (0, 1)],
        lambda x: (x[:, 0] - 2) ** 2 + (x[:, 1] - 0.5) ** 2,
        1.09,
        [1.0, 0.2],
        [(lambda x: x[:, 0] + x[:, 1], "<=", 1.2)],
    ),
    Case(  # Michalewicz and Schoenauer 1996, G6
        "G6, both constraints active",
        [(13, 100), (0, 100)],
        lambda x: (x[:, 0] - 10) ** 3 + (x[:, 1] - 20) ** 3,
        -6961.8138755802,
        [14.095, 0.8429607892154796],
        [
            (lambda x: (x[:, 0] - 5) ** 2 + (x[:, 1] - 5) ** 2, ">=", 100.0),
            (lambda x: (x[:, 0] - 6) ** 2 + (x[:, 1] - 5) ** 2, "<=", 82.81),
        ],
    ),
    Case(  # Floudas and Pardalos 1987; the optimum is the corner of two curves
        "G24, separate regions",
        [(0, 3), (0, 4)],
        lambda x: -x[:, 0] - x[:, 1],
        -5.50801327159536,
        [2.32952019747762, 3.17849307411774],
        [
            (lambda x: -2 * x[:, 0] ** 4 + 8 * x[:, 0] ** 3 - 8 * x[:, 0] ** 2 + x[:, 1], "<=", 2.0),
            (
                lambda x: -4 * x[:, 0] ** 4 + 32 * x[:, 0] ** 3 - 88 * x[:, 0] ** 2 + 96 * x[:, 0] + x[:, 1],
                "<=",
                36.0,
            ),
        ],
    ),
]

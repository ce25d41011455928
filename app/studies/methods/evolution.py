"""NSGA-II of pymoo, one generation at a time.

A generation depends only on the previous one, the seed and its number. So an interrupted search continues
with its unfinished generation.

References
----------
Deb, Pratap, Agarwal and Meyarivan 2002, IEEE Trans. Evol. Comput. 6, 182.
"""

from __future__ import annotations

from typing import Protocol, cast

import numpy as np

from app.studies.methods.correction import CorrectedAnswer, SearchView
from app.studies.methods.extras import extra
from app.studies.methods.stages import Stages
from templates.core.arrays import Array


class Population(Protocol):
    """The part of pymoo's populations that this module uses."""

    def __len__(self) -> int: ...

    def get(self, name: str) -> Array:
        """Return the variables `X`, the objectives `F` or the constraints `G` of all members."""
        ...


class Algorithm(Protocol):
    """The part of pymoo's algorithms that this module uses."""

    pop: Population

    def ask(self) -> Population | None:
        """Return the members to evaluate."""
        ...

    def tell(self, *, infills: Population) -> object:
        """Receive evaluated members."""
        ...


def evolved(
    surface: CorrectedAnswer,
    population: Array,
    seeds: tuple[int, int],
    generations: int,
    stages: Stages,
    name: str,
) -> Array:
    """Return the last population of NSGA-II as points of the unit cube, shape (P, d).

    Parameters
    ----------
    population
        The first population.
    seeds
        The seed of the search, and the number of the round.
    stages, name
        The store of the generations, and the name under which they are stored.
    """
    size = len(population)

    def first() -> tuple[Array, ...]:
        return population, *_for_pymoo(surface(population))

    def following(number: int, members: tuple[Array, ...]) -> tuple[Array, ...] | None:
        seed = int(np.random.SeedSequence([*seeds, number]).generate_state(1)[0])
        return _next(surface, members, size, seed)

    return stages.stepped(name, first, following, generations)[0]


def _next(
    surface: CorrectedAnswer, members: tuple[Array, ...], size: int, seed: int
) -> tuple[Array, ...] | None:
    """Return the next generation as points, objectives and constraints; None if there are no new points."""
    kinds = surface.problem
    problem = extra("pymoo.core.problem").Problem(
        n_var=len(kinds.space), n_obj=len(kinds.objectives), n_ieq_constr=len(kinds.held) + 1, xl=0.0, xu=1.0
    )
    before = extra("pymoo.core.population").Population.new(**dict(zip("XFG", members, strict=True)))
    nsga2 = extra("pymoo.algorithms.moo.nsga2").NSGA2(pop_size=size, sampling=before)
    nsga2.setup(problem, termination=("n_gen", 3), seed=seed, verbose=False)
    algorithm = cast(Algorithm, nsga2)
    parents = algorithm.ask()
    assert parents is not None, "the first members are those that were given"
    _tell(algorithm, problem, parents, parents.get("F"), parents.get("G"))
    new = algorithm.ask()
    if new is None or not len(new):
        return None
    _tell(algorithm, problem, new, *_for_pymoo(surface(np.asarray(new.get("X"), dtype=np.float64))))
    places, objectives, constraints = (
        np.asarray(algorithm.pop.get(part), dtype=np.float64) for part in "XFG"
    )
    return places, objectives, constraints


def _tell(
    algorithm: Algorithm, problem: object, members: Population, objectives: Array, constraints: Array
) -> None:
    static, evaluator = extra("pymoo.problems.static").StaticProblem, extra("pymoo.core.evaluator").Evaluator
    evaluator().eval(static(problem, F=objectives, G=constraints), members)
    algorithm.tell(infills=members)


def _for_pymoo(seen: SearchView) -> tuple[Array, Array]:
    """Return objectives and constraints, which are met at zero or less.

    An additional constraint states whether a row has results.
    """
    complete = seen.complete
    objectives = np.where(complete[:, None], seen.objectives, 0.0)
    margins = np.where(complete[:, None], -seen.margins, 0.0)
    return objectives, np.column_stack([margins, np.where(complete, -1.0, 1e6)])

"""The request body of a tolerance analysis."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, ConfigDict, Field, StringConstraints

from app.designs.document import CriterionName, Word
from app.schemas.bounds import Bounded, at_most
from app.tolerances.analysis import LEAST_POINTS, MOST_OUTPUTS, MOST_POINTS
from app.tolerances.question import Question

NAME = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63}){0,2}$"
Named = Annotated[str, StringConstraints(pattern=NAME)]


def _whole(raw: object) -> object:
    """Return a number without a fraction as an integer; JSON Schema also accepts 1024.0 as an integer."""
    return int(raw) if isinstance(raw, float) and raw.is_integer() else raw


Whole = BeforeValidator(_whole)


class ToleranceIn(Bounded):
    """The outputs and criteria to analyse, and how many products to sample."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"outputs": ["film.minimum_film_thickness"], "criteria": ["film.film"], "seed": 1}]
        },
    )

    outputs: Annotated[list[Named], Field(min_length=1, max_length=MOST_OUTPUTS)] | None = Field(
        None, description="outputs of steps, and parameters; default: those that criteria judge"
    )
    criteria: Annotated[list[CriterionName], Field(max_length=200)] | None = Field(
        None, description="criteria by name; default: all that are not waived"
    )
    points: Annotated[int, Field(ge=LEAST_POINTS, le=MOST_POINTS), Whole] | None = Field(
        None,
        description="number of sampled products, a power of two; default: 16384, and up to 131072 if the "
        "standard error of a yield would otherwise exceed 0.0005",
    )
    seed: Annotated[int, Field(ge=0, lt=2**31), Whole] = Field(
        1, description="the same seed gives the same answer"
    )
    levels: Annotated[dict[Word, Word], Field(max_length=100), at_most(100)] = Field(
        {}, description="levels of fidelity by step, instead of those of the design"
    )

    def question(self) -> Question:
        """Return the request in the form that a process receives."""
        return Question(
            None if self.outputs is None else tuple(self.outputs),
            None if self.criteria is None else tuple(self.criteria),
            self.points,
            self.seed,
            tuple(sorted(self.levels.items())),
        )

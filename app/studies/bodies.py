"""Request bodies of studies."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, StringConstraints, ValidationError, model_validator
from pydantic.config import JsonDict

from app.calculations.errors import InvalidBody
from app.designs.bodies import LONGEST_NOTE
from app.designs.document import CriterionName
from app.plain import JsonObject
from app.schemas.bounds import Bounded, at_most
from app.schemas.values import Between, Given
from app.studies.schemas import Method

MOST_VARIED, MOST_OUTPUTS, MOST_BUILT, MOST_SEED = 20, 50, 200, 2**32 - 1
MOST_ROWS = {"grid": 10**6, "table": 10**5, "sample": 10**6, "sensitivity": 10**5, "optimise": 10**5}
"""Largest number of rows of a study, by method."""

_STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)
_PLACE = r"^[A-Za-z][A-Za-z0-9_]{0,63}(\.[A-Za-z][A-Za-z0-9_]{0,63}){0,2}$"
Place = Annotated[str, StringConstraints(pattern=_PLACE)]
"""A parameter, `step.input`, `model.parameter` or `step.output`."""
VariantName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,63}$")]
Places = Annotated[list[Place], Field(max_length=MOST_OUTPUTS)]


class Vary(Bounded):
    """The values of one varied place: an interval between two bounds, or a list."""

    model_config = _STRICT

    between: Between | None = Field(None, examples=[["0.03 mm", "0.09 mm"]])
    values: Annotated[list[Given], Field(min_length=1, max_length=10_000)] | None = Field(
        None, examples=[["18 mm", "20 mm"]]
    )
    spacing: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def one_of_both(self) -> Self:
        """Check that either bounds or a list are given, not both."""
        if (self.between is None) == (self.values is None):
            raise ValueError("give either `between`, two bounds, or `values`, a list")
        return self


class StageAccuracy(Bounded):
    """The accuracy that the levels of a stage must reach."""

    model_config = _STRICT

    tolerance: float = Field(gt=0, lt=1, description="relative error that the levels may have")


EXAMPLE: JsonDict = {
    "design": "00000000000001abcdef0123",
    "method": "grid",
    "vary": {"scale": {"between": ["0.98", "1.02"]}},
    "steps": 5,
    "outputs": ["film.minimum_film_thickness"],
}


class StudyIn(Bounded):
    """Request for a new study."""

    model_config = ConfigDict(
        strict=True, extra="forbid", allow_inf_nan=False, json_schema_extra={"examples": [EXAMPLE]}
    )

    design: str = Field(max_length=64)
    revision: int | None = Field(
        None, ge=1, le=10**9, description="revision of the design; by default the newest"
    )
    variant: VariantName | None = Field(
        None, description="the variant to study; by default the design itself"
    )
    method: Method
    seed: int = Field(
        1, ge=0, le=MOST_SEED, description="seed of random numbers; equal seeds give equal rows"
    )
    vary: Annotated[dict[Place, Vary], Field(max_length=MOST_VARIED), at_most(MOST_VARIED)] = Field(
        {},
        description="values by parameter, `step.input` or `model.parameter`; list those with a relation in "
        "`set_aside`",
    )
    set_aside: Annotated[list[Place], Field(max_length=MOST_VARIED)] = Field(
        [], description="varied places whose relation does not apply in this study"
    )
    steps: int | dict[Place, int] | None = Field(
        None, description="for `grid`: number of steps for all intervals, or by name"
    )
    rows: dict[Place, Given] | list[dict[Place, Given]] | None = Field(
        None, description="for `table`: columns by name, each an array with its unit, or a list of rows"
    )
    points: int | None = Field(
        None, ge=1, description="for `sample`: number of rows; for `sensitivity`: base number of points"
    )
    sequence: Literal["sobol", "lhs"] = Field("sobol", description="for `sample`")
    kind: Literal["local", "morris", "sobol"] = Field("local", description="for `sensitivity`")
    outputs: Places = Field([], description="outputs to store for each row, besides the objectives")
    minimise: Places = []
    maximise: Places = []
    hold: Annotated[list[CriterionName], Field(max_length=100)] | None = Field(
        None, description="criteria that a row must meet; by default all criteria of the design"
    )
    explore: StageAccuracy | None = Field(
        None, description="accuracy of the exploration; by default at the levels of the design"
    )
    confirm: StageAccuracy | None = Field(
        None, description="accuracy to which the best rows are recalculated"
    )
    build: (
        Literal["none", "best", "front", "all"]
        | Annotated[list[Annotated[int, Field(ge=0)]], Field(min_length=1, max_length=MOST_BUILT)]
    ) = Field("none", description=f"rows that become variants of a new design; at most {MOST_BUILT}")


def study_of(raw: JsonObject) -> StudyIn:
    """Return the request for a study from plain values.

    Raises
    ------
    InvalidBody
        If there are faults; the error lists all of them.
    """
    try:
        return StudyIn.model_validate(raw)
    except ValidationError as error:
        raise InvalidBody.of(error) from None


class ChooseIn(Bounded):
    """Request to create a revision with the values of a row."""

    model_config = ConfigDict(strict=True, extra="forbid", json_schema_extra={"examples": [{"row": 2}]})

    row: int = Field(ge=0, le=10**9)
    note: str | None = Field(None, max_length=LONGEST_NOTE)

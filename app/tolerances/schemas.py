"""The effect of tolerances on the outputs of a design: limits, scatter, shares and yields."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Self

from pydantic import ConfigDict, Field

from app.presentation.units import System, shown_unit, shown_value
from app.schemas.answers import Answer, Quantity, Warning


class TolerancedValue(Answer):
    """A value that lies between limits."""

    nominal: Quantity
    low: Quantity
    high: Quantity
    distribution: Literal["normal", "uniform", "triangular"] = Field(
        description="between the limits; of `normal` they stand at three standard deviations, where it is cut"
    )
    zone: str | None = Field(None, description="of ISO 286")


class Extreme(Answer):
    """An end of the range of an output."""

    value: float = Field(description="in the unit of the output")
    at: dict[str, Quantity] = Field(description="the toleranced values there")


class Worst(Answer):
    """The least and the largest value within the limits."""

    low: Extreme
    high: Extreme


class Share(Answer):
    """The part of an output's variance that one toleranced value causes."""

    first: float = Field(description="alone")
    total: float = Field(description="alone and together with others")
    first_standard_error: float
    total_standard_error: float


class SharesSum(Answer):
    """The first-order shares together: one where no two values act together, less where they do."""

    value: float
    standard_error: float


class Yield(Answer):
    """The share of products that meet a criterion."""

    of: str = Field(description="the criterion")
    value: float = Field(description="where the value itself is compared with its limit")
    standard_error: float = Field(description="of the sampling; from the spread of eight scramblings")
    with_model_error: list[float] = Field(
        min_length=2,
        max_length=2,
        description="the share that surely meets it, and the share that may: the model is off by its stated "
        "error. Scatter is not in it",
    )
    error_stated: bool = Field(description="whether the error of the model was measured at all")
    limit: float | None = Field(
        None, description="in the unit of the output; absent where it differs from product to product"
    )
    sign: Literal[">=", "<="] = Field(description="of the criterion")
    points_needed: int | None = Field(
        None, description="about how many `points` bring the standard error to 0.0005, if it is larger"
    )


class Histogram(Answer):
    """Numbers of sampled products between pairs of edges."""

    edges: list[float] = Field(description="in the unit of the output")
    counts: list[int]


class OutputScatter(Answer):
    """Scatter of one output, in `unit`; what does not apply is absent."""

    model_config = ConfigDict(populate_by_name=True)

    unit: str
    nominal: float | None = Field(description="at the values themselves; null where there is none")
    worst: Worst | None = None
    mean: float | None = None
    standard_deviation: float | None = None
    quantiles: dict[str, float] = Field({}, description="by their share of the products")
    shares: dict[str, Share] = Field({}, description="by toleranced value, the largest total first")
    shares_sum: SharesSum | None = None
    histogram: Histogram | None = None
    relative_error: float | None = Field(
        None, description="largest stated error of the step that computes it; beside the scatter, not in it"
    )
    yield_: Yield | None = Field(None, alias="yield", description="the lowest of `yields`")
    yields: list[Yield] = Field([], description="of the criteria that hold it against a limit")
    reason: str | None = Field(None, description="why something is absent")

    def in_units(self, system: System) -> Self:
        """Return the numbers in a system of units."""
        if system == "si":
            return self

        def shown(value: float) -> float:
            return float(str(shown_value(value, self.unit, system)))

        numbers = {
            "nominal": None if self.nominal is None else shown(self.nominal),
            "mean": None if self.mean is None else shown(self.mean),
            "quantiles": {share: shown(value) for share, value in self.quantiles.items()},
            "worst": self.worst and _worst_in(self.worst, shown, system),
            "histogram": self.histogram
            and self.histogram.model_copy(update={"edges": list(map(shown, self.histogram.edges))}),
            "yield_": self.yield_ and _yield_in(self.yield_, shown),
            "yields": [_yield_in(one, shown) for one in self.yields],
        }
        if self.standard_deviation is not None:  # a difference
            numbers["standard_deviation"] = shown(self.standard_deviation) - shown(0.0)
        update = {name: number for name, number in numbers.items() if name in self.model_fields_set}
        return self.model_copy(update={**update, "unit": shown_unit(self.unit, system)})


def _worst_in(worst: Worst, shown: Callable[[float], float], system: System) -> Worst:
    ends = (
        Extreme(value=shown(end.value), at={name: at.in_units(system) for name, at in end.at.items()})
        for end in (worst.low, worst.high)
    )
    return Worst(low=next(ends), high=next(ends))


def _yield_in(one: Yield, shown: Callable[[float], float]) -> Yield:
    return one if one.limit is None else one.model_copy(update={"limit": shown(one.limit)})


class RefusedProducts(Answer):
    """Products that the design refuses."""

    rows: int
    at: dict[str, Quantity] = Field(description="the toleranced values of one of them")
    reason: str


class UnjudgedCriterion(Answer):
    """A criterion without a yield."""

    reason: str
    give: list[str] = Field([], description="what is missing")


class About(Answer):
    """The scope of an analysis of tolerances, with all that it left out."""

    revision: int
    points: int = Field(description="products that were sampled for quantiles and yields")
    seed: int
    rows: int = Field(description="rows of the design that were calculated in all")
    toleranced: dict[str, TolerancedValue] = Field(description="values that varied")
    levels: dict[str, str] = Field(description="of fidelity, by step; the same for all rows")
    criteria: dict[str, Yield] = Field({}, description="the yield of each criterion")
    not_judged: dict[str, UnjudgedCriterion] = {}
    refused: RefusedProducts | None = None
    warnings: list[Warning] = Field([], description="tolerances that had no part in this")


class ToleranceAnalysis(Answer):
    """Outputs by name, and in `analysis` what was analysed; no revision is made."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, OutputScatter] = Field(init=False)

    analysis: About

    @property
    def outputs(self) -> dict[str, OutputScatter]:
        """Return the outputs by name."""
        return dict(self.__pydantic_extra__ or {})

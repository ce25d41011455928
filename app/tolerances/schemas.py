"""Response schemas for the effect of tolerances: limits, scatter, shares of the variance, and yields."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Self

from pydantic import ConfigDict, Field

from app.presentation.units import System, shown_unit, shown_value
from app.schemas.answers import Answer, Quantity, Warning


class TolerancedValue(Answer):
    """A value with a tolerance."""

    nominal: Quantity
    low: Quantity
    high: Quantity
    distribution: Literal["normal", "uniform", "triangular"] = Field(
        description="distribution between the limits; `normal` is cut off at three standard deviations"
    )
    zone: str | None = Field(None, description="ISO 286 tolerance zone")


class Extreme(Answer):
    """An end of the range of an output."""

    value: float = Field(description="value in the unit of the output")
    at: dict[str, Quantity] = Field(description="the toleranced values at this end")


class Worst(Answer):
    """The smallest and the largest value of an output within the limits."""

    low: Extreme
    high: Extreme


class Share(Answer):
    """The part of an output's variance that one toleranced value causes."""

    first: float = Field(description="share of the value alone")
    total: float = Field(description="share including interactions with other values")
    first_standard_error: float
    total_standard_error: float


class SharesSum(Answer):
    """The sum of the first-order shares: 1 if no two values interact, less if they do."""

    value: float
    standard_error: float


class Yield(Answer):
    """The share of products that meet a criterion."""

    of: str = Field(description="the criterion")
    value: float = Field(description="share of products whose calculated value meets the limit")
    standard_error: float = Field(
        description="standard error of sampling, from the spread between scramblings"
    )
    with_model_error: list[float] = Field(
        min_length=2,
        max_length=2,
        description="the share that certainly meets the limit and the share that may, if the model is "
        "wrong by its stated error; scatter and model error are not added",
    )
    error_stated: bool = Field(description="whether the error of the model was measured")
    limit: float | None = Field(
        None, description="limit in the unit of the output; absent if it differs between products"
    )
    sign: Literal[">=", "<="] = Field(description="sign of the criterion")
    points_needed: int | None = Field(
        None, description="estimated `points` for a standard error of 0.0005, if it is larger now"
    )


class Histogram(Answer):
    """Numbers of sampled products between successive edges."""

    edges: list[float] = Field(description="edges of the bins, in the unit of the output")
    counts: list[int]


class OutputScatter(Answer):
    """Scatter of one output, in `unit`; fields that do not apply are absent."""

    model_config = ConfigDict(populate_by_name=True)

    unit: str
    nominal: float | None = Field(description="output at the nominal values; null if there is none")
    worst: Worst | None = None
    mean: float | None = None
    standard_deviation: float | None = None
    quantiles: dict[str, float] = Field({}, description="quantiles by their share of the products")
    shares: dict[str, Share] = Field({}, description="shares by toleranced value, the largest total first")
    shares_sum: SharesSum | None = None
    histogram: Histogram | None = None
    relative_error: float | None = Field(
        None, description="largest stated error of the step that computes it; not added to the scatter"
    )
    yield_: Yield | None = Field(None, alias="yield", description="the criterion with the lowest yield")
    yields: list[Yield] = Field([], description="yields of the criteria that compare the output with a limit")
    reason: str | None = Field(None, description="why results are absent")

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
    at: dict[str, Quantity] = Field(description="the toleranced values of one refused product")
    reason: str


class UnjudgedCriterion(Answer):
    """A criterion without a yield."""

    reason: str
    give: list[str] = Field([], description="what is missing")


class About(Answer):
    """The scope of a tolerance analysis, and everything that it left out."""

    revision: int
    points: int = Field(description="number of products sampled for quantiles and yields")
    seed: int
    rows: int = Field(description="total number of calculated rows of the design")
    toleranced: dict[str, TolerancedValue] = Field(description="values that varied")
    levels: dict[str, str] = Field(description="levels of fidelity by step, the same for all rows")
    criteria: dict[str, Yield] = Field({}, description="the yield of each criterion")
    not_judged: dict[str, UnjudgedCriterion] = {}
    refused: RefusedProducts | None = None
    warnings: list[Warning] = Field([], description="warnings about tolerances that the analysis omits")


class ToleranceAnalysis(Answer):
    """Outputs by name, and in `analysis` the scope; no revision is created."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, OutputScatter] = Field(init=False)

    analysis: About

    @property
    def outputs(self) -> dict[str, OutputScatter]:
        """Return the outputs by name."""
        return dict(self.__pydantic_extra__ or {})

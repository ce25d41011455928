"""Rows of a study as its result shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.schemas.answers import Quantity
from app.studies.row_columns import OUTPUT, PLACE, StoredRows
from app.studies.run import Run
from app.studies.schemas import Best
from templates.core.arrays import Integers
from templates.core.judging.comparison import WORST_FIRST
from templates.core.units.units import unit


def rows_found(run: Run, stored: StoredRows, numbers: Integers, *, confirmed: bool) -> list[Best]:
    """Return rows as a result shows them.

    `confirmed` says whether they were calculated again at finer levels.
    """
    plan = run.plan
    places = stored.rows([f"{PLACE}{name}" for name in plan.places], numbers)
    outputs = stored.rows([f"{OUTPUT}{name}" for name in plan.outputs], numbers)
    codes = {name: stored.codes(name)[numbers] for name in plan.criteria}
    worst = stored.worst(plan.required)[numbers]
    return [
        Best.model_validate(
            {
                "row": number,
                "at": quantities(plan.units, plan.places, places[n].tolist()),
                "outputs": quantities(plan.units, plan.outputs, outputs[n].tolist()),
                "confirmed": confirmed,
                **_verdicts({name: int(code[n]) for name, code in codes.items()}),
                **({"verdict": WORST_FIRST[int(worst[n])]} if plan.required else {}),
            }
        )
        for n, number in enumerate(numbers.tolist())
    ]


def _verdicts(codes: Mapping[str, int]) -> dict[str, object]:
    return {"verdicts": {name: WORST_FIRST[code] for name, code in codes.items()}} if codes else {}


def quantities(
    units: Mapping[str, str], names: Sequence[str], values: Sequence[float]
) -> dict[str, Quantity]:
    """Return values [SI] as quantities in their units; those that do not exist are left out."""
    pairs = ((name, value) for name, value in zip(names, values, strict=True) if np.isfinite(value))
    return {
        name: Quantity(value=float(unit(units[name]).from_si(value)), unit=units[name])
        for name, value in pairs
    }

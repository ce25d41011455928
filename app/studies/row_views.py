"""Rows of a study for the response with its result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.schemas.answers import Quantity
from app.studies.row_columns import OUTPUT, PLACE, StoredRows
from app.studies.run import Run
from app.studies.schemas import Best
from templates.core.arrays import Integers
from templates.core.criteria.comparison import MET_ERROR_UNKNOWN, NOT_CHECKED, VERDICTS
from templates.core.units.units import unit


def rows_found(run: Run, stored: StoredRows, numbers: Integers, *, confirmed: bool) -> list[Best]:
    """Return rows as members of a result.

    `confirmed` states whether they were recalculated at finer levels.
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
                "confirmed": confirmed and int(worst[n]) != MET_ERROR_UNKNOWN,
                **verdict_fields({name: int(code[n]) for name, code in codes.items()}, plan.required),
            }
        )
        for n, number in enumerate(numbers.tolist())
    ]


def verdict_fields(codes: Mapping[str, int], required: Sequence[str]) -> dict[str, object]:
    """Return the verdicts of a row, the worst of them, and the criteria met with an unknown error."""
    fields: dict[str, object] = {}
    if codes:
        fields["verdicts"] = {name: VERDICTS[code] for name, code in codes.items()}
    if required:
        fields["verdict"] = VERDICTS[min(codes.get(name, NOT_CHECKED) for name in required)]
    if unknown := [name for name, code in codes.items() if code == MET_ERROR_UNKNOWN]:
        fields["error_unknown"] = unknown
    return fields


def quantities(
    units: Mapping[str, str], names: Sequence[str], values: Sequence[float]
) -> dict[str, Quantity]:
    """Return values [SI] as quantities in their units; missing values are left out."""
    pairs = ((name, value) for name, value in zip(names, values, strict=True) if np.isfinite(value))
    return {
        name: Quantity(value=float(unit(units[name]).from_si(value)), unit=units[name])
        for name, value in pairs
    }

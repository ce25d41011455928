"""Cases whose columns are inputs and outputs of a template: nothing else needs to be declared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from templates import get
from templates.validate.case import Numbers
from templates.validate.reference import Reference, Row, reference


def by_template(
    id: str, version: int, file: str, level: str | None = None, **constants: Any
) -> Callable[[Sequence[Row]], Numbers]:
    """Return a function that calculates the rows of a file with a template.

    A column named as an input is that input, in the column's unit; several numbers in a cell are a list. A
    compared column is the output of its name. `constants` are inputs that the file does not contain.
    """

    def ours(rows: Sequence[Row]) -> Numbers:
        source = reference(file)
        template = get(id, version)
        names = [column.name for column in source.compared]
        found: dict[str, list[float]] = {name: [] for name in names}
        for row in rows:
            inputs = {n: _input(source, n, cell) for n, cell in row.items() if n in template.inputs and cell}
            result = template(level=level, **{**constants, **inputs})
            for name in names:
                quantity = getattr(result, name)
                unit = source.columns[name].unit
                found[name].append(float(quantity if unit == "1" else quantity.to(unit).magnitude))
        return found

    return ours


def _input(source: Reference, name: str, cell: str) -> Any:
    """Return a cell as an input: a word, a number of unit 1, a quantity or a list of them."""
    unit = source.columns[name].unit
    if not unit:
        return cell
    values = [float(part) for part in cell.split()]
    return {"value": values if len(values) > 1 else values[0], "unit": unit}

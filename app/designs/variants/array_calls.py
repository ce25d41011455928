"""Evaluate one step for several variants: one array call for all whose inputs have the same form."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.designs.engine.calculation import DEFERRED, DocumentCalculation
from app.designs.engine.steps import memory
from app.designs.network import Block, Graph
from app.plain import Raw
from app.pool.errors import StepDeferred
from templates.core.arrays import Array
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import Evaluation, answers_only
from templates.core.language.intake import is_single
from templates.core.language.levels import at_level
from templates.core.language.spec import Curve, Declaration, Profile, Table
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity
from templates.core.units.units import Value

MOST_ROWS = 4096


@dataclass(frozen=True)
class StepInputs:
    """The inputs of a step for one variant by name, as read."""

    block: Block
    raw: Mapping[str, Raw]
    graph: Graph

    @property
    def wanted(self) -> tuple[str, ...] | None:
        """Return the outputs to compute; None for all."""
        return self.graph.computed(self.block)

    def form(self) -> Hashable:
        """Return the key of an array call, which is equal for variants that can share it.

        The key contains the step, the names of the inputs, the shapes of curves, and the values of choices,
        tables and inputs that must be equal at all points. It is None for a variant that must be calculated
        alone.
        """
        parts = [(name, _form(self.block, name, raw)) for name, raw in sorted(self.raw.items())]
        if any(form is None for _, form in parts):
            return None
        return self.block.cls, self.block.level, self.block.tolerance, self.wanted, tuple(parts)


def _form(block: Block, name: str, raw: Raw) -> Hashable:
    declared = block.cls.inputs[name]
    if not isinstance(raw, TypedQuantity):
        return repr(raw)
    shape = np.shape(raw.si)
    is_curve = isinstance(declared, Curve)
    if isinstance(declared, Table) or is_single(declared) or (is_curve and not shape):
        return shape, np.asarray(raw.si).tobytes()
    return shape if len(shape) == int(is_curve) else None


def evaluations(asked: Sequence[StepInputs]) -> list[DocumentCalculation | None]:
    """Return the evaluation of each variant, or `DEFERRED` if the caller does not wait for it.

    The entry is None if the variant must be calculated alone.
    """
    results: list[DocumentCalculation | None] = [None] * len(asked)
    groups: dict[Hashable, list[int]] = {}
    for place, one in enumerate(asked):
        if (form := one.form()) is not None:
            groups.setdefault(form, []).append(place)
    for places in groups.values():
        for chunk in _chunks(asked[places[0]].block, places):
            shared = _shared([asked[place] for place in chunk])
            for place, evaluation in zip(chunk, shared, strict=True):
                results[place] = evaluation
    return results


def _chunks(block: Block, places: Sequence[int]) -> Iterator[Sequence[int]]:
    """Yield the numbers of variants in chunks, each small enough for one array call."""
    level = block.level or block.cls.default_level
    most = [block.cls.most_points.get(level, MOST_ROWS)]
    most += block.cls.most_points.values() if block.tolerance is not None else []
    size = min(most)
    for start in range(0, len(places), size):
        yield places[start : start + size]


def _shared(asked: Sequence[StepInputs]) -> Sequence[DocumentCalculation | None]:
    """Return the evaluations of one array call, or of two calls for its halves if it is refused."""
    if len(asked) < 2:
        return [None] * len(asked)  # a single variant is calculated in the normal way
    first = asked[0]
    try:
        whole = memory.evaluation(first.block, _stacked(asked), first.wanted)
    except StepDeferred:
        return [DEFERRED] * len(asked)
    except InvalidInputs:
        half = len(asked) // 2
        return [*_shared(asked[:half]), *_shared(asked[half:])]
    if not whole.template.shape_of_points():
        return [whole] * len(asked)  # all inputs are equal
    rows = _Rows(whole, len(asked))
    return [rows.evaluation(number, one) for number, one in enumerate(asked)]


def _stacked(asked: Sequence[StepInputs]) -> dict[str, Raw]:
    """Return each input for all rows: one value if all are equal, else an array with the row first."""
    return {name: _column(asked, name) for name in asked[0].raw}


def _column(asked: Sequence[StepInputs], name: str) -> Raw:
    first = asked[0].raw[name]
    typed = [raw for one in asked if isinstance(raw := one.raw[name], TypedQuantity)]
    if not isinstance(first, TypedQuantity) or all(np.array_equal(first.si, other.si) for other in typed):
        return first
    scale = asked[0].block.cls.inputs[name].meaning.scale
    si: Array = np.array([one.si for one in typed], dtype=np.float64)
    return TypedQuantity(np.asarray(scale.from_si(si)).tolist(), scale.text, si, {})


def _in_row(row: int, error: Value | None) -> Value | None:
    """Return the error of one row; the array call has computed it with everything that it depends on."""
    return error[row] if isinstance(error, np.ndarray) and error.ndim else error


@dataclass(frozen=True)
class _Rows:
    """The result of an array call, read row by row.

    A row has the values and errors that the array call computed: nothing is calculated again for it.
    """

    whole: Evaluation
    count: int

    def evaluation(self, row: int, asked: StepInputs) -> Evaluation | None:
        """Return the evaluation of one row; None if it is refused and must be calculated alone."""
        try:
            template = self._template(row, asked)
            answers = answers_only(template, self.whole.outputs)
        except InvalidInputs:
            return None
        errors = {name: _in_row(row, error) for name, error in self.whole.error.items()}
        seconds = self.whole.seconds / self.count
        return Evaluation(template, {}, answers, self.whole.level, errors, [], seconds)

    def _template(self, row: int, asked: StepInputs) -> Template:
        """Return the template of one variant with the values that the array call has computed.

        Values that are missing in the row are omitted, so that the template itself determines the reason.
        """
        cls, level = asked.block.cls, self.whole.level
        template = cls.from_quantities(asked.raw)
        template = at_level(template, level) if level is not None else template
        computed = vars(self.whole.template)
        for attribute, declared in cls.declarations.items():
            if attribute in computed and attribute not in vars(template):
                value = self._value(row, declared, computed[attribute])
                if isinstance(value, str) or np.isfinite(value).all():
                    vars(template)[attribute] = value
        return template

    def _value(self, row: int, declared: Declaration, value: Any) -> Any:
        """Return the value of an attribute in one row."""
        axes = declared.axes if isinstance(declared, Profile) else int(isinstance(declared, Curve))
        own = value[row] if isinstance(value, np.ndarray) and value.ndim > axes else value
        return str(own) if isinstance(own, str) else own

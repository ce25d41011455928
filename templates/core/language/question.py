"""Read and check the question of `solve`: the unknown, its bounds and the target."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_name
from templates.core.language.intake import is_single
from templates.core.language.request import read_options
from templates.core.language.spec import Choice, Curve, Formula, Input, Profile, Table, Text
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity, read, read_beside
from templates.core.units.units import Value


def read_question(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    between: Sequence[Any],
    target: Mapping[str, Any],
    *,
    tolerance: float | None = None,
    **names: Any,
) -> tuple[Input, tuple[float, float], Formula[Any], float]:
    """Return the declarations and SI values that define the question; `names` are passed to `read_options`.

    Raises
    ------
    InvalidInputs
        If the question has faults; the error lists all of them.
    """
    *_, faults = read_options(cls, **names)
    declared, formula = _unknown(cls, unknown, faults), None
    if unknown in raw:
        faults.append(Fault(f"inputs.{unknown}", "solved_for", "this input is solved for; omit it"))
    ends = _ends(declared, between, faults) if declared else (0.0, 1.0)
    wanted = 0.0
    if len(target) != 1:
        faults.append(Fault("target", "one_output", "name exactly one output and its wanted value"))
    for name, value in list(target.items())[:1]:
        formula = cls.formulas.get(name)
        if formula is None:
            faults.append(unknown_name(name, cls.formulas, "output").within("target"))
        elif isinstance(formula, (Profile, Text)):
            faults.append(
                Fault(f"target.{name}", "not_a_number", "the target must be an output with a single value")
            )
        else:
            wanted = _scalar(read_beside, value, formula.meaning.accepted, f"target.{name}", faults)
    faults += _faulty_inputs(cls, raw, unknown, declared, ends)
    if faults or declared is None or formula is None:
        raise InvalidInputs(faults)
    return declared, ends, formula, wanted


def _unknown(cls: type[Template], name: str, faults: list[Fault]) -> Input | None:
    """Return the declaration of the unknown, if it is a quantity with continuous values."""
    declared = cls.inputs.get(name)
    if declared is None:
        fault = unknown_name(name, _solvable(cls), "input")
        faults.append(Fault("unknown", fault.code, fault.detail))
    elif name not in _solvable(cls):
        detail = f"{name} takes no continuous values; one of {', '.join(_solvable(cls))} can be solved for"
        faults.append(Fault("unknown", "not_solvable", detail))
        return None
    return declared


def _solvable(cls: type[Template]) -> list[str]:
    discrete = (Choice, Curve, Table)
    return [
        n for n, d in cls.inputs.items() if not (isinstance(d, discrete) or d.meaning.integer or is_single(d))
    ]


def _ends(declared: Input, between: Sequence[Any], faults: list[Fault]) -> tuple[float, float]:
    if len(between) != 2:
        faults.append(
            Fault("between", "two_values", "give two bounds: the lowest and the highest value to try")
        )
        return 0.0, 1.0
    low, high = (_scalar(read, end, declared.meaning.accepted, "between", faults) for end in between)
    if low >= high:
        faults.append(Fault("between", "not_ascending", "the first bound must be below the second"))
    return low, high


def _scalar(
    read_as: Callable[[Any, str], TypedQuantity], raw: Any, unit: str, name: str, faults: list[Fault]
) -> float:
    try:
        typed = read_as(raw, unit)
        if np.ndim(typed.si):
            raise FaultyText("not_a_number", "give a single value here, not an array")
        return float(typed.si)
    except FaultyText as error:
        faults.append(error.fault(name))
        return np.nan


def _faulty_inputs(
    cls: type[Template],
    raw: Mapping[str, Any],
    unknown: str,
    declared: Input | None,
    ends: tuple[float, float],
) -> list[Fault]:
    """Return the faults of the other inputs, checked with the unknown in the middle of its bounds."""
    curves = [name for name, d in cls.inputs.items() if isinstance(d, (Curve, Table))]
    arrays = [name for name, value in raw.items() if _is_array(value) and name not in curves]
    faults = [
        Fault(f"inputs.{n}", "not_a_number", "solve needs a single value here, not an array") for n in arrays
    ]
    probe = {name: value for name, value in raw.items() if name not in arrays}
    if declared and np.all(np.isfinite(ends)):
        probe[unknown] = typed_values(declared, np.array(ends))
    try:
        cls.from_quantities(probe)
    except InvalidInputs as error:
        faults += [fault.within("inputs") for fault in error.faults if fault.name not in (unknown, *arrays)]
    return faults


def _is_array(value: Any) -> bool:
    return isinstance(value, list) or (isinstance(value, Mapping) and isinstance(value.get("value"), list))


def typed_values(declared: Input, si: Value) -> TypedQuantity:
    """Return values of the unknown [SI] in the form in which a user would type them."""
    return TypedQuantity(None, declared.meaning.unit, si, {})

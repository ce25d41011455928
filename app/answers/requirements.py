"""The requirements of a request as criteria of its design, so that one engine judges all of them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace

from app.answers.bodies import AnswerIn
from app.designs.document import Document, WrittenCriterion
from app.designs.graph import Graph
from app.designs.network import subjects
from app.plain import Raw
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_names
from templates.core.units.quantity import read_any
from templates.core.units.units import unit

COMPARISON = re.compile("[<>=]")
WIDTH = 2.0
"""Half the width of a target without a tolerance of its own, in tolerances of the confirmation."""
USUAL_TOLERANCE = 0.01


@dataclass(frozen=True)
class TargetBand:
    """A target: its name, its value and its tolerance, and the two criteria that bound it."""

    name: str
    least: str
    most: str
    value: float
    half: float


@dataclass(frozen=True)
class Requirements:
    """The design with its requirements as criteria.

    Attributes
    ----------
    names
        The criteria that are required; None for all of the design that can be judged.
    added
        The criteria that the request adds to the design, each with the place of the request that states it.
    """

    document: Document
    names: tuple[str, ...] | None
    targets: tuple[TargetBand, ...] = ()
    added: Mapping[str, str] = field(default_factory=dict)

    def place_of(self, fault: Fault) -> Fault:
        """Return a fault of an added criterion under its place in the request."""
        name = fault.name.removeprefix("criteria.").partition(".")[0]
        return replace(fault, name=self.added[name]) if name in self.added else fault


def requirements(body: AnswerIn, document: Document) -> Requirements:
    """Return a document with the comparisons and targets of a request as criteria.

    Raises
    ------
    InvalidInputs
        If a target cannot be read; the error lists all faults.
    """
    criteria, added = dict(document.criteria), dict[str, str]()
    names: list[str] = []

    def add(require: str, stem: str, place: str) -> str:
        name = next(one for one in _names(stem) if one not in criteria)
        criteria[name], added[name] = WrittenCriterion(require=require), place
        names.append(name)
        return name

    for number, text in enumerate(body.require or ()):
        if COMPARISON.search(text):
            add(text, _stem(text), f"require.{number}")
        else:
            names.append(text)
    targets = list(_targets(body))
    bands = [
        TargetBand(
            name,
            add(f"{name} >= {lower!r}{suffix}", f"{_stem(name)}_least", f"targets.{name}"),
            add(f"{name} <= {upper!r}{suffix}", f"{_stem(name)}_most", f"targets.{name}"),
            value,
            half,
        )
        for name, lower, upper, suffix, value, half in targets
    ]
    is_open = body.require is None and not targets
    required = None if is_open else tuple(dict.fromkeys(names))
    return Requirements(document.model_copy(update={"criteria": criteria}), required, tuple(bands), added)


def _stem(text: str) -> str:
    """Return the names in a text as one name: `film.power_loss <= 1 kW` becomes `film_power_loss_most`."""
    subject = re.split("[<>=]", text, maxsplit=1)[0]
    end = "_least" if ">" in text else "_most" if "<" in text else ""
    words = "_".join(re.findall(r"[A-Za-z0-9_]+", subject)) or "requirement"
    return (words if words[0].isalpha() else f"requirement_{words}")[:50].rstrip("_") + end


def _names(stem: str) -> Iterator[str]:
    yield stem
    number = 2
    while True:
        yield f"{stem}_{number}"
        number += 1


def _targets(body: AnswerIn) -> Iterator[tuple[str, float, float, str, float, float]]:
    """Yield each target: name, least and greatest value in its unit, that unit, value and half width [SI]."""
    faults: list[Fault] = []
    for name, raw in body.targets.items():
        try:
            yield name, *_band(raw, body.tolerance or USUAL_TOLERANCE)
        except FaultyText as error:
            faults.append(error.fault(f"targets.{name}"))
    if faults:
        raise InvalidInputs(faults)


def _band(raw: Raw, tolerance: float) -> tuple[float, float, str, float, float]:
    typed = read_any(raw)
    scale, value = unit(typed.unit), typed.si
    if not isinstance(value, float):
        raise FaultyText("not_a_number", "give a single value here, not an array")
    lower = upper = WIDTH * tolerance * abs(value)
    if typed.tolerance is not None:
        lower, upper = -float(typed.tolerance.lower), float(typed.tolerance.upper)
    if lower + upper <= 0:
        raise FaultyText("missing", "a target of 0 needs a tolerance, such as `0 ± 0.1 um`")
    ends = (float(scale.from_si(end)) for end in (value - lower, value + upper))
    suffix = "" if typed.unit == "1" else f" {typed.unit}"
    least, most = (float(f"{end:.15g}") for end in ends)
    return least, most, suffix, value + (upper - lower) / 2, (lower + upper) / 2


def named(asked: Requirements, graph: Graph, judged: Collection[str]) -> list[str]:
    """Return the required criteria: the named ones, else all that are judged and not waived.

    Raises
    ------
    InvalidInputs
        If the design does not have one of them, or none can be judged.
    """
    if asked.names is None:
        waived = {name for name, one in asked.document.criteria.items() if one.waived}
        return [name for name in judged if name not in waived]
    every = subjects(graph)
    unknown = [name for name in asked.names if name not in every]
    if unknown:
        raise InvalidInputs(fault.within("require") for fault in unknown_names(unknown, every, "requirement"))
    return list(asked.names)

"""Estimate the time of a calculation, from measured costs of its levels and the number of points.

The estimate gives only the order of magnitude, and is more often too high than too low. An expensive
calculation runs outside the server's process (see `app.pool.pool`).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from itertools import zip_longest
from weakref import WeakKeyDictionary

import numpy as np
from cachetools import LRUCache

from app.plain import Raw
from templates.core.errors import InvalidInputs
from templates.core.language.body import Body
from templates.core.language.confirmation import POLISHES
from templates.core.language.level_choice import reachable
from templates.core.language.levels import SINGLE, accuracy
from templates.core.language.scan import SAMPLES
from templates.core.language.spec import Curve, Table
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity

EXPENSIVE = 0.05  # a longer calculation runs outside the server's process [s]

IN_SERVER = 5e-3
"""Longest measured time of an array in the server's process [s]. It is the interpreter's switch interval, so
the event loop does not wait longer for the interpreter lock."""
MOST_MEASURED = 1000  # kinds of requests whose time is kept
FORGETTING = 0.99  # factor on a measured time each time it sends a request away, so that it is measured again

QUICK = 1e-4  # longest time of a quick level at one point [s]

PER_CALL, PER_OUTPUT = 2e-4, 5e-5  # time at one point, without levels [s]
PER_POINT = 2e-7  # for each number in an array output, before it is written [s]
PER_VALUE = 1e-6  # for each number of an answer, calculated and written as JSON [s]
PER_NUMBER = 5e-7  # for each number of a request, read and checked [s]
PER_FORMULA = 3e-4  # for each formula written out in a worksheet [s]
SCANS, CLOSINGS = 8, 120
"""Number of evaluations in `solve`: of all samples of its scan, then of single points."""
SOLUTIONS = 2  # number of solutions typically recalculated at the requested level
BESIDE = 2  # samples around each of these solutions
MOST_POINTS = 10**12  # upper limit; a request may claim more than a float can hold
PROBED = 1000  # with more numbers in a request, only the first of each array is read


def estimated_seconds(
    cls: type[Template],
    inputs: Mapping[str, Raw],
    level: str | None = None,
    tolerance: float | None = None,
    outputs: Collection[str] | None = None,
) -> float:
    """Return the estimated time of `evaluate` [s], including reading and writing.

    For invalid inputs the number has no meaning.
    """
    shapes = arrays(inputs)
    numbers = min(MOST_POINTS, sum(map(math.prod, shapes.values())))
    levels = _levels(cls, inputs, level, tolerance, numbers)
    points = min(MOST_POINTS, spanned(_points(cls, shapes)))
    return numbers * PER_NUMBER + _evaluating(cls, levels, points, outputs) + _profiles(cls, shapes, outputs)


def level_seconds(
    template: Template, inputs: Mapping[str, Raw], level: str, outputs: Collection[str]
) -> float:
    """Return the estimated time of outputs of a template at another of its levels [s].

    It is the expected time in the template's accuracy table, which is more accurate than the cost of the
    level.
    """
    measured = accuracy(type(template))
    expected = measured.seconds(template, level) if measured else None
    return estimated_seconds(type(template), inputs, level, None, outputs) if expected is None else expected


def array_seconds(
    cls: type[Template], level: str | None, points: int, outputs: Collection[str], calls: int, places: int
) -> float:
    """Return the estimated time of array calls in SI for a number of points [s], without reading and writing.

    `places` is the length of the longest curve, 1 if there is none.
    """
    wanted = _wanted(cls, outputs)
    plain = calls * (PER_CALL + PER_OUTPUT * len(wanted)) + PER_POINT * points * places * len(wanted)
    plain += _bodies_seconds(cls, points * places) if calls else 0.0
    if level is None or not any("level" in cls.ancestors(cls.formulas[n].attribute) for n in wanted):
        return plain
    single, vectorised = _level_costs(cls, level)
    return plain + calls * single + points * vectorised


def solving_seconds(
    cls: type[Template],
    inputs: Mapping[str, Raw],
    level: str | None = None,
    tolerance: float | None = None,
    outputs: Collection[str] | None = None,
    target: Iterable[str] = (),
) -> float:
    """Return the estimated time of `solve` [s]: a scan of many points, then a search for each solution."""
    levels = _levels(cls, inputs, level, tolerance, 0)
    aimed = list(target)
    cheap = levels if not any(name in cls.most_points for name in levels) else (cls.default_level,)
    scan = _evaluating(cls, cheap, SCANS * SAMPLES, aimed)
    closing = CLOSINGS * _evaluating(cls, cheap, 1, aimed)
    again = SOLUTIONS * (POLISHES + BESIDE)
    polishing = 0.0 if cheap == levels else again * _evaluating(cls, levels, 1, aimed)
    return scan + closing + polishing + _evaluating(cls, levels, 1, outputs)


def writing_seconds(cls: type[Template], outputs: Collection[str] | None = None) -> float:
    """Return the estimated time for writing out the formulas [s]."""
    return PER_FORMULA * len(_wanted(cls, outputs))


def is_quick(cls: type[Template]) -> bool:
    """Return whether a few points at any level take no longer than starting a thread."""
    if cls not in _quick:
        levels = cls.levels or (SINGLE,)
        seconds = [_level_costs(cls, level)[0] for level in levels] + [_bodies_seconds(cls, 1)]
        _quick[cls] = not cls.most_points and max(seconds) <= QUICK
    return _quick[cls]


_quick: WeakKeyDictionary[type[Template], bool] = WeakKeyDictionary()


def _bodies_seconds(cls: type[Template], points: int) -> float:
    """Return the estimated time of all bodies of a worksheet for some points [s]; 0 for a template file."""
    if cls.sheet is None:
        return 0.0
    if cls not in _costs:
        bodies = [formula.function for formula in cls.formulas.values()]
        one, two = (sum(body.seconds(n) for body in bodies if isinstance(body, Body)) for n in (1, 2))
        _costs[cls] = 2 * one - two, two - one
    single, each = _costs[cls]
    return single + points * each


_costs: WeakKeyDictionary[type[Template], tuple[float, float]] = WeakKeyDictionary()
"""Costs of worksheets: time of all bodies, and additional time per point [s]."""


def _points(cls: type[Template], shapes: Mapping[str, tuple[int, ...]]) -> Iterable[tuple[int, ...]]:
    """Yield the axes that count points, without the axis along a curve; tables are left out."""
    for name, shape in shapes.items():
        declared = cls.inputs.get(name)
        if not isinstance(declared, Table):
            yield shape[:-1] if isinstance(declared, Curve) else shape


def _profiles(
    cls: type[Template], shapes: Mapping[str, tuple[int, ...]], outputs: Collection[str] | None
) -> float:
    """Return the time for outputs along curves [s], in addition to that for the points."""
    curves = (math.prod(s) for name, s in shapes.items() if isinstance(cls.inputs.get(name), Curve))
    return min(MOST_POINTS, max(curves, default=0)) * len(_wanted(cls, outputs)) * PER_VALUE


def _levels(
    cls: type[Template],
    inputs: Mapping[str, Raw],
    level: str | None,
    tolerance: float | None,
    numbers: int,
) -> tuple[str, ...]:
    """Return the levels that may be calculated: one level, or with a tolerance all that may be needed."""
    if not cls.levels:
        return (SINGLE,)
    if level in cls.levels:
        return (level,)
    ladder, start = _ladder(cls, inputs, numbers)
    return (start,) if tolerance is None else reachable(cls, ladder)


def _ladder(cls: type[Template], inputs: Mapping[str, Raw], numbers: int) -> tuple[tuple[str, ...], str]:
    """Return the levels that accept these inputs, and the default level."""
    if cls.ladder is Template.ladder:
        return cls.levels, cls.default_level
    probe = inputs if numbers <= PROBED else {name: _first(cls, name, raw) for name, raw in inputs.items()}
    try:
        with np.errstate(all="ignore"):
            template = cls.from_quantities(probe)
            return template.ladder(), template.starting_level()
    except InvalidInputs:
        return (cls.default_level,), cls.default_level


def _first(cls: type[Template], name: str, raw: Raw) -> Raw:
    """Return the first value of an array in its unit; any other value is returned unchanged."""
    if isinstance(cls.inputs.get(name), (Curve, Table)):
        return raw
    if isinstance(raw, TypedQuantity):
        return raw if isinstance(raw.si, float) else replace(raw, value=None, si=float(raw.si.flat[0]))
    value = raw.get("value") if isinstance(raw, Mapping) else raw
    while isinstance(value, list) and value:
        value = value[0]
    return {**raw, "value": value} if isinstance(raw, Mapping) else value


def _wanted(cls: type[Template], outputs: Collection[str] | None) -> list[str]:
    return list(cls.formulas) if outputs is None else [name for name in outputs if name in cls.formulas]


def _evaluating(
    cls: type[Template], levels: Iterable[str], points: int, outputs: Collection[str] | None
) -> float:
    """Return the estimated total time of one evaluation of a number of points at these levels [s]."""
    wanted = _wanted(cls, outputs)
    plain = PER_CALL + PER_OUTPUT * len(wanted) + PER_VALUE * points * len(wanted)
    plain += _bodies_seconds(cls, points)
    fine = (n for n in wanted if not cls.levels or "level" in cls.ancestors(cls.formulas[n].attribute))
    if next(fine, None) is None:
        return plain
    costs = (_level_costs(cls, level) for level in levels)
    return plain + sum(single if points <= 1 else single + points * each for single, each in costs)


def _level_costs(cls: type[Template], level: str) -> tuple[float, float]:
    """Return a level's measured time for all outputs at one point, and at each of many [s]; 0 if unknown.

    If a table was measured without some outputs, its `cost_of_all` is the factor for all outputs.
    """
    measured = accuracy(cls)
    if measured is None:
        return 0.0, 0.0
    cost = measured.content["levels"].get(level, {}).get("cost", {})
    single, whole = float(cost.get("single", 0.0)), float(measured.content.get("cost_of_all", 1.0))
    return whole * single, whole * float(cost.get("vectorised", single))


Kind = tuple[type[Template], str | None, float | None, frozenset[str] | None, int]
"""Template, level, tolerance, outputs, and the power of two below the number of points."""


class MeasuredTimes:
    """The processor times of arrays in the server's process, by kind of request."""

    def __init__(self) -> None:
        self._times: LRUCache[Kind, float] = LRUCache(MOST_MEASURED)

    def leaves(self, kind: Kind, estimate: float) -> bool:
        """Return whether a request leaves the server: by its measured time, else by the estimate."""
        if (seconds := self._times.get(kind)) is None:
            return estimate > EXPENSIVE
        if seconds > IN_SERVER:
            self._times[kind] = FORGETTING * seconds
            return True
        return False

    def note(self, kind: Kind, seconds: float) -> None:
        """Keep the processor time of a request [s]; a shorter time replaces a longer one only gradually."""
        before = self._times.get(kind, 0.0)
        self._times[kind] = max(seconds, (before + seconds) / 2)


Shape = tuple[int, ...]


def points(inputs: Mapping[str, Raw]) -> int:
    """Return the number of points that the arrays among the inputs span together."""
    return spanned(arrays(inputs).values())


def arrays(inputs: Mapping[str, Raw]) -> dict[str, Shape]:
    """Return the shapes of the arrays among the inputs."""
    shapes: dict[str, Shape] = {}
    for name, raw in inputs.items():
        is_single = isinstance(raw, str) or (isinstance(raw, TypedQuantity) and isinstance(raw.si, float))
        if not is_single and (axes := shape(raw)):
            shapes[name] = axes
    return shapes


def spanned(shapes: Iterable[Shape]) -> int:
    """Return the number of points that shapes span together; an upper bound if they are incompatible."""
    # NumPy's own broadcast_shapes fails for counts beyond 2^63.
    axes = zip_longest(*map(reversed, shapes), fillvalue=1)
    return math.prod(map(max, axes))


def shape(raw: Raw) -> Shape:
    """Return the shape of a quantity, judged by its first items; uneven lists are refused later."""
    if isinstance(raw, TypedQuantity):
        return np.shape(raw.si)
    lengths: list[int] = []
    while isinstance(items := raw.get("value") if isinstance(raw, Mapping) else raw, list) and items:
        lengths.append(len(items))
        raw = items[0]
    return tuple(lengths)

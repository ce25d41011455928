"""Validate a request for a study against its design: paths of values, units, rows, objectives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np

from app.designs.engine.design_engine import DesignEngine
from app.designs.slopes import Local
from app.plain import Raw
from app.reference import Reference
from app.studies.bodies import MOST_ROWS, StudyIn, Vary
from app.studies.methods.points import Grid, LatinHypercube, Points, Sobol
from app.studies.methods.search import scanned
from app.studies.methods.sensitivity import MorrisPoints, SobolPoints
from app.studies.methods.space import Interval, Space, Values, Variable
from templates.core.errors import Fault, FaultyText, InvalidInputs
from templates.core.units.quantity import read

_STEP = 1e-3  # step of slopes to either side, as a share of the interval


@dataclass(frozen=True)
class StudyQuestion:
    """A valid request for a study: its rows, its varied places and its outputs."""

    body: StudyIn
    space: Space
    places: tuple[Reference, ...]
    wanted: tuple[Reference, ...]
    points: Points | None  # None if the user gives the rows, or an optimisation finds them

    @property
    def objectives(self) -> list[str]:
        """Return the outputs to minimise, then those to maximise."""
        return directions(self.body)[0]


def asked_of(body: StudyIn, varied: Sequence[str], engine: DesignEngine) -> StudyQuestion:
    """Return a request, checked against the network of its design.

    Raises
    ------
    InvalidInputs
        If there are faults; the error lists all of them.
    """
    _refuse(list(_contradictions(body, varied)))
    space = Space(tuple(_variables(body, varied, engine)))
    names = dict.fromkeys([*body.minimise, *body.maximise, *body.outputs])
    wanted = tuple(map(Reference.parse, names))
    _refuse(_too_many(body, space))
    points = points_of(body, space, engine)
    return StudyQuestion(body, space, tuple(map(Reference.parse, varied)), wanted, points)


def _contradictions(body: StudyIn, varied: Sequence[str]) -> Iterator[Fault]:
    """Yield a fault for each member that the method needs but lacks, or does not use."""
    if not varied and body.method == "table":
        yield Fault("rows", "missing", "give `rows`: columns by name, or a list of rows")
    elif not varied:
        yield Fault(
            "vary", "missing", 'name the varied parameters, for example `{"clearance": {"between": [..]}}`'
        )
    if body.vary and body.method == "table":
        yield Fault("vary", "contradiction", "the columns of the table define what varies; omit `vary`")
    if body.method == "sample" and body.points is None:
        yield Fault("points", "missing", "give the number of rows to sample, such as 1024")
    has_goal = bool(body.minimise or body.maximise)
    if body.method == "optimise" and not has_goal:
        yield Fault("minimise", "missing", "name an output to minimise or maximise")
    elif not (body.outputs or has_goal):
        yield Fault(
            "outputs",
            "missing",
            "name the outputs to store for each row, such as `film.minimum_film_thickness`",
        )
    if body.points is not None and (body.method in ("grid", "table") or _is_local(body)):
        yield Fault("points", "contradiction", _WITHOUT_POINTS[body.method])
    if body.steps is not None and body.method != "grid":
        yield Fault(
            "steps", "contradiction", f"{body.method} takes no `steps`; omit it, because only `grid` takes it"
        )
    for name in sorted({*body.minimise} & {*body.maximise}):
        yield Fault("maximise", "contradiction", f"{name} cannot be both minimised and maximised")


def _is_local(body: StudyIn) -> bool:
    return body.method == "sensitivity" and body.kind == "local"


_WITHOUT_POINTS = {
    "grid": f"grid takes no `points`; give `steps`, at most {MOST_ROWS['grid']} rows in all",
    "table": f"table takes no `points`; it has the rows that you give, at most {MOST_ROWS['table']}",
    "sensitivity": "local slopes take no `points`; omit `points`, or choose `kind` `morris` or `sobol`",
}


def _variables(body: StudyIn, varied: Sequence[str], engine: DesignEngine) -> Iterator[Variable]:
    """Yield the variables in the order of the columns, which a stored body need not keep."""
    faults: list[Fault] = []
    for name in varied if body.vary else ():
        vary = body.vary[name]
        try:
            yield _variable(name, vary, engine.unit(Reference.parse(name)))
        except InvalidInputs as error:
            faults += [fault.within("vary") for fault in error.faults]
    _refuse(faults)


def _variable(name: str, vary: Vary, unit: str) -> Variable:
    if vary.between is not None:
        low, high = (single(raw, unit, name) for raw in vary.between)
        return Interval(name, low, high, vary.spacing)
    return Values(name, tuple(single(raw, unit, name) for raw in vary.values or ()))


def single(raw: Raw, unit: str, name: str) -> float:
    """Return one typed value [SI].

    Raises
    ------
    FaultyText
        If it is not a single value.
    """
    try:
        value = read(raw, unit).si
    except FaultyText as error:
        raise InvalidInputs([error.fault(name)]) from None
    if not isinstance(value, float):
        raise InvalidInputs([Fault(name, "not_a_number", "give a single value here, not an array")])
    return value


def points_of(body: StudyIn, space: Space, engine: DesignEngine) -> Points | None:
    """Return the rows of a method by number; None if the user gives the rows or the method finds them."""
    match body.method:
        case "grid":
            return Grid(space, _steps(body, space))
        case "sample" if body.sequence == "lhs":
            return LatinHypercube(space, body.points or 0, body.seed)
        case "sample":
            return Sobol(space, body.points or 0, body.seed)
        case "sensitivity" if body.kind == "morris":
            return MorrisPoints(space, body.points or 20, body.seed)
        case "sensitivity" if body.kind == "sobol":
            return SobolPoints(space, body.points or 1024, body.seed)
        case "sensitivity":
            return _around(space, engine)
    return None


def _steps(body: StudyIn, space: Space) -> dict[str, int]:
    intervals = [variable.name for variable in space.variables if isinstance(variable, Interval)]
    given = body.steps if isinstance(body.steps, Mapping) else dict.fromkeys(intervals, body.steps)
    strange = (name for name in given if name not in intervals)
    faults = [
        Fault("steps", "unknown_name", f"{name} has no bounds; give it bounds in `vary`") for name in strange
    ]
    for name in intervals:
        if (given.get(name) or 0) < 2:
            faults.append(Fault("steps", "missing", f"give at least 2 steps for {name}"))
    _refuse(faults)
    return {name: int(given[name] or 0) for name in intervals}


def _around(space: Space, engine: DesignEngine) -> Local:
    """Return the design's own values; the middle of an interval if the design's value is outside it."""
    at, steps, faults = [], [], []
    for variable in space.variables:
        if not isinstance(variable, Interval):
            detail = "a slope needs `between`, two bounds"
            faults.append(Fault(f"vary.{variable.name}", "no_interval", detail))
            continue
        nominal = float(np.asarray(engine.nominal(Reference.parse(variable.name))))
        inside = variable.low <= nominal <= variable.high
        at.append(nominal if inside else (variable.low + variable.high) / 2)
        steps.append(_STEP * (variable.high - variable.low))
    _refuse(faults)
    return Local(np.array(at), np.array(steps))


def _too_many(body: StudyIn, space: Space) -> list[Fault]:
    """Return a fault if the method would create too many rows; they are counted before any is created."""
    count = 0
    match body.method:
        case "grid":
            steps = _steps(body, space)
            count = prod(steps.get(v.name) or len(v.steps(0)) for v in space.variables)
        case "sample":
            count = body.points or 0
        case "sensitivity" if body.kind == "morris":
            count = (body.points or 20) * (len(space) + 1)
        case "sensitivity" if body.kind == "sobol":
            count = (body.points or 1024) * (len(space) + 2)
        case "optimise":
            count, least = body.points or 0, scanned(space)
            if body.points is not None and body.points < least:
                detail = f"optimise calculates {least} rows before it searches; give more, up to"
                return [Fault("points", "out_of_range", f"{detail} {MOST_ROWS['optimise']}")]
    return [too_long(body.method, count)] if count > MOST_ROWS[body.method] else []


def too_long(method: str, count: int) -> Fault:
    """Return the fault of a study with more rows than its method allows."""
    place = {"grid": "steps", "table": "rows"}.get(method, "points")
    given = str(count) if count < 10**15 else "as many as these"  # it may have thousands of digits
    return Fault(place, "too_many_rows", f"{method} takes at most {MOST_ROWS[method]} rows, not {given}")


def _refuse(faults: Sequence[Fault]) -> None:
    if faults:
        raise InvalidInputs(faults)


def directions(body: StudyIn) -> tuple[list[str], list[bool]]:
    """Return the objectives of a study, and whether each is maximised."""
    names = [*body.minimise, *body.maximise]
    return names, [name in body.maximise for name in names]

"""Choose the pictures of a calculation from one table, by the names of its outputs and its curves.

`static/pictures.js` draws them in the page and `plots.py` in a report, from the same response.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

from app.calculations.schemas.evaluations import Output, Results, UsedInput
from app.catalogue.schemas.declarations import DeclaredValue, properties
from app.catalogue.schemas.templates import Schema
from app.designs.schemas.designs import RevisionStep

FEWEST = 3  # fewest points of a curve
AXES = ("crank_angle",)  # axis of curves that declare none
MEASURED_AXIS = "measured_angle"  # axis of measured values, whose angles are their own
MOST_LINES = 6  # largest number of lines in a picture
MOST_PINS = 100  # largest number of pins in a star, whose angles are compared one by one


@dataclass(frozen=True)
class Picture:
    """A picture to draw: its `kind`, its values by their API names, and its title."""

    kind: str
    title: str
    names: Mapping[str, object]

    def for_script(self, scope: str) -> dict[str, object]:
        """Return the picture in the form that the script on the page draws."""
        return {"kind": self.kind, "scope": scope, **self.names}


Values = Mapping[str, UsedInput | Output]
Members = Mapping[str, DeclaredValue]
Rule = Callable[[Values, Members], Iterable[Picture]]


class Declarations(Protocol):
    """The interface of an object that declares inputs and outputs."""

    @property
    def inputs(self) -> Schema:
        """Return the JSON Schema of the inputs."""

    @property
    def outputs(self) -> Schema:
        """Return the JSON Schema of the outputs."""


def pictures(template: Declarations, answer: Results | RevisionStep) -> list[Picture]:
    """Return the pictures of one evaluation, in the order of the table below."""
    if not answer.outputs:
        return []
    used = {name: value for name, value in answer.inputs.items() if isinstance(value, UsedInput)}
    values: Values = {**used, **answer.outputs}
    declared = {**properties(template.inputs), **properties(template.outputs)}
    return [picture for rule in TABLE for picture in rule(values, declared)]


def axis_of(template: Declarations, answer: Results | RevisionStep, name: str) -> str | None:
    """Return the name of the axis of a curve in an evaluation; None for a single value."""
    output = answer.outputs.get(name)
    if output is None or not isinstance(output.value, list):
        return None
    used = {name: value for name, value in answer.inputs.items() if isinstance(value, UsedInput)}
    declared = {**properties(template.inputs), **properties(template.outputs)}
    axis = _axis({**used, **answer.outputs}, declared, name)
    return None if axis == name else axis


def _have(values: Values, *names: str) -> bool:
    return all(name in values and values[name].value is not None for name in names)


def _single(values: Values, *names: str) -> bool:
    return _have(values, *names) and not any(isinstance(values[name].value, list) for name in names)


def _clearance(values: Values, declared: Members) -> Iterator[Picture]:
    if _single(values, "relative_eccentricity", "minimum_film_thickness"):
        names = {
            "eccentricity": "relative_eccentricity",
            "film": "minimum_film_thickness",
            "attitude": "attitude_angle" if _single(values, "attitude_angle") else None,
        }
        yield Picture("clearance", "Journal in its clearance circle", names)


FILM = ("relative_eccentricity", "bearing_diameter", "bearing_width", "diametral_clearance",
        "dynamic_viscosity")  # fmt: skip


def _pressure(values: Values, declared: Members) -> Iterator[Picture]:
    speed = "hydrodynamic_speed" if "hydrodynamic_speed" in values else "speed"
    if _single(values, *FILM, speed):
        yield Picture(
            "pressure",
            "Film pressure: unrolled, at mid-width, as a surface",
            {"inputs": {**{n: n for n in FILM}, "speed": speed}},
        )


def _polar(values: Values, declared: Members) -> Iterator[Picture]:
    for name in values:
        across = f"{name[:-1]}y"
        if name.endswith("load_x") and _is_curve(values, name) and _is_curve(values, across):
            words = name.removesuffix("_x").replace("_", " ")
            yield Picture("polar", f"Polar diagram of the {words}", {"x": name, "y": across})


def _orbit(values: Values, declared: Members) -> Iterator[Picture]:
    if _is_curve(values, "eccentricity_x") and _is_curve(values, "eccentricity_y"):
        yield Picture(
            "orbit",
            "Orbit of the journal in its clearance circle",
            {"x": "eccentricity_x", "y": "eccentricity_y", "clearance": "diametral_clearance"},
        )


def _star(values: Values, declared: Members) -> Iterator[Picture]:
    """Yield the picture of an engine's crankpins, even for one cylinder."""
    angles = values["crankpin_angles"].value if "crankpin_angles" in values else None
    if not isinstance(angles, list) or not 1 <= len(angles) <= MOST_PINS:
        return
    if all(isinstance(angle, (int, float)) for angle in angles):
        names = {"angles": "crankpin_angles"}
        yield Picture("star", "Throw star: crankpins with their cylinders, seen from the flywheel", names)


def _campbell(values: Values, declared: Members) -> Iterator[Picture]:
    if _have(values, "natural_frequencies", "engine_orders"):
        spans = "speeds" if "speed_range" not in values and _is_curve(values, "speeds") else "speed_range"
        names = {"frequencies": "natural_frequencies", "orders": "engine_orders", "range": spans}
        yield Picture("campbell", "Campbell diagram", names)


def _modes(values: Values, declared: Members) -> Iterator[Picture]:
    if _have(values, "mode_shapes", "natural_frequencies"):
        names = {"shapes": "mode_shapes", "frequencies": "natural_frequencies"}
        yield Picture("modes", "Mode shapes", names)


def _curves(values: Values, declared: Members) -> Iterator[Picture]:
    """Yield a picture for the curves of each unit and axis."""
    groups: dict[tuple[str, str], list[str]] = {}
    for name, about in declared.items():
        axis = _axis(values, declared, name)
        if axis and name != axis and name not in ("mode_shapes", "natural_frequencies"):
            groups.setdefault((axis, about.unit or ""), []).append(name)
    for (axis, _), names in groups.items():
        for first in range(0, len(names), MOST_LINES):
            lines = names[first : first + MOST_LINES]
            words = ", ".join(declared[name].title for name in lines)
            yield Picture("curves", f"{words} over {declared[axis].title}", {"x": axis, "y": lines})


def _rows(values: Values, declared: Members) -> Iterator[Picture]:
    """Yield a picture for each array of rows over an input list, such as vibratory torques over speeds."""
    for name, about in declared.items():
        axis = about.along
        if axis is None or name not in values or about.unit is None:
            continue
        if not isinstance(values.get(axis), UsedInput) or not _is_curve(values, axis):
            continue
        if rows := _most(values[name].value, _length(values[axis])):
            names = {"x": axis, "y": name, "rows": rows}
            yield Picture("rows", f"{about.title} over {declared[axis].title}, by number", names)


def _most(table: object, length: int) -> list[int]:
    """Return the rows with the largest numbers, counted from 1, in their original order.

    Return None for a value that is not a table.
    """
    if not isinstance(table, list) or not table:
        return []
    sizes = []
    for row in table:
        if not isinstance(row, list) or len(row) != length or isinstance(row[0], (list, str)):
            return []
        sizes.append(max((abs(number) for number in row if number is not None), default=0.0))
    largest = sorted(range(len(sizes)), key=lambda place: -sizes[place])[:MOST_LINES]
    return [place + 1 for place in sorted(largest)]


def _axis(values: Values, declared: Members, name: str) -> str | None:
    """Return the name of the quantity over which a curve is drawn.

    It is the curve's own axis, or else the crank angle or an array of inputs.
    """
    if not _is_curve(values, name) or declared[name].unit is None:
        return None
    length = _length(values[name])
    along = declared[name].along
    arrays = [other for other in values if other in declared and _is_curve(values, other)]
    if name.startswith("measured_") and MEASURED_AXIS in arrays:
        return MEASURED_AXIS if _length(values[MEASURED_AXIS]) == length else None
    is_output = isinstance(values[name], Output)
    given = [other for other in arrays if is_output and _is_given(values[other])]
    others = (
        given if along is None else []
    )  # a list with one value per cylinder is not a curve over another list
    for axis in filter(None, (along, *AXES, *others)):
        if axis in arrays and _length(values[axis]) == length:
            return axis
    return None


def _is_curve(values: Values, name: str) -> bool:
    value = values[name].value if name in values else None
    return isinstance(value, list) and len(value) >= FEWEST and not isinstance(value[0], (list, str))


def _length(value: UsedInput | Output) -> int:
    """Return the number of points of a value along its first axis."""
    return len(value.value) if isinstance(value.value, list) else 1


def _is_given(value: UsedInput | Output) -> bool:
    return isinstance(value, UsedInput) and value.source == "given"


TABLE: tuple[Rule, ...] = (_clearance, _pressure, _star, _polar, _orbit, _campbell, _modes, _curves, _rows)

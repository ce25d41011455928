"""Plots of a step in a report: polar load diagram, curves, orbit, Campbell diagram, responses, accuracy."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import cos, pi, sin
from types import SimpleNamespace
from typing import NotRequired, TypedDict

from app.calculations.schemas.evaluations import Output, UsedInput
from app.designs.schemas.designs import PreviewedStep
from app.presentation import numbers
from app.reports.charts import Chart, Series, svg
from app.reports.content import Plot
from app.reports.crank_star import crank_star
from app.reports.pictures import Declarations, Picture, pictures
from templates.core.language.levels import accuracy
from templates.core.language.template import Template
from templates.core.paper.schema import inputs_schema, outputs_schema

MOST = 10  # largest number of plots of a step
SHOWN = 4  # outputs in the chart of accuracy

Valued = UsedInput | Output
Values = Mapping[str, Valued]


def plots_of(step: PreviewedStep, cls: type[Template] | None) -> list[Plot]:
    """Return the plots of a step that has results; empty if the file of its version was removed."""
    if cls is None or not step.outputs:
        return []
    declared = SimpleNamespace(inputs=inputs_schema(cls), outputs=outputs_schema(cls))
    return [*drawn(declared, step), *(plot for plot in _accuracy(cls) if plot.svg)]


def drawn(declared: Declarations, step: PreviewedStep) -> list[Plot]:
    """Return the charts of a step's values."""
    used = {name: value for name, value in step.inputs.items() if isinstance(value, UsedInput)}
    values: Values = {**used, **step.outputs}
    plots = [_plot(picture, values) for picture in pictures(declared, step) if picture.kind in DRAWN]
    return [plot for plot in plots[:MOST] if plot.svg]


def _plot(picture: Picture, values: Values) -> Plot:
    if picture.kind == STAR:
        return Plot(picture.title, crank_star(_numbers(values[_name(picture, "angles")])))
    return Plot(picture.title, svg(KINDS[picture.kind](picture, values)))


def _name(picture: Picture, part: str) -> str:
    return str(picture.names[part])


def _label(name: str, value: Valued) -> str:
    unit = numbers.unit(value.unit)
    words = name.replace("_", " ")
    return f"{words} [{unit}]" if unit else words


def _curves(picture: Picture, values: Values) -> Chart:
    x, names = _name(picture, "x"), picture.names["y"]
    assert isinstance(names, list)
    series = [Series(name.replace("_", " "), _list(values[x]), _list(values[name])) for name in names]
    unit = numbers.unit(values[names[0]].unit)
    only = _label(names[0], values[names[0]]) if len(names) == 1 else f"[{unit}]" if unit else ""
    return Chart(_label(x, values[x]), only, series)


def _rows(picture: Picture, values: Values) -> Chart:
    """Return the chosen rows of an array over a list, labelled by number."""
    x, y, rows = _name(picture, "x"), _name(picture, "y"), picture.names["rows"]
    assert isinstance(rows, list)
    table = values[y].value
    assert isinstance(table, list)
    series = [Series(f"no. {row}", _list(values[x]), table[row - 1]) for row in rows]
    return Chart(_label(x, values[x]), _label(y, values[y]), series)


def _polar(picture: Picture, values: Values) -> Chart:
    x, y = _name(picture, "x"), _name(picture, "y")
    return Chart(_label(x, values[x]), _label(y, values[y]), [_closed(values[x], values[y])], square=True)


def _orbit(picture: Picture, values: Values) -> Chart:
    chart = _polar(picture, values)
    if values[_name(picture, "x")].unit != "1":
        return chart
    angles = [n * pi / 60 for n in range(121)]
    circle = Series("clearance", [cos(a) for a in angles], [sin(a) for a in angles], dashed=True)
    return Chart(chart.x, chart.y, [*chart.series, circle], square=True)


def _campbell(picture: Picture, values: Values) -> Chart:
    """Return natural frequencies as horizontal lines and engine orders as rays over the speed."""
    frequencies = [f for f in _numbers(values[_name(picture, "frequencies")]) if f > 1e-9]
    orders = _numbers(values[_name(picture, "orders")])
    spans = values.get(_name(picture, "range"))
    fastest = _numbers(spans)[-1] if spans is not None and isinstance(spans.value, list) else None
    speed = fastest or 60 * max(frequencies, default=1.0) / min(orders)
    top = 1.15 * max(frequencies[0], min(max(frequencies), max(orders) * speed / 60)) if frequencies else 1.0
    modes = [Series(f"mode {n}", [0, speed], [f, f]) for n, f in enumerate(frequencies, 1) if f <= top]
    rays = [_ray(order, speed, top) for order in orders]
    return Chart("speed [rpm]", "frequency [Hz]", [*modes, *rays], highest=top)


def _ray(order: float, speed: float, top: float) -> Series:
    """Return the line of an engine order, cut off at the top of the diagram."""
    end = min(speed, 60 * top / order)
    return Series(f"order {numbers.plain(order)}", [0, end], [0, order * end / 60], dashed=True)


def _closed(x: Valued, y: Valued) -> Series:
    across, upright = _list(x), _list(y)
    return Series("", [*across, *across[:1]], [*upright, *upright[:1]])


def _list(value: Valued) -> list[float | None]:
    assert isinstance(value.value, list)
    return value.value


def _numbers(value: Valued) -> list[float]:
    return [number for number in _list(value) if number is not None]


KINDS: Mapping[str, Callable[[Picture, Values], Chart]] = {
    "curves": _curves,
    "polar": _polar,
    "orbit": _orbit,
    "campbell": _campbell,
    "rows": _rows,
}


STAR = "star"
DRAWN = frozenset({*KINDS, STAR})


class _Cost(TypedDict, total=False):
    single: float | None  # time for one point [s]


class _Level(TypedDict):
    """The measured errors of one level: a number or a table of numbers for each output."""

    cost: NotRequired[_Cost | None]
    errors: dict[str, object]


def _accuracy(cls: type[Template]) -> Iterator[Plot]:
    """Yield the measured median error of every level over its cost, for the first outputs."""
    measured = accuracy(cls)
    if measured is None:
        return
    every: dict[str, _Level] = measured.content["levels"]
    levels = {name: level for name, level in every.items() if _milliseconds(level)}
    outputs = list(dict.fromkeys(output for level in levels.values() for output in level["errors"]))[:SHOWN]
    series = [
        Series(output.replace("_", " "), [x for x, _ in points], [y for _, y in points], marked=True)
        for output in outputs
        if len(points := sorted(_points(levels, output))) > 1
    ]
    if series:
        title = "Accuracy: median error of each level, measured, over its cost"
        yield Plot(title, svg(Chart("time of one point [ms]", "relative error", series, logarithmic=True)))


def _points(levels: Mapping[str, _Level], output: str) -> Iterator[tuple[float, float]]:
    for level in levels.values():
        errors = sorted(error for error in _flat(level["errors"].get(output)) if error > 0)
        if errors:
            yield _milliseconds(level), errors[len(errors) // 2]


def _milliseconds(level: _Level) -> float:
    return 1000 * ((level.get("cost") or {}).get("single") or 0.0)


def _flat(cells: object) -> Iterator[float]:
    if isinstance(cells, list):
        for cell in cells:
            yield from _flat(cell)
    elif isinstance(cells, int | float):
        yield float(cells)

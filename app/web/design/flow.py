"""The diagram of dependencies: a box for each block, in columns, and a line for each name in a relation.

A wire runs from the row of a value, at the right edge of its box, to the row of the relation that uses it, at
the left edge of another box. Each wire has a free lane in the columns that it crosses, so no wire runs behind
a box. Backward wires (of an iteration, or from a later block) run dashed below all boxes. Lengths are in
pixels.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from app.designs.schemas.network import DesignNetwork, NetworkBlock, NetworkRelation
from app.reference import Reference

LETTER = 6.7  # width, of 11 px in a fixed pitch
HEAD, ROW, LANE = 24.0, 17.0, 8.0  # heights
GAP, SPACE, MARGIN, BACK = 72.0, 16.0, 14.0, 12.0
NARROWEST = 110.0
MOST_LETTERS = 40  # letters of a row; its title has the full text
LINKS = {"parameter": "#-{}", "step": "#step-{}", "model": "#part-{}"}


@dataclass(frozen=True)
class Row:
    """A row in a box: a value that a relation sets, or one that a relation uses."""

    text: str
    title: str
    y: float  # of its middle


@dataclass(frozen=True)
class Box:
    """A box for a parameter, step or model."""

    name: str
    kind: str
    column: int
    x: float
    y: float
    width: float
    height: float
    inputs: Mapping[str, Row]  # by the name of the value that is set
    outputs: Mapping[str, Row]  # by the name of the value that is used

    @property
    def link(self) -> str:
        """Return the link to the block on the page of the design."""
        return LINKS[self.kind].format(self.name)

    @property
    def right(self) -> float:
        """Return the x coordinate at which wires leave the box."""
        return self.x + self.width


@dataclass(frozen=True)
class Wire:
    """A line for one name that a relation uses."""

    relation: NetworkRelation
    points: list[tuple[float, float]]  # start, crossings of columns, and end
    path: str


@dataclass(frozen=True)
class Drawing:
    """The diagram of dependencies: its boxes and wires."""

    width: float
    height: float
    boxes: list[Box]
    wires: list[Wire]


@dataclass(frozen=True)
class _Item:
    """An item in a column: a block with its rows, or a lane (without a block) for a value."""

    name: str
    column: int
    height: float
    block: NetworkBlock | None = None
    inputs: tuple[NetworkRelation, ...] = ()
    outputs: tuple[str, ...] = ()


def drawing(network: DesignNetwork) -> Drawing | None:
    """Return the diagram of a design; None if no relation connects two blocks."""
    if not network.relations:
        return None
    items = [*_blocks(network), *_lanes(network)]
    columns = [[item for item in items if item.column == at] for at in range(_count(items))]
    tall = max(sum(item.height + SPACE for item in column) for column in columns)
    left, boxes, lanes = MARGIN + GAP / 2, [], {}
    places: dict[str, float] = {}  # latest middle of the item with each name
    for column in columns:
        width = max(_width(item) for item in column)
        top = MARGIN + (tall - sum(item.height + SPACE for item in column)) / 2
        for item in sorted(column, key=lambda item: _wish(item, places)):
            places[item.name] = top + item.height / 2
            if item.block:
                boxes.append(_box(item, item.block, left, top, width))
            else:
                lanes[item.name, item.column] = ((left, places[item.name]), (left + width, places[item.name]))
            top += item.height + SPACE
        left += width + GAP
    wires = _wires(network.relations, boxes, lanes, MARGIN + tall)
    backward = sum(not wire.relation.forward for wire in wires)
    return Drawing(left - GAP / 2 + MARGIN, MARGIN + tall + BACK * (backward + 1), boxes, wires)


def _count(items: Sequence[_Item]) -> int:
    return max(item.column for item in items) + 1


def _blocks(network: DesignNetwork) -> list[_Item]:
    """Return steps, models and the parameters that relations use, in columns; no column is empty."""
    used = {_block(name) for one in network.relations for name in (one.source, one.target)}
    shown = [block for block in network.blocks if block.kind != "parameter" or block.name in used]
    return [_item(block, network.relations) for block in shown]


def _item(block: NetworkBlock, relations: Sequence[NetworkRelation]) -> _Item:
    inputs = {one.target: one for one in relations if _block(one.target) == block.name}
    outputs = dict.fromkeys(one.source for one in relations if _block(one.source) == block.name)
    rows = len(inputs) + (len(outputs) if block.kind != "parameter" else 0)
    height = HEAD + ROW * rows + (LANE / 2 if rows else 0)
    return _Item(block.name, block.column, height, block, tuple(inputs.values()), tuple(outputs))


def _lanes(network: DesignNetwork) -> list[_Item]:
    """Return the positions of values in the columns that they cross."""
    columns = {block.name: block.column for block in network.blocks}
    passed = {
        (one.source, column): None
        for one in network.relations
        if one.forward
        for column in range(columns[_block(one.source)] + 1, columns[_block(one.target)])
    }
    return [_Item(source, column, LANE) for source, column in passed]


def _wish(item: _Item, places: Mapping[str, float]) -> float:
    """Return the preferred height of an item: the mean of the items that drive it, or the top."""
    if item.block is None:
        return places.get(item.name, places[_block(item.name)])
    sources = [places.get(one.source, places.get(_block(one.source), 0.0)) for one in item.inputs]
    return fmean(sources) if sources else 0.0


def _width(item: _Item) -> float:
    texts = [_set(one) for one in item.inputs] + [_tail(name) for name in item.outputs]
    longest = max((len(_short(text)) for text in (item.name if item.block else "", *texts)), default=0)
    return max(NARROWEST, LETTER * longest + 2 * LANE)


def _box(item: _Item, block: NetworkBlock, x: float, y: float, width: float) -> Box:
    middles = [y + HEAD + ROW * (place + 0.5) for place in range(len(item.inputs) + len(item.outputs))]
    inputs = {
        one.target: Row(_short(_set(one)), f"{one.target} {one.relation}", at)
        for one, at in zip(item.inputs, middles, strict=False)
    }
    below = middles[len(item.inputs) :] if block.kind != "parameter" else [y + HEAD / 2]
    outputs = {
        name: Row(_short(_tail(name)), name, at) for name, at in zip(item.outputs, below, strict=False)
    }
    return Box(block.name, block.kind, block.column, x, y, width, item.height, inputs, outputs)


Lanes = Mapping[tuple[str, int], tuple[tuple[float, float], tuple[float, float]]]


def _wires(
    relations: Sequence[NetworkRelation], boxes: Sequence[Box], lanes: Lanes, bottom: float
) -> list[Wire]:
    by_name = {box.name: box for box in boxes}
    wires: list[Wire] = []
    for one in relations:
        source, target = by_name[_block(one.source)], by_name[_block(one.target)]
        start = (source.right, source.outputs[one.source].y)
        end = (target.x, target.inputs[one.target].y)
        if one.forward:
            passed = range(source.column + 1, target.column)
            points = [start, *(point for column in passed for point in lanes[one.source, column]), end]
            wires.append(Wire(one, points, _forward(points)))
        else:
            bottom += BACK
            wires.append(Wire(one, [start, end], _backward(start, end, bottom)))
    return wires


def _forward(points: Sequence[tuple[float, float]]) -> str:
    """Return the bends of a line to a later column; it runs straight across the columns between."""
    (x, y), *rest = points
    path = f"M{x:.1f},{y:.1f}"
    for place, (to_x, to_y) in enumerate(rest):
        middle = (x + to_x) / 2
        bends = f"C{middle:.1f},{y:.1f} {middle:.1f},{to_y:.1f} {to_x:.1f},{to_y:.1f}"
        path += bends if place % 2 == 0 else f"H{to_x:.1f}"
        x, y = to_x, to_y
    return path


def _backward(start: tuple[float, float], end: tuple[float, float], bottom: float) -> str:
    """Return the bends of a backward line: down after its column, below all boxes, and up again."""
    (x, y), (to_x, to_y), out = start, end, GAP / 2
    return (
        f"M{x:.1f},{y:.1f}C{x + out:.1f},{y:.1f} {x + out:.1f},{bottom:.1f} {x:.1f},{bottom:.1f}"
        f"H{to_x:.1f}C{to_x - out:.1f},{bottom:.1f} {to_x - out:.1f},{to_y:.1f} {to_x:.1f},{to_y:.1f}"
    )


def _block(name: str) -> str:
    return Reference.parse(name).block


def _tail(name: str) -> str:
    return Reference.parse(name).member


def _set(one: NetworkRelation) -> str:
    """Return a relation as text: `inner_diameter = film.bearing_diameter`."""
    return f"{_tail(one.target)} {one.relation.strip()}".strip()


def _short(text: str) -> str:
    return text if len(text) <= MOST_LETTERS else f"{text[: MOST_LETTERS - 1]}…"

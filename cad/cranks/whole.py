"""Build a crankshaft of any number of throws, in millimetres, and compute its volume in closed form.

z runs along the shaft; z = 0 is the middle of the first main journal, and each following journal is one pitch
further. x is the reference line from which the pin angles are measured, towards y. The nose is at -z, the
flange at +z.

Each throw is built like `crank_throw`, then rotated and shifted. Journals and pins are revolved from one
outline, and the parts meet only in flat faces, so their volumes add up. Bores, drillings and bolt holes are
cut from the whole shaft. They do not intersect each other, except for a drilling and the bores of its own
throw; the rules of the model ensure that.

If the pins are split, a throw consists of two halves, each rotated with its own pin, and a middle web between
them. Pin bores then end at the middle web, and each pin has its own drilling; that of the front pin comes
from the main journal in front of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, pi, remainder, sin

from cadquery import Shape, Solid, Vector
from cadquery.func import fuse

from cad.cranks.keyway import Keyway
from cad.cranks.outline import Run, reach
from cad.cranks.split_pins import SplitPins
from cad.cranks.throw import Collar, End, Throw, bore, turned
from cad.cranks.volume import (
    collar_volume,
    drilling,
    end_volume,
    fillet,
    journal,
    keyway_volume,
    pin,
    web,
)  # fmt: skip
from cad.model import Box
from cad.on_demand import constant

_AXIS = constant(lambda: (Vector(0, 0, 0), Vector(0, 0, 1)))


@dataclass(frozen=True)
class Bolts:
    """Blind holes with flat bottoms in the flange, evenly spaced on a circle; the first is on the line x."""

    count: int
    radius: float  # of a hole
    circle: float  # radius
    depth: float


@dataclass(frozen=True)
class Throws:
    """One throw of the shaft: with the counterweight of its front web, and with that of its rear web."""

    front: Throw
    rear: Throw
    angle: float  # angle of the pin, or of the front pin, from the reference line [rad]


@dataclass(frozen=True)
class Half:
    """Position of one half of a throw: the angle of its pin [rad], and the z of mid-pin [mm]."""

    angle: float
    middle: float


@dataclass(frozen=True)
class WholeShaft:
    """A shaft [mm]."""

    throws: tuple[Throws, ...]
    nose: End
    flange: End
    bolts: Bolts | None
    split: SplitPins | None = None
    keyway: Keyway | None = None
    collar: Collar | None = None
    thrust_main: int = 0  # number of the main journal with collars from the nose, 1 for the first; 0 for none

    @property
    def like(self) -> Throw:
        """Return the first throw; all others equal it except for their counterweights."""
        return self.throws[0].front

    @property
    def pitch(self) -> float:
        """Return the distance between the middles of neighbouring main journals."""
        t = self.like
        if self.split:
            return 2 * (t.pin_length + t.web_thickness) + self.split.thickness + t.journal_length
        return t.pin_length + 2 * t.web_thickness + t.journal_length

    def halves(self, number: int) -> tuple[Half, Half]:
        """Return the angle and position of the front and the rear half of each throw, numbered from 0.

        Both halves have the same angle and position if the pin is undivided.
        """
        angle, middle = self.throws[number].angle, self.pitch * (number + 0.5)
        if self.split is None:
            return Half(angle, middle), Half(angle, middle)
        off = (self.like.pin_length + self.split.thickness) / 2
        return Half(angle, middle - off), Half(angle + self.split.angle, middle + off)

    @cached_property
    def mains(self) -> tuple[float, ...]:
        """Return the z coordinates of the middles of the main journals."""
        return tuple(self.pitch * k for k in range(len(self.throws) + 1))

    @property
    def low(self) -> float:
        """Return the z coordinate of the end of the nose."""
        return -self.like.journal_length / 2 - self.nose.length

    @property
    def high(self) -> float:
        """Return the z coordinate of the end of the flange."""
        return self.mains[-1] + self.like.journal_length / 2 + self.flange.length

    def solid(self) -> Shape:
        """Return all parts fused, then bored and drilled at once."""
        whole = fuse(*self._parts(), glue="partial")
        tools = [*self._tools()]
        return whole.cut(*tools) if tools else whole

    def volume(self) -> float:
        """Compute the volume [mm³] in closed form.

        The first and the last journal have one fillet, all others two.
        """
        t, count = self.like, len(self.throws)
        webs = sum(web(one) for throw in self.throws for one in (throw.front, throw.rear))
        inner = (count - 1) * (journal(t) + fillet(t.journal, t.fillet))
        pins = count * (2 if self.split else 1)
        middle = count * self.split.volume(t.outline.throw) if self.split else 0.0
        ends = sum(end_volume(end, t.journal_bore, t.journal) for end in (self.nose, self.flange))
        holes = self.bolts.count * pi * self.bolts.radius**2 * self.bolts.depth if self.bolts else 0.0
        ends -= holes + (keyway_volume(self.keyway, self.nose) if self.keyway else 0.0)
        return webs + pins * (pin(t) - drilling(t)) + inner + 2 * journal(t) + ends + middle + self._collars()

    def _collars(self) -> float:
        """Return the volume of the collars: one on each web beside the chosen main."""
        if self.collar is None:
            return 0.0
        beside = (self.thrust_main > 1) + (self.thrust_main <= len(self.throws))
        return beside * collar_volume(self.collar, self.like.journal)

    def collar_of(self, main: int) -> Collar | None:
        """Return the collar at a main journal, numbered from 1."""
        return self.collar if main == self.thrust_main else None

    def box(self) -> Box:
        """Return the bounding box of webs, counterweights, nose and flange."""
        ends = max(self.nose.radius, self.flange.radius)
        webs = [
            (one.outline, half.angle)
            for number, throw in enumerate(self.throws)
            for one, half in zip((throw.front, throw.rear), self.halves(number), strict=True)
        ]

        def far(direction: float) -> float:
            furthest = [ends, *(reach(outline, direction - angle) for outline, angle in webs)]
            if self.split:
                pins = (self.like.outline.throw * cos(direction - angle) for _, angle in webs)
                furthest.append(max(pins) + self.split.half_width)
            return max(furthest)

        low = -far(pi), -far(-pi / 2), self.low
        return Box(low, (far(0.0), far(pi / 2), self.high))

    def _parts(self) -> Iterator[Shape]:
        """Yield the nose with the first journal, then each throw with the journal behind it."""
        first = self.throws[0].front
        nose = first.journal_solid(self.nose, self.collar_of(1)).mirror("XY")
        front, _ = self.halves(0)
        yield placed(nose, front) if self.split else nose.translate(Vector(0, 0, front.middle))
        for number, throw in enumerate(self.throws):
            last = number + 1 == len(self.throws)
            collar = self.collar_of(number + 2)
            behind = throw.rear.journal_solid(self.flange, collar) if last else _journal(throw.rear, collar)
            front, rear = self.halves(number)
            yield placed(throw.front.web().mirror("XY"), front)
            yield placed(throw.front.pin_solid(), front)
            if self.split:
                yield self.split.web(front.angle, front.middle + throw.front.inner, throw.front.outline.throw)
                yield placed(throw.rear.pin_solid(), rear)
            yield placed(throw.rear.web(), rear)
            yield placed(behind, rear if last or not self.split else self._seam_behind(number))

    def _seam_behind(self, number: int) -> Half:
        """Return the rotation of a journal between split throws, with its seam away from both drillings."""
        (_, rear), (front, _) = self.halves(number), self.halves(number + 1)
        return Half(rear.angle + remainder(front.angle - rear.angle, 2 * pi) / 2, rear.middle)

    def _tools(self) -> Iterator[Shape]:
        """Yield the solids that bores, drillings and bolt holes remove.

        All except the last extend beyond the part.
        """
        t = self.like
        if t.journal_bore > 0:
            middle, half = (self.low + self.high) / 2, (self.high - self.low) / 2
            yield bore(t.journal_bore, half + t.journal, 0.0).translate(Vector(0, 0, middle))
        for number in range(len(self.throws)):
            front, rear = self.halves(number)
            if self.split:
                for tool in _tools_of_half(t):
                    yield placed(tool.mirror("XY"), front)
                    yield placed(tool, rear)
                continue
            if t.pin_bore > 0:
                through = bore(t.pin_bore, t.outer + t.journal_length / 2, t.outline.throw)
                yield placed(through, front)
            if t.drilling > 0:
                yield placed(t.drill(), front)
        if self.keyway:
            yield self.keyway.tool(self.nose.radius, self.low)
        if self.bolts:
            yield from self._holes(self.bolts)

    def _holes(self, bolts: Bolts) -> Iterator[Solid]:
        bottom, length = self.high - bolts.depth, bolts.depth + bolts.radius
        for number in range(bolts.count):
            angle = 2 * pi * number / bolts.count
            foot = Vector(bolts.circle * cos(angle), bolts.circle * sin(angle), bottom)
            yield Solid.makeCylinder(bolts.radius, length, foot, Vector(0, 0, 1))


def placed(part: Shape, half: Half) -> Shape:
    """Return a part of a throw, built about mid-pin, moved to the position of its half."""
    return part.rotate(*_AXIS, degrees(half.angle)).translate(Vector(0, 0, half.middle))


def _tools_of_half(t: Throw) -> Iterator[Shape]:
    """Yield the cuts of the rear half of a throw with split pins, whose bore ends at the middle web."""
    if t.pin_bore > 0:
        yield t.blind_bore()
    if t.drilling > 0:
        yield t.drill()


def _journal(t: Throw, collar: Collar | None) -> Shape:
    """Return the journal on +z of a throw, up to the next web.

    Its seam is away from the mouth of the drilling.
    """
    foot = t.journal_foot(collar)
    ends = t.outer + t.journal_end
    top: list[Run] = [tuple((r, ends - z) for r, z in reversed(run)) for run in reversed(foot)]
    return turned([*foot, (foot[-1][-1], top[0][0]), *top], 0.0, 1)

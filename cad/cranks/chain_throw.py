"""Build single throws of a shaft as STEP files, from mid-main to mid-main, for finite elements.

They have no oil drilling: the section at mid-main would cut the mouth of the previous throw's drilling.
"""

from __future__ import annotations

from dataclasses import replace

from cadquery import Shape
from cadquery.func import fuse

from cad.cranks.throw import Throw, bore
from cad.cranks.whole import Half, WholeShaft, placed
from cad.errors import AnalysisError
from cad.fillets import Crank
from cad.header import Header
from cad.model import CadModel, Part
from cad.shaft import PinPlace, PlacedThrow, Shaft, ThrowsApart, ThrowSolid
from cad.step import write_step


def has_throws(cls: type[CadModel]) -> bool:
    """Return whether a model is a crankshaft of throws: its `drawn` returns a `WholeShaft`."""
    declared = getattr(getattr(cls, "drawn", None), "__annotations__", {})
    return declared.get("return") in (WholeShaft, WholeShaft.__name__)


def shaft_of_throws(shape: CadModel) -> WholeShaft | None:
    """Return the throws of a shaft; None if the model has none."""
    if not has_throws(type(shape)):
        return None
    drawn = getattr(shape, "drawn")()  # noqa: B009 - the base of models does not declare it
    return drawn if isinstance(drawn, WholeShaft) else None


def sizes_of_throw(whole: WholeShaft) -> Crank | None:
    """Return the sizes of a shaft's throws, which are equal except for the counterweights.

    Return None for split pins.
    """
    if whole.split:
        return None
    like = whole.like
    return Crank(like.outline.throw, like.pin, like.pin_length, like.journal, like.web_thickness, like.fillet)


def first_throw_apart(whole: WholeShaft) -> ThrowsApart:
    """Return the first throw of a shaft as a separate solid."""
    return throws_apart(replace(whole, throws=whole.throws[:1]))


def throws_apart(whole: WholeShaft) -> ThrowsApart:
    """Return all throws of a shaft as separate solids; equal throws are built only once.

    Raises
    ------
    AnalysisError
        `no_throws`, if a fillet of the only throw reaches beyond the middle of a main journal.
    """
    if 2 * whole.like.fillet > 0.9 * whole.like.journal_length:
        detail = "a fillet reaches to the middle of a main journal, where throws are cut apart"
        raise AnalysisError("no_throws", detail)
    numbers: dict[tuple[Throw, Throw], int] = {}
    solids: list[ThrowSolid] = []
    places: list[PlacedThrow] = []
    for number, throw in enumerate(whole.throws):
        webs = throw.front, throw.rear
        if webs not in numbers:
            numbers[webs] = len(solids)
            solids.append(ThrowSolid(*throw_step(whole, number)))
        places.append(PlacedThrow(numbers[webs], throw.angle))
    return ThrowsApart(tuple(solids), tuple(places))


def throw_step(whole: WholeShaft, number: int) -> tuple[bytes, Shaft, PinPlace]:
    """Return one throw of a shaft, numbered from 0: its STEP file, its ends, and its pin position.

    z = 0 is halfway between the mains; x points to the pin, or to the front pin if the pins are split.
    """
    throw = whole.throws[number]
    half = whole.like.journal_length / 2
    front, rear = (replace(one, journal_length=half, drilling=0.0) for one in (throw.front, throw.rear))
    before, behind = _halves_about_the_middle(whole)
    parts = [
        _standing(front.journal_solid(None).mirror("XY"), before),
        _standing(front.web().mirror("XY"), before),
        _standing(front.pin_solid(), before),
        _standing(rear.web(), behind),
        _standing(rear.journal_solid(None), behind),
    ]
    if whole.split:
        parts.append(whole.split.web(0.0, before.middle + front.inner, front.outline.throw))
        parts.append(_standing(rear.pin_solid(), behind))
    solid = fuse(*parts, glue="partial")
    tools: list[Shape] = [bore(front.journal_bore, whole.pitch, 0.0)] if front.journal_bore > 0 else []
    if front.pin_bore > 0 and whole.split:
        tools += [placed(front.blind_bore().mirror("XY"), before), placed(rear.blind_bore(), behind)]
    elif front.pin_bore > 0:
        tools.append(bore(front.pin_bore, front.outer + half / 2, front.outline.throw))
    solid = solid.cut(*tools) if tools else solid
    step = write_step([Part("throw", solid, 0.0)], Header("crank_throw_of_chain", 1, {}, "0" * 64))
    length = front.pin_length - 2 * front.fillet
    pin = PinPlace(front.outline.throw, front.pin, length, before.middle)
    return step, Shaft(-whole.pitch / 2, whole.pitch / 2), pin


def _standing(part: Shape, half: Half) -> Shape:
    """Return a part moved to the position of its half of the throw."""
    return part if half == Half(0.0, 0.0) else placed(part, half)


def _halves_about_the_middle(whole: WholeShaft) -> tuple[Half, Half]:
    """Return the halves of a throw with its front pin on x and z = 0 midway between the mains."""
    front, rear = whole.halves(0)
    middle = whole.pitch / 2
    return Half(0.0, front.middle - middle), Half(rear.angle - front.angle, rear.middle - middle)

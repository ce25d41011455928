"""Single throws of a shaft as STEP files, from mid-main to mid-main, for finite elements.

They have no oil drilling: the section at mid-main would cut the mouth of the drilling of the throw before it.
"""

from __future__ import annotations

from dataclasses import replace

from cadquery.func import fuse

from cad.cranks.throw import Throw, bore
from cad.cranks.whole import WholeShaft
from cad.fillets import Crank
from cad.header import Header
from cad.model import CadModel, Part
from cad.shaft import PinPlace, PlacedThrow, Shaft, ThrowsApart, ThrowSolid
from cad.step import write_step


def has_throws(cls: type[CadModel]) -> bool:
    """Return whether a model is a shaft of throws: its `drawn` answers a `WholeShaft`."""
    declared = getattr(getattr(cls, "drawn", None), "__annotations__", {})
    return declared.get("return") in (WholeShaft, WholeShaft.__name__)


def shaft_of_throws(shape: CadModel) -> WholeShaft | None:
    """The throws of a shaft; None if the model is none."""
    if not has_throws(type(shape)):
        return None
    drawn = getattr(shape, "drawn")()  # noqa: B009 - the base of models does not declare it
    return drawn if isinstance(drawn, WholeShaft) else None


def sizes_of_throw(whole: WholeShaft) -> Crank:
    """The plain sizes of a shaft's throws, which differ in their counterweights alone."""
    like = whole.like
    return Crank(like.outline.throw, like.pin, like.pin_length, like.journal, like.web_thickness, like.fillet)


def first_throw_apart(whole: WholeShaft) -> ThrowsApart:
    """The first throw of a shaft alone."""
    return throws_apart(replace(whole, throws=whole.throws[:1]))


def throws_apart(whole: WholeShaft) -> ThrowsApart:
    """All throws of a shaft; throws alike are drawn once."""
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
    """A throw of a shaft, counted from 0: its STEP file, its ends, and where its pin is.

    z = 0 is mid-pin, x points to the pin.
    """
    throw = whole.throws[number]
    half = whole.like.journal_length / 2
    front, rear = (replace(one, journal_length=half, drilling=0.0) for one in (throw.front, throw.rear))
    parts = (
        front.journal_solid(None).mirror("XY"),
        front.web().mirror("XY"),
        front.pin_solid(),
        rear.web(),
        rear.journal_solid(None),
    )
    solid = fuse(*parts, glue="partial")
    tools = [bore(front.journal_bore, whole.pitch, 0.0)] if front.journal_bore > 0 else []
    if front.pin_bore > 0:
        tools.append(bore(front.pin_bore, front.outer + half / 2, front.outline.throw))
    solid = solid.cut(*tools) if tools else solid
    step = write_step([Part("throw", solid, 0.0)], Header("crank_throw_of_chain", 1, {}, "0" * 64))
    pin = PinPlace(front.outline.throw, front.pin, front.pin_length - 2 * front.fillet)
    return step, Shaft(-whole.pitch / 2, whole.pitch / 2), pin

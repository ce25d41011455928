"""One throw of a shaft as a STEP file, from mid-main to mid-main, for the finite elements of a chain.

It has no oil drilling: the section at mid-main would cut the mouth of the drilling of the throw before it.
"""

from __future__ import annotations

from dataclasses import replace

from cadquery.func import fuse

from cad.cranks.throw import bore
from cad.cranks.whole import WholeShaft
from cad.header import Header
from cad.model import Part
from cad.shaft import PinPlace, Shaft
from cad.step import write_step


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

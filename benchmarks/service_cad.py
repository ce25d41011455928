"""The bare CadQuery work that `benchmarks.service` compares with: the same ball bearing, built and exported.

Two baselines. `model_alone`: the model's own `build()`, which turns each ring's profile once, put into a
cq.Assembly and exported. `plain_script`: the bearing as a CadQuery user writes it, with Workplanes: tubes, a
torus cut from each, chamfered edges, in a cq.Assembly.
"""

from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path

import cadquery as cq

from cad.catalogue import models
from cad.model import CadModel


def bearing(inner_diameter: float) -> CadModel:
    """The model for a bore [mm]."""
    return models().get("ball_bearing", 1).from_quantities({"inner_diameter": f"{inner_diameter!r} mm"})


def model_alone(inner_diameter: float, file: Path) -> cq.Assembly:
    """The model's own shapes, exported by CadQuery."""
    assembly = cq.Assembly(name="ball_bearing")
    for part in bearing(inner_diameter).build():
        for name, place in zip(part.names, part.places, strict=True):
            assembly.add(part.solid, name=name, loc=place, color=cq.Color(*part.colour))
    assembly.export(str(file))
    return assembly


def plain_script(inner_diameter: float, file: Path) -> cq.Assembly:
    """The same bearing by Workplanes; only its numbers come from the model."""
    model = bearing(inner_diameter)
    section, pitch, size = model.section(), 1e3 * model.D_pw / 2, 1e3 * model.D_w
    balls, width, chamfer = round(float(model.n)), section.width, section.chamfer

    def tube(small: float, large: float) -> cq.Workplane:
        return cq.Workplane("XY").circle(large).circle(small).extrude(width).translate((0, 0, -width / 2))

    def torus(radius: float) -> cq.Workplane:
        return cq.Workplane(cq.Solid.makeTorus(radius, section.groove_radius))

    back, shoulder, centre = section.back, section.shoulder, section.groove_centre
    inner = tube(pitch - back, pitch - shoulder).cut(torus(pitch - centre))
    outer = tube(pitch + shoulder, pitch + back).cut(torus(pitch + centre))
    ends = "%CIRCLE and (>Z or <Z)"
    inner = inner.edges(ends).edges(cq.selectors.RadiusNthSelector(0)).chamfer(chamfer)
    outer = outer.edges(ends).edges(cq.selectors.RadiusNthSelector(-1)).chamfer(chamfer)
    ball = cq.Workplane("XY").sphere(size / 2)

    assembly = cq.Assembly(name="ball_bearing")
    assembly.add(inner, name="inner_ring", color=cq.Color(0.62, 0.65, 0.70))
    assembly.add(outer, name="outer_ring", color=cq.Color(0.62, 0.65, 0.70))
    for i in range(balls):
        place = cq.Location(cq.Vector(pitch * cos(2 * pi * i / balls), pitch * sin(2 * pi * i / balls), 0))
        assembly.add(ball, name=f"ball_{i + 1}", loc=place, color=cq.Color(0.86, 0.88, 0.91))
    assembly.export(str(file))
    return assembly


BASELINES: dict[str, Callable[[float, Path], cq.Assembly]] = {
    "model's build() + cq export": model_alone,
    "plain CadQuery script": plain_script,
}


def volume(assembly: cq.Assembly) -> float:
    """Volume of all its solids [mm³]."""
    return sum(solid.Volume() for solid in assembly.toCompound().Solids())

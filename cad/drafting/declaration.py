"""The part of a model's declaration that a drawing shows: kind, limits, datums, geometric tolerances."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from cad.assemblies import AssemblyModel
from cad.carriers import Carriers
from cad.catalogue import models
from cad.drafting.curves import Point
from cad.drafting.parameter_match import length_of
from cad.drafting.title import TEXTURE, roughness
from cad.header import Header
from cad.model import CadModel
from cad.step import Body
from cad.tolerances import REPEATED, Limits, ToleranceFaces, carried, limits_in

_FACES = ("cylinders", "beside", "spheres", "planes")  # that a tool machines, so they have a texture


@dataclass(frozen=True)
class Control:
    """A geometric tolerance of the faces of a dimension: its width [mm] and the datum to which it refers."""

    parameter: str
    form: str
    width: float
    to: str


@dataclass(frozen=True)
class DrawingDeclaration:
    """The declaration of a model.

    A file of nobody, or of a team's model, which other machines lack, has its limits from its header alone.

    Attributes
    ----------
    limits
        Limit deviations by parameter.
    datums
        Letters of datums by parameter; in an assembly only of those to which a tolerance refers.
    textures
        Greatest roughness Ra [µm] by parameter, where it is less than that of all other faces.
    carriers
        The faces that carry dimensions, by parameter.
    sections
        Removed sections by letter, in the words of `cad.drafting.removed_section`.
    """

    is_shaft: bool = False
    limits: Mapping[str, Limits] = field(default_factory=dict)
    controls: tuple[Control, ...] = ()
    datums: Mapping[str, str] = field(default_factory=dict)
    textures: Mapping[str, float] = field(default_factory=dict)
    sections: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    carriers: Mapping[str, ToleranceFaces] = field(default_factory=dict)

    def repeated(self, parameters: Mapping[str, str], bodies: Sequence[Body]) -> dict[str, list[Point]]:
        """Return the ends of lengths that repeat along the shaft, by parameter [mm]."""
        sizes = {name: length_of(parameters[name]) for name in self.carriers}
        carriers = Carriers({body.name: body.shape for body in bodies}, self.carriers, sizes)
        along = (
            name
            for name, one in self.carriers.items()
            if one.faces in REPEATED and all(self.carriers[other].where == "z" for other in one.others_named)
        )
        return {name: spans for name in along if (spans := carriers.spans(name))}

    @staticmethod
    def of(header: Header | None, *, is_assembly: bool = False) -> DrawingDeclaration:
        """Return the declarations of the model of a STEP file."""
        if header is None:
            return DrawingDeclaration()
        limits = limits_in(header)
        model = models().versions.get((header.model, header.version))
        if model is None:
            return DrawingDeclaration(limits=limits)
        carriers = carried(model)
        controls = tuple(_controls(model, limits))
        every = {one.datum for one in carriers.values()}
        shown = ({control.to for control in controls} if is_assembly else every) - {""}
        return DrawingDeclaration(
            _is_shaft(model),
            limits,
            controls,
            {name: one.datum for name, one in carriers.items() if one.datum in shown},
            {
                name: height
                for name, one in carriers.items()
                if name in limits
                and one.faces in _FACES
                and (height := roughness(limits[name].width)) < TEXTURE
            },
            model.sections,
            carriers,
        )


def _controls(model: type[CadModel], limits: Mapping[str, Limits]) -> Iterator[Control]:
    for name, one in carried(model).items():
        if name in limits:
            for form, share in one.forms.items():
                to = "" if form == "cylindricity" else one.to
                yield Control(name, form, limits[name].share(share), to)


def _is_shaft(model: type[CadModel]) -> bool:
    return model.is_throw() or model.shaft not in (CadModel.shaft, AssemblyModel.shaft)

"""The part of a model's declaration that a drawing shows: kind, limits, datums, geometric tolerances."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from cad.assemblies import AssemblyModel
from cad.catalogue import models
from cad.drafting.title import TEXTURE, roughness
from cad.header import Header
from cad.model import CadModel
from cad.pmi import on_faces
from cad.surfaces import PartSurfaces, Size
from cad.tolerances import Limits, carried, limits_in
from templates.core.errors import InvalidInputs


@dataclass(frozen=True)
class Control:
    """A geometric tolerance on the faces of a dimension: its width [mm] and the datum to which it refers."""

    parameter: str
    form: str
    width: float
    to: str


@dataclass(frozen=True)
class DrawingDeclaration:
    """The declaration of a model, as far as its drawing needs it.

    If the model of a file is not installed here, only the limits in the file's header are known.

    Attributes
    ----------
    limits
        Limit deviations by parameter.
    datums
        Letters of datums by parameter; in an assembly only those to which a tolerance refers.
    textures
        Greatest roughness Ra [µm] by parameter, where it is less than that of all other faces; for an
        assembly only that of faces on several parts, because each part has its own sheet.
    sections
        Removed sections by letter, in the format that `cad.drafting.removed_section` describes.
    sizes
        Dimensions of the solid with the faces that carry them, by parameter.
    is_part
        Whether the sheet shows one part of a model that has several.
    """

    is_shaft: bool = False
    limits: Mapping[str, Limits] = field(default_factory=dict)
    controls: tuple[Control, ...] = ()
    datums: Mapping[str, str] = field(default_factory=dict)
    textures: Mapping[str, float] = field(default_factory=dict)
    sections: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    sizes: Mapping[str, Size] = field(default_factory=dict)
    is_part: bool = False

    def on(self, seen: Mapping[str, PartSurfaces]) -> DrawingDeclaration:
        """Return the declarations that concern only the given parts."""
        kept = {
            name: Size(size, size.kind, *places)
            for name, size in self.sizes.items()
            if (places := [p for p in size.places if all(part in seen for part, _ in (*p.first, *p.second))])
        }
        return replace(
            self,
            limits={name: one for name, one in self.limits.items() if name in kept},
            controls=tuple(one for one in self.controls if one.parameter in kept),
            datums={name: letter for name, letter in self.datums.items() if name in kept},
            textures={name: height for name, height in self.textures.items() if name in kept},
            sections={letter: one for letter, one in self.sections.items() if one["of"] in seen},
            sizes=kept,
            is_part=True,
        )

    def own(self, parameters: Mapping[str, str]) -> Mapping[str, str]:
        """Return the parameters to list on the sheet; for a part, only those that its faces carry."""
        if not self.is_part:
            return parameters
        return {name: text for name, text in parameters.items() if name in self.sizes}

    @staticmethod
    def of(
        header: Header | None, seen: Mapping[str, PartSurfaces], *, is_assembly: bool = False
    ) -> DrawingDeclaration:
        """Return the declarations of the model of a STEP file.

        Parameters
        ----------
        header
            The header of the file, which names the model; None for a file without one.
        seen
            The surfaces of the parts by their names.
        is_assembly
            Whether the sheet shows an assembly.
        """
        if header is None:
            return DrawingDeclaration()
        limits = limits_in(header)
        model = models().versions.get((header.model, header.version))
        if model is None:
            return DrawingDeclaration(limits=limits)
        carriers = carried(model)
        sizes = _sizes(model, header, seen)
        limits = {name: limits[name] for name in on_faces(sizes) if name in limits and name in carriers}
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
                for name, size in sizes.items()
                if name in limits
                and _is_machined(size, seen)
                and not (is_assembly and _is_of_one_part(size))
                and (height := roughness(limits[name].width)) < TEXTURE
            },
            model.sections,
            sizes,
        )


def _sizes(model: type[CadModel], header: Header, seen: Mapping[str, PartSurfaces]) -> dict[str, Size]:
    """Return the dimensions that the faces of the solid carry; none if the faces do not match the model."""
    try:
        read = model.from_quantities(header.parameters).dimensions(seen)
    except (InvalidInputs, LookupError):
        return {}
    return {name: size for name, size in read.items() if isinstance(size, Size)}


def _is_of_one_part(size: Size) -> bool:
    """Return whether each place of a size is on faces of a single part."""
    return all(len({part for part, _ in (*place.first, *place.second)}) == 1 for place in size.places)


def _is_machined(size: Size, seen: Mapping[str, PartSurfaces]) -> bool:
    """Return whether one tool machines the faces of a size: a diameter, a sphere, or two planes."""
    if size.kind != "distance":
        return size.kind in ("diameter", "sphere")
    planes = {plane.face for one in seen.values() for plane in one.planes}
    return all(planes.issuperset((*place.first, *place.second)) for place in size.places)


def _controls(model: type[CadModel], limits: Mapping[str, Limits]) -> Iterator[Control]:
    for name, one in carried(model).items():
        if name in limits:
            for form, share in one.forms.items():
                to = "" if form == "cylindricity" else one.to
                yield Control(name, form, limits[name].share(share), to)


def _is_shaft(model: type[CadModel]) -> bool:
    return model.is_throw() or model.shaft not in (CadModel.shaft, AssemblyModel.shaft)

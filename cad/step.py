"""STEP (AP242): write parts as reproducible bytes, and read bodies with names and colours."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from cadquery import Location, Shape
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.Standard import Standard_OutOfMemory
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool
from OCP.XSControl import XSControl_WorkSession

from cad.errors import UnreadableStep
from cad.header import Header
from cad.model import STEEL, Colour, Part, names_at
from cad.on_demand import once_loaded
from cad.pmi import Annotations, Product, annotate
from cad.properties import properties_of
from cad.step_text import finished, without_noise
from templates.core.arrays import Array


def _set_up() -> None:
    STEPCAFControl_Controller.Init_s()  # the writer's settings exist only after this call
    Message.DefaultMessenger_s().ChangePrinters().Clear()  # errors are raised, not printed


once_loaded(_set_up)


@dataclass(frozen=True)
class Body:
    """A part read from a STEP file: its shape in its own coordinates, and its positions."""

    name: str
    shape: Shape
    colour: Colour
    places: tuple[Location, ...]
    called: tuple[str, ...] = ()  # at its positions, where these have their own names

    @property
    def names(self) -> tuple[str, ...]:
        """Return the name of the body at each of its positions, as `cad.model.Part` does."""
        return names_at(self.name, len(self.places), self.called)


def write_step(
    parts: Sequence[Part],
    header: Header,
    annotations: Annotations | None = None,
    *,
    rounds_noise: bool = False,
) -> bytes:
    """Return the parts as a STEP file in millimetres, with product names and colours.

    Equal parts give equal bytes. A single part at a single position becomes one product, otherwise the parts
    become an assembly. With `annotations` the file also contains their dimensions and the properties of its
    parts, and the parameters in its header become attributes.
    """
    Interface_Static.SetCVal_s("write.step.schema", "AP242DIS")
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    writer = STEPCAFControl_Writer(XSControl_WorkSession(), False)
    document = _new_document()
    products = _fill(document, header.model, parts)
    if annotations is not None:
        annotate(document, products, annotations)
    stream = io.BytesIO()
    if not writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs):
        raise RuntimeError("the kernel could not translate the parts to STEP")
    if writer.WriteStream(stream) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise RuntimeError("the kernel could not write the STEP file")
    text = stream.getvalue().decode("latin-1")
    if rounds_noise:
        text = without_noise(text)
    stated = [] if annotations is None else [properties_of(p, products[p.name].solid) for p in parts]
    names = [] if annotations is None else annotations.names
    return finished(text, header, [part.colour for part in parts], names, stated).encode("latin-1")


def read_step(step: bytes) -> tuple[Body, ...]:
    """Return the bodies in a STEP file, each once, in the order of the file.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file or contain no shape.
    MemoryError
        If the kernel has not enough memory.
    """
    try:
        return tuple(_bodies(_read_document(step)))
    except Standard_OutOfMemory:
        raise MemoryError from None


def _read_document(step: bytes) -> TDocStd_Document:
    reader = STEPCAFControl_Reader()
    document = _new_document()
    if reader.ReadStream("model.step", io.BytesIO(step)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise UnreadableStep("this is not a STEP file")
    if not reader.Transfer(document):
        raise UnreadableStep("this STEP file contains no shape")
    return document


def rigid(place: Location) -> tuple[Array, Array]:
    """Return the rotation (3, 3) and translation (3,) [mm] of a position."""
    motion = place.wrapped.Transformation()
    rows = np.array([[motion.Value(i, j) for j in (1, 2, 3, 4)] for i in (1, 2, 3)])
    return rows[:, :3], rows[:, 3]


def _new_document() -> TDocStd_Document:
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document


def _fill(document: TDocStd_Document, title: str, parts: Sequence[Part]) -> dict[str, Product]:
    """Fill a document with the parts; return the product of each part by its name."""
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    shapes.SetAutoNaming_s(False)
    if is_single(parts):
        (part,) = parts
        (place,) = part.places
        product = Product(_named(shapes.NewShape(), part.name), _placed(part.solid, place))
        shapes.SetShape(product.label, product.solid.wrapped)
        return {part.name: product}
    products: dict[str, Product] = {}
    assembly = _named(shapes.NewShape(), title)
    for part in parts:
        label = _named(shapes.NewShape(), part.name)
        product = products[part.name] = Product(label, part.solid, part.places[0])
        shapes.SetShape(product.label, product.solid.wrapped)
        for name, place in zip(part.names, part.places, strict=True):
            _named(shapes.AddComponent(assembly, product.label, place.wrapped), name)
    shapes.UpdateAssemblies()
    return products


def is_single(parts: Sequence[Part]) -> bool:
    """Return whether there is one solid at one position, so that no assembly is needed."""
    return len(parts) == 1 and len(parts[0].places) == 1


def _placed(solid: Shape, place: Location) -> Shape:
    """Return a solid moved to its position, because a single product cannot have a position of its own."""
    if place.wrapped.IsIdentity():
        return solid
    return Shape.cast(BRepBuilderAPI_Transform(solid.wrapped, place.wrapped.Transformation(), True).Shape())


def _named(label: TDF_Label, name: str) -> TDF_Label:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))  # stores the name in UTF-8
    return label


def _bodies(document: TDocStd_Document) -> Iterator[Body]:
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    roots = TDF_LabelSequence()
    shapes.GetFreeShapes(roots)
    names: dict[Shape, str] = {}
    places: dict[Shape, list[Location]] = {}
    called: dict[Shape, list[str]] = {}
    for root in roots:
        for label, place, instance in _instances(root, TopLoc_Location(), ""):
            shape = Shape.cast(XCAFDoc_ShapeTool.GetShape_s(label))
            names[shape] = _name(label)
            places.setdefault(shape, []).append(Location(place))
            called.setdefault(shape, []).append(instance)
    for shape, name in names.items():
        yield Body(
            name, shape, _colour(colours, shape), tuple(places[shape]), _own_names(name, called[shape])
        )


def _instances(
    label: TDF_Label, place: TopLoc_Location, name: str
) -> Iterator[tuple[TDF_Label, TopLoc_Location, str]]:
    """Yield the products below a label that are not assemblies, with position and name, for each use."""
    components = TDF_LabelSequence()
    if not XCAFDoc_ShapeTool.GetComponents_s(label, components):
        yield label, place, name
        return
    for component in components:
        product = TDF_Label()
        XCAFDoc_ShapeTool.GetReferredShape_s(component, product)
        at = place * XCAFDoc_ShapeTool.GetLocation_s(component)
        yield from _instances(product, at, _name(component))


_NO_NAME = re.compile(r"(?:NAUO)?[0-9 ]*|=>\[[0-9:]*\]")


def _own_names(name: str, instances: list[str]) -> tuple[str, ...]:
    """Return the names of a body's instances; none if they only consist of the body's name and a number.

    An instance without a name of its own gets the name of the body.
    """
    own = tuple(name if _NO_NAME.fullmatch(one) else one for one in instances)
    says_nothing = {one.casefold() for one in own} == {name.casefold()} or own == names_at(name, len(own))
    return () if says_nothing else own


def _name(label: TDF_Label) -> str:
    name = TDataStd_Name()
    return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""


def _colour(colours: Any, shape: Shape) -> Colour:
    colour = Quantity_Color()
    kinds = (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen)
    if not any(colours.GetColor(shape.wrapped, kind, colour) for kind in kinds):
        return STEEL
    return tuple(colour.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB))

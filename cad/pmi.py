"""Semantic PMI of AP242: dimensions with limits, datums and geometric tolerances on the faces of parts.

Known faults of Open CASCADE 7.9, each found by experiment: the writer crashes unless the schema is AP242; a
dimension must have limits and never a class of fit, because the writer numbers the grades differently from
ISO 286; the writer expects a lower deviation with the opposite sign, and writes deviations without their type
(`cad.step_text` adds it); datums are read back only if a tolerance refers to them. Each dimension and each
geometric tolerance is also drawn as lines beside the solid (`cad.pmi_presentation`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from cadquery import Compound, Location, Shape
from OCP.TCollection import TCollection_HAsciiString
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Compound
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DatumObject as DatumObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DimensionObject as DimensionObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DimensionType as DimensionType
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_GeomToleranceObject as ToleranceObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_GeomToleranceType as ToleranceType
from OCP.XCAFDoc import XCAFDoc_Datum, XCAFDoc_Dimension, XCAFDoc_DocumentTool, XCAFDoc_GeomTolerance

from cad.errors import GeometryError
from cad.pmi_presentation import Sheet
from cad.surfaces import Face, Kind, Place, Size
from cad.tolerances import REMEDY, Form, FormTolerances, Limits, deviations, number_of

_TYPES: Mapping[Kind, str] = {
    "diameter": "XCAFDimTolObjects_DimensionType_Size_Diameter",
    "sphere": "XCAFDimTolObjects_DimensionType_Size_SphericalDiameter",
    "radius": "XCAFDimTolObjects_DimensionType_Size_Radius",
    "distance": "XCAFDimTolObjects_DimensionType_Location_LinearDistance",
    "chamfer": "XCAFDimTolObjects_DimensionType_Size_Thickness",
    "circle": "XCAFDimTolObjects_DimensionType_Location_LinearDistance",
    "edge": "XCAFDimTolObjects_DimensionType_Location_LinearDistance",
}
SIGNS: Mapping[Kind, str] = {"diameter": "Ø", "sphere": "SØ", "radius": "R"}
FORM_SIGNS: Mapping[Form, str] = {"cylindricity": "⌭", "perpendicularity": "⊥", "parallelism": "∥"}
_FORMS: Mapping[Form, str] = {
    "cylindricity": "XCAFDimTolObjects_GeomToleranceType_Cylindricity",
    "perpendicularity": "XCAFDimTolObjects_GeomToleranceType_Perpendicularity",
    "parallelism": "XCAFDimTolObjects_GeomToleranceType_Parallelism",
}
"""Names of the kernel's types, which are looked up when a file is written."""

_ASCII = str.maketrans(
    {"Ø": "diameter ", "±": "+/-", "⌭": "cylindricity", "⊥": "perpendicularity", "∥": "parallelism"}
)


def on_faces(dimensions: Mapping[str, object]) -> dict[str, Size]:
    """Return the dimensions whose tolerances a file states on faces, by parameter."""
    return {n: size for n, size in dimensions.items() if isinstance(size, Size) and size.kind in _TYPES}


@dataclass(frozen=True)
class Product:
    """A part in a document: its label, the solid that is written, and the first position of the part."""

    label: TDF_Label
    solid: Shape
    place: Location = field(default_factory=Location)

    @property
    def placed(self) -> Shape:
        """Return the solid at the first position of the part."""
        return self.solid.moved(self.place)


@dataclass(frozen=True)
class Annotations:
    """The annotations to write, by parameter: limits, sizes on faces, geometric tolerances."""

    declared: Mapping[str, FormTolerances] = field(default_factory=dict)
    limits: Mapping[str, Limits] = field(default_factory=dict)
    sizes: Mapping[str, Size] = field(default_factory=dict)

    @staticmethod
    def of(
        declared: Mapping[str, FormTolerances], limits: Mapping[str, Limits], dimensions: Mapping[str, object]
    ) -> Annotations:
        """Return the annotations of a solid with these dimensions.

        Raises
        ------
        GeometryError
            `tolerance`, if a dimension with limits has no faces and no table is to state them.
        """
        sizes = on_faces(dimensions)
        for name, within in limits.items():
            if name not in sizes and not within.state_in_table:
                detail = f"{name} has a tolerance, but no face shows its {within.nominal:g} mm"
                other = "draw a solid with this feature" if within.nominal else "give it a size above 0"
                raise GeometryError("tolerance", f"{detail}; {other}, or {REMEDY}", (name,))
        carried = {name: within for name, within in limits.items() if name in sizes}
        return Annotations(declared, carried, sizes)

    @property
    def dimensions(self) -> list[StatedDimension]:
        """Return every written dimension, in the order of the file."""
        return [
            stated_dimension(name, within, self.sizes[name].kind)
            for name, within in self.limits.items()
            for _ in self.sizes[name].places
        ]

    @property
    def forms(self) -> list[tuple[str, Form]]:
        """Return the parameter and the form of every geometric tolerance, in the order of the file."""
        return [(n, form) for n in self.limits for form in self.declared[n].forms]

    @property
    def names(self) -> list[str]:
        """Return the names of all dimensions, followed by those of all geometric tolerances."""
        return [*(one.name for one in self.dimensions), *(name for name, _ in self.forms)]


@dataclass(frozen=True)
class StatedDimension:
    """A dimension as a file states it: its name, and its limits."""

    name: str
    limits: Limits


def stated_dimension(parameter: str, limits: Limits, kind: Kind) -> StatedDimension:
    """Return a dimension as a file states it: a pitch circle by its radius, from the axis to a hole.

    The kernel writes no diameter of a circle through axes.
    """
    if kind != "circle":
        return StatedDimension(parameter, limits)
    half = Limits(limits.nominal / 2, limits.lower / 2, limits.upper / 2)
    return StatedDimension(f"{parameter}/2", half)


def annotate(document: TDocStd_Document, products: Mapping[str, Product], annotations: Annotations) -> None:
    """Add every toleranced dimension to a document."""
    _Writer(document, products, annotations).write()


class _Writer:
    """Adds dimensions, datums and geometric tolerances to a document."""

    def __init__(
        self, document: TDocStd_Document, products: Mapping[str, Product], annotations: Annotations
    ) -> None:
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        self._tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
        self._products, self._annotations = products, annotations
        self._faces: dict[Face, TDF_Label] = {}
        self._letters: dict[str, TDF_Label] = {}
        self._placed = {name: product.placed for name, product in products.items()}
        self._sheet = Sheet(Compound.makeCompound(self._placed.values()))

    def write(self) -> None:
        """Write all dimensions, then all geometric tolerances."""
        limits, sizes = self._annotations.limits, self._annotations.sizes
        for name, within in limits.items():
            stated = stated_dimension(name, within, sizes[name].kind).limits
            for place in sizes[name].places:
                self._dimension(sizes[name].kind, place, stated)
        for name, within in limits.items():
            one = self._annotations.declared[name]
            for form, share in one.forms.items():
                faces = [face for place in sizes[name].places for face in (*place.first, *place.second)]
                self._form(form, within.share(share), list(dict.fromkeys(faces)), one.to)

    def _dimension(self, kind: Kind, place: Place, within: Limits) -> None:
        size = DimensionObject()
        size.SetType(getattr(DimensionType, _TYPES[kind]))
        size.SetValue(within.nominal)
        size.SetUpperTolValue(within.upper)
        size.SetLowerTolValue(-within.lower)  # the writer reverses the sign
        ends = "/".join(filter(None, deviations(within)))
        text = f"{SIGNS.get(kind, '')}{number_of(within.nominal, 6)} {ends}"
        size.SetPresentation(self._drawn(text, [*place.first[:1], *place.second[:1]]), _name(text))
        label = self._tool.AddDimension()
        XCAFDoc_Dimension.Set_s(label).SetObject(size)
        second = self._edges(place) if kind == "edge" else self._labels(place.second)
        self._tool.SetDimension(self._labels(place.first), second, label)

    def _form(self, form: Form, width: float, faces: Sequence[Face], to: str) -> None:
        tolerance = ToleranceObject()
        tolerance.SetType(getattr(ToleranceType, _FORMS[form]))
        tolerance.SetValue(width)
        datum = "" if form == "cylindricity" else f" {to}"
        text = f"{FORM_SIGNS[form]} {number_of(width, 6)}{datum}"
        tolerance.SetPresentation(self._drawn(text, faces[:1]), _name(text))
        label = self._tool.AddGeomTolerance()
        XCAFDoc_GeomTolerance.Set_s(label).SetObject(tolerance)
        self._tool.SetGeomTolerance(self._labels(faces), label)
        if form != "cylindricity":
            self._tool.SetDatumToGeomTol(self._datum(to), label)

    def _datum(self, letter: str) -> TDF_Label:
        """Return the datum with a letter; write it at the first call."""
        if letter not in self._letters:
            declared = self._annotations.declared
            name = next(name for name, one in declared.items() if one.datum == letter)
            datum = DatumObject()
            datum.SetName(TCollection_HAsciiString(letter))
            datum.SetPosition(1)
            label = self._tool.AddDatum()
            XCAFDoc_Datum.Set_s(label).SetObject(datum)
            if (size := self._annotations.sizes.get(name)) is None:
                detail = f"no face shows {name}, the datum {letter} of a tolerance; give it a size above 0"
                raise GeometryError("tolerance", detail, (name,))
            self._tool.SetDatum(self._labels(size.places[0].first), label)
            self._letters[letter] = label
        return self._letters[letter]

    def _drawn(self, text: str, faces: Sequence[Face]) -> TopoDS_Compound:
        """Return the lines of a text beside all parts, and leaders to faces of parts at their positions."""
        return self._sheet.drawn(text, [self._placed[name].Faces()[number] for name, number in faces])

    def _edges(self, place: Place) -> TDF_LabelSequence:
        """Return the labels of the edges in which the faces of a place meet."""
        labels = TDF_LabelSequence()
        for part in dict.fromkeys(part for part, _ in place.first):
            product = self._products[part]
            first, second = (_edges_of(product.solid, part, faces) for faces in (place.first, place.second))
            for edge in first:
                if any(edge.isSame(other) for other in second):
                    labels.Append(self._shapes.AddSubShape(product.label, edge.wrapped))
        return labels

    def _labels(self, faces: Iterable[Face]) -> TDF_LabelSequence:
        """Return the labels of faces; create each label once."""
        labels = TDF_LabelSequence()
        for part, number in faces:
            if (part, number) not in self._faces:
                product = self._products[part]
                face = product.solid.Faces()[number].wrapped
                self._faces[part, number] = self._shapes.AddSubShape(product.label, face)
            labels.Append(self._faces[part, number])
        return labels


def _edges_of(solid: Shape, part: str, faces: Iterable[Face]) -> list[Shape]:
    """Return the edges of those faces that are of a part."""
    every = solid.Faces()
    return [edge for name, number in faces if name == part for edge in every[number].Edges()]


def _name(text: str) -> TCollection_HAsciiString:
    """Return a text as a name for its lines, limited to the characters of a STEP file."""
    return TCollection_HAsciiString(text.translate(_ASCII))

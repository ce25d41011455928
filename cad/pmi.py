"""Semantic PMI of AP242: dimensions with their limits, datums, geometric tolerances, on the faces of parts.

Known faults of Open CASCADE 7.9, each found by experiment: the writer crashes unless the schema is AP242; a
dimension must have limits and never a class of fit, because the writer numbers the grades differently from
ISO 286; the writer expects a lower deviation with the opposite sign, and writes deviations without their type
(`cad.step_text` adds it); datums are read back only if a tolerance refers to them. Nothing is drawn: these
annotations are for programs, drawings are for people.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from cadquery import Shape
from OCP.TCollection import TCollection_HAsciiString
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DatumObject as DatumObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DimensionObject as DimensionObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DimensionType as DimensionType
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_GeomToleranceObject as ToleranceObject
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_GeomToleranceType as ToleranceType
from OCP.XCAFDoc import XCAFDoc_Datum, XCAFDoc_Dimension, XCAFDoc_DocumentTool, XCAFDoc_GeomTolerance

from cad.carriers import Carriers, Place
from cad.tolerances import Faces, Form, Limits, ToleranceFaces

_DIAMETER = "XCAFDimTolObjects_DimensionType_Size_Diameter"
_DISTANCE = "XCAFDimTolObjects_DimensionType_Location_LinearDistance"
_TYPES: Mapping[Faces, str] = {
    "cylinders": _DIAMETER,
    "beside": _DIAMETER,
    "along": _DIAMETER,
    "askew": _DIAMETER,
    "spheres": "XCAFDimTolObjects_DimensionType_Size_SphericalDiameter",
    "planes": _DISTANCE,
    "sides": _DISTANCE,
    "walls": _DISTANCE,
    "shoulders": _DISTANCE,
    "discs": _DISTANCE,
    "between": _DISTANCE,
}
_FORMS: Mapping[Form, str] = {
    "cylindricity": "XCAFDimTolObjects_GeomToleranceType_Cylindricity",
    "perpendicularity": "XCAFDimTolObjects_GeomToleranceType_Perpendicularity",
    "parallelism": "XCAFDimTolObjects_GeomToleranceType_Parallelism",
}
"""Names of the kernel's types, which is asked for them when it writes."""


@dataclass(frozen=True)
class Product:
    """A part in a document: its label there, and the solid that is written."""

    label: TDF_Label
    solid: Shape


@dataclass(frozen=True)
class Annotations:
    """What is written beside the shape: the toleranced dimensions by parameter, and what declares them.

    `sizes` [mm] are those of all declared parameters, toleranced or not.
    """

    declared: Mapping[str, ToleranceFaces] = field(default_factory=dict)
    limits: Mapping[str, Limits] = field(default_factory=dict)
    sizes: Mapping[str, float] = field(default_factory=dict)

    @property
    def dimensions(self) -> list[str]:
        """Return the parameter of every dimension that is written, in the order of the file."""
        return [n for n in self.limits for _ in self.declared[n].levels]

    @property
    def forms(self) -> list[tuple[str, Form]]:
        """Return the parameter and the form of every geometric tolerance, in the order of the file."""
        return [(n, form) for n in self.limits for form in self.declared[n].forms]

    @property
    def names(self) -> list[str]:
        """Return the parameters by which dimensions, and then geometric tolerances, are named."""
        return [*self.dimensions, *(name for name, _ in self.forms)]


def annotate(
    document: TDocStd_Document,
    products: Mapping[str, Product],
    drawn: Mapping[str, Shape],
    annotations: Annotations,
) -> None:
    """Add every toleranced dimension to a document; `drawn` are the solids in their models' coordinates.

    Raises
    ------
    GeometryError
        `tolerance`, where no face shows a dimension, or two dimensions claim the same one.
    """
    carriers = Carriers(drawn, annotations.declared, annotations.sizes)
    _Writer(document, products, carriers, annotations.declared).write(annotations.limits)


class _Writer:
    """Adds dimensions, datums and geometric tolerances to a document."""

    def __init__(
        self,
        document: TDocStd_Document,
        products: Mapping[str, Product],
        carriers: Carriers,
        declared: Mapping[str, ToleranceFaces],
    ) -> None:
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        self._tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
        self._products, self._carriers, self._declared = products, carriers, declared
        self._faces: dict[tuple[str, int], TDF_Label] = {}
        self._letters: dict[str, TDF_Label] = {}

    def write(self, limits: Mapping[str, Limits]) -> None:
        """Write all dimensions, then all geometric tolerances."""
        places = {name: self._carriers.places(name) for name in limits}
        for name, within in limits.items():
            for place in places[name]:
                self._dimension(self._declared[name], place, within)
        for name, within in limits.items():
            one = self._declared[name]
            for form, share in one.forms.items():
                numbers = [n for place in places[name] for n in (*place.first, *place.second)]
                faces = self._labels(one.part, dict.fromkeys(numbers))
                self._form(form, within.share(share), faces, one.to)

    def _dimension(self, one: ToleranceFaces, place: Place, within: Limits) -> None:
        size = DimensionObject()
        size.SetType(getattr(DimensionType, _TYPES[one.faces]))
        size.SetValue(within.nominal)
        size.SetUpperTolValue(within.upper)
        size.SetLowerTolValue(-within.lower)  # which the writer turns round
        label = self._tool.AddDimension()
        XCAFDoc_Dimension.Set_s(label).SetObject(size)
        first, second = (
            self._labels(place.inside or one.part, place.first),
            self._labels(one.part, place.second),
        )
        self._tool.SetDimension(first, second, label)

    def _form(self, form: Form, width: float, faces: TDF_LabelSequence, to: str) -> None:
        tolerance = ToleranceObject()
        tolerance.SetType(getattr(ToleranceType, _FORMS[form]))
        tolerance.SetValue(width)
        label = self._tool.AddGeomTolerance()
        XCAFDoc_GeomTolerance.Set_s(label).SetObject(tolerance)
        self._tool.SetGeomTolerance(faces, label)
        if form != "cylindricity":
            self._tool.SetDatumToGeomTol(self._datum(to), label)

    def _datum(self, letter: str) -> TDF_Label:
        """Return the datum of a letter, which is written once."""
        if letter not in self._letters:
            one = next(one for one in self._declared.values() if one.datum == letter)
            datum = DatumObject()
            datum.SetName(TCollection_HAsciiString(letter))
            datum.SetPosition(1)
            label = self._tool.AddDatum()
            XCAFDoc_Datum.Set_s(label).SetObject(datum)
            (place,) = self._carriers.places(one.name)
            self._tool.SetDatum(self._labels(one.part, place.first), label)
            self._letters[letter] = label
        return self._letters[letter]

    def _labels(self, part: str, numbers: Iterable[int]) -> TDF_LabelSequence:
        """Return the labels of faces of a part; each is made once."""
        product = self._products[part]
        labels = TDF_LabelSequence()
        for number in numbers:
            if (part, number) not in self._faces:
                face = product.solid.Faces()[number].wrapped
                self._faces[part, number] = self._shapes.AddSubShape(product.label, face)
            labels.Append(self._faces[part, number])
        return labels

"""Properties of the products in a STEP file: attributes, material and density, validation properties.

They follow the recommended practices of the CAx Interoperability Forum: for user-defined attributes, for
material identification and density, for geometric validation properties. Lengths are in millimetres, the
density is in kg/m³. Open CASCADE reads whatever comes last as the material, so the material comes last.
"""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass

from cadquery import Shape
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from cad.model import Part
from cad.part21 import plain, quoted

VALIDATION = "geometric validation property"
MATERIAL = "material property"
ATTRIBUTE = "user defined attribute"

_ACCURACY = 1e-11  # relative, as in `cad.inspect.measure`
_STRING = r"'((?:[^']|'')*)'"
_SHAPE = re.compile(  # the kernel breaks lines between any two tokens
    r"SHAPE_DEFINITION_REPRESENTATION\(\s*(#\d+)\s*,\s*(#\d+)\s*\)|"
    r"^(#\d+) = PRODUCT_DEFINITION_SHAPE\([^#]*(#\d+)\s*\)|"
    r"^(#\d+) = PRODUCT_DEFINITION\([^#]*(#\d+)\s*,\s*#\d+\s*\)|"
    r"^(#\d+) = PRODUCT_DEFINITION_FORMATION\([^#]*(#\d+)\s*\)|"
    rf"^(#\d+) = PRODUCT\(\s*{_STRING}\s*,\s*{_STRING}|"
    r"^(#\d+) = (?:ADVANCED_BREP_)?SHAPE_REPRESENTATION\(\s*'[^']*'\s*,\s*\([^)]*\)\s*,\s*(#\d+)\s*\)",
    re.MULTILINE,
)


@dataclass(frozen=True)
class PartProperties:
    """Stated properties of a part: volume [mm³], area [mm²], centroid [mm], density [kg/m³]."""

    part: str
    volume: float
    area: float
    centroid: tuple[float, float, float]
    material: str
    density: float


@dataclass(frozen=True)
class Measures:
    """The measures of a solid: volume [mm³], area [mm²], centroid [mm]."""

    volume: float
    area: float
    centroid: tuple[float, float, float]


def properties_of(part: Part, solid: Shape) -> PartProperties:
    """Return the properties of a part, integrated over its solid as `cad.inspect.measure` does."""
    material = part.made_of.rpartition(" (")[0] or part.made_of  # name without the density
    one = measured(solid)
    return PartProperties(part.name, one.volume, one.area, one.centroid, material, _digits(part.density))


def measured(solid: Shape) -> Measures:
    """Return the volume, area and centroid of a solid, to twelve digits."""
    volume, area = GProp_GProps(), GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, volume, _ACCURACY, False)
    BRepGProp.SurfaceProperties_s(solid.wrapped, area, _ACCURACY, False)
    centre = volume.CentreOfMass()
    x, y, z = (round(value, 9) + 0.0 for value in (centre.X(), centre.Y(), centre.Z()))
    return Measures(_digits(volume.Mass()), _digits(area.Mass()), (x, y, z))


def _digits(value: float) -> float:
    return float(f"{value:.12g}")


@dataclass(frozen=True)
class _Product:
    """The entities of a product: its definition, its shape, and the context of its representation."""

    definition: str
    shape: str
    context: str


def entities(
    data: str, first: int, title: str, attributes: Mapping[str, str], parts: Sequence[PartProperties]
) -> Iterator[str]:
    """Yield the entities, numbered from `first`, that state properties of the products in a data section.

    The attributes belong to the product called `title`, or to the only product.
    """
    products = _products(data)
    numbers = iter(range(first, first + 10**6))
    root = products.get(title) or next(iter(products.values()))
    yield from _attributes(numbers, root, attributes)
    if parts:
        units = _Units(*(next(numbers) for _ in range(10)))
        yield from units.entities()
        for part in parts:
            yield from _validation(numbers, products[part.part], part, units)
        for part in parts:
            yield from _material(numbers, products[part.part], part, units)


def validations(data: str, first: int, measures: Mapping[str, Measures]) -> Iterator[str]:
    """Yield the entities, numbered from `first`, of the validation properties of the named products.

    Raises
    ------
    KeyError
        If the data section has no product of one of these names.
    """
    products = _products(data)
    numbers = iter(range(first, first + 10**6))
    units = _Units(*(next(numbers) for _ in range(10)))
    yield from units.entities()
    for name, one in measures.items():
        yield from _validation(numbers, products[name], one, units)


def _products(data: str) -> dict[str, _Product]:
    """Return the products of a data section by name."""
    shown, shapes, definitions, formations, products, contexts = ({} for _ in range(6))
    for match in _SHAPE.finditer(data):
        g = match.groups()
        if g[0]:
            shown[g[0]] = g[1]
        elif g[2]:
            shapes[g[2]] = g[3]
        elif g[4]:
            definitions[g[4]] = g[5]
        elif g[6]:
            formations[g[6]] = g[7]
        elif g[8]:
            products[g[8]] = plain(f"'{g[10]}'")
        else:
            contexts[g[11]] = g[12]
    return {
        products[formations[definitions[definition]]]: _Product(definition, shape, contexts[shown[shape]])
        for shape, definition in shapes.items()
        if shape in shown and definition in definitions
    }


@dataclass(frozen=True)
class _Units:
    """The entity numbers of the units mm², mm³ and kg/m³."""

    millimetre: int
    metre: int
    kilogram: int
    mass: int
    squared: int
    area: int
    cubed: int
    volume: int
    per_volume: int
    density: int

    def entities(self) -> Iterator[str]:
        """Yield the entities of the units and of their elements."""
        yield f"#{self.millimetre} = (LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));"
        yield f"#{self.metre} = (LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));"
        yield f"#{self.kilogram} = (MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.));"
        yield f"#{self.mass} = DERIVED_UNIT_ELEMENT(#{self.kilogram},1.);"
        yield f"#{self.squared} = DERIVED_UNIT_ELEMENT(#{self.millimetre},2.);"
        yield f"#{self.area} = DERIVED_UNIT((#{self.squared}));"
        yield f"#{self.cubed} = DERIVED_UNIT_ELEMENT(#{self.millimetre},3.);"
        yield f"#{self.volume} = DERIVED_UNIT((#{self.cubed}));"
        yield f"#{self.per_volume} = DERIVED_UNIT_ELEMENT(#{self.metre},-3.);"
        yield f"#{self.density} = DERIVED_UNIT((#{self.mass},#{self.per_volume}));"


def _attributes(numbers: Iterator[int], root: _Product, attributes: Mapping[str, str]) -> Iterator[str]:
    """Yield the entities of a set of attributes, each with a name and a text."""
    if not attributes:
        return
    general, link, items = next(numbers), next(numbers), []
    for name, value in attributes.items():
        items.append(f"#{(number := next(numbers))}")
        yield f"#{number} = DESCRIPTIVE_REPRESENTATION_ITEM({quoted(name)},{quoted(value)});"
    definition = yield from _stated(numbers, "Crankwright", "", root.definition, items, root.context)
    yield f"#{general} = GENERAL_PROPERTY('','{ATTRIBUTE}',$);"
    yield f"#{link} = GENERAL_PROPERTY_ASSOCIATION('',$,#{general},{definition});"


def _validation(
    numbers: Iterator[int], product: _Product, part: PartProperties | Measures, units: _Units
) -> Iterator[str]:
    measures = (
        ("volume", f"'volume measure',VOLUME_MEASURE({_real(part.volume)}),#{units.volume}"),
        ("surface area", f"'surface area measure',AREA_MEASURE({_real(part.area)}),#{units.area}"),
    )
    for what, measure in measures:
        yield f"#{(number := next(numbers))} = MEASURE_REPRESENTATION_ITEM({measure});"
        yield from _stated(numbers, VALIDATION, what, product.shape, [f"#{number}"], product.context)
    point = ",".join(map(_real, part.centroid))
    yield f"#{(number := next(numbers))} = CARTESIAN_POINT('centre point',({point}));"
    yield from _stated(numbers, VALIDATION, "centroid", product.shape, [f"#{number}"], product.context)


def _material(
    numbers: Iterator[int], product: _Product, part: PartProperties, units: _Units
) -> Iterator[str]:
    measure = f"'density measure',POSITIVE_RATIO_MEASURE({_real(part.density)}),#{units.density}"
    yield f"#{(density := next(numbers))} = MEASURE_REPRESENTATION_ITEM({measure});"
    yield f"#{(name := next(numbers))} = DESCRIPTIVE_REPRESENTATION_ITEM({quoted(part.material)},'');"
    yield from _stated(numbers, MATERIAL, "density", product.definition, [f"#{density}"], product.context)
    yield from _stated(numbers, MATERIAL, "material name", product.definition, [f"#{name}"], product.context)


def _stated(
    numbers: Iterator[int], name: str, what: str, of: str, items: Sequence[str], context: str
) -> Generator[str, None, str]:
    """Yield the entities of a property with its representation; return the property."""
    definition, representation, link = next(numbers), next(numbers), next(numbers)
    yield f"#{definition} = PROPERTY_DEFINITION({quoted(name)},{quoted(what)},{of});"
    yield f"#{representation} = REPRESENTATION({quoted(what or name)},({','.join(items)}),{context});"
    yield f"#{link} = PROPERTY_DEFINITION_REPRESENTATION(#{definition},#{representation});"
    return f"#{definition}"


def _real(value: float) -> str:
    """Return a number in the form of Part 21, always with a decimal point: `1.5E-05`."""
    text = f"{value:.15g}".upper()
    mantissa, exponent, power = text.partition("E")
    return f"{mantissa}{'' if '.' in mantissa else '.'}{exponent}{power}"

"""Make the text of a STEP file reproducible by replacing the varying parts of the kernel's output.

Three things in the text depend on the process that wrote it: the time in the header; a counter of assembly
usages that never restarts, whose digits shift the line breaks; and the order of colours, which follows memory
addresses. So this module writes the header and the colours itself, and numbers usages from 1.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from importlib.metadata import version
from itertools import count

from cad.header import Header, write_header
from cad.model import Colour
from cad.part21 import in_ascii
from cad.properties import PartProperties, entities

SCHEMA = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"
KERNEL = f"CadQuery {version('cadquery')}, Open CASCADE {version('cadquery-ocp')}"

_USAGE = re.compile(r"^(#\d+ = NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+',((?:'[^']*'|[^';])*);", re.MULTILINE)
_TOKEN = re.compile(r"'(?:[^']|'')*',?|[^',)]+,?|\)")
_WIDEST = 72  # longest line of the kernel's writer [characters]
_NAMELESS = re.compile(r"(SHAPE_DIMENSION_REPRESENTATION\(|CYLINDRICITY_TOLERANCE\(|GEOMETRIC_TOLERANCE\()''")
_DEVIATION = re.compile(r"(= MEASURE_WITH_UNIT\()(?:-(?=0\.,))?(-?[0-9.][0-9.E+-]*),")
_PEN = "DRAUGHTING_PRE_DEFINED_COLOUR('{}')"
_POINT = re.compile(r"^#\d+ = CARTESIAN_POINT\([^;]*;", re.MULTILINE)
_NOISE = re.compile(r"-?\d+\.\d*E-(?:1[3-9]|[2-9]\d|\d{3})(?=[,)])")
_NUMBER = re.compile(r"#(\d+) = ")
_ANNOTATIONS = re.compile(r"^(#\d+ = DRAUGHTING_MODEL\([^;]*,\s*)#\d+\);", re.MULTILINE)
_ROOT = re.compile(r"= SHAPE_DEFINITION_REPRESENTATION\(#\d+,#(\d+)\);")
_PRODUCT = re.compile(r"ADVANCED_BREP_SHAPE_REPRESENTATION\('[^']*',\(([^)]*)\),(#\d+)\)")
_SOLID = re.compile(r"^(#\d+) = (?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS)\(", re.MULTILINE)


def finished(
    text: str,
    header: Header,
    colours: Sequence[Colour],
    names: Sequence[str] = (),
    properties: Sequence[PartProperties] = (),
) -> str:
    """Return the kernel's text with this program's header and the products' colours in file order.

    `names` are the parameters of the dimensions, followed by those of the geometric tolerances, in the order
    of the file; `properties` are the properties of the parts.
    """
    data = in_ascii(text[text.index("ENDSEC;") + len("ENDSEC;") :])
    number = count(1)
    data = _USAGE.sub(lambda usage: _usage(usage[1], next(number), usage[2]), data)
    body, end, rest = data.rpartition("ENDSEC;")
    body += _styles(body, colours)
    if properties:
        first = _last_number(body) + 1
        attributes = {"model": header.title, "build": header.build, **header.parameters}
        lines = entities(body, first, header.model, attributes, properties)
        body = _annotated(body, names) + "".join(f"{line}\n" for line in lines)
        body = _in_axes_of_file(body)
    return f"ISO-10303-21;\n{write_header(header, SCHEMA, KERNEL)}{body}{end}{rest}"


def without_noise(text: str) -> str:
    """Return the kernel's text with every coordinate below 1e-12 in magnitude replaced by 0."""
    return _POINT.sub(lambda point: _NOISE.sub("0.", point[0]), text)


def _usage(start: str, number: int, rest: str) -> str:
    """Return an assembly usage with its number in the file; its line breaks do not depend on the kernel.

    The kernel's writer may break a line before a comma; here a comma stays on the line of the preceding word.
    """
    lines = [f"{start}'{number}',"]
    for token in _TOKEN.findall(rest.replace("\n  ", "").removesuffix(")")):
        _append(lines, token)
    _append(lines, ");")
    return "\n".join(lines)


def _append(lines: list[str], token: str) -> None:
    if len(lines[-1]) + len(token) > _WIDEST:
        lines.append("  ")
    lines[-1] += token


def _annotated(data: str, names: Sequence[str]) -> str:
    """Return the data section with parameters as names of dimensions, and with the types of deviations."""
    number = iter(names)
    named = _NAMELESS.sub(lambda match: f"{match[1]}'{next(number)}'", data)
    named = named.replace(_PEN.format("white"), _PEN.format("magenta"))  # visible on white and on black
    return _DEVIATION.sub(r"\1LENGTH_MEASURE(\2),", named)


def _in_axes_of_file(data: str) -> str:
    """Return the data section with its annotations in the axes of the file: in those of its first product.

    The kernel gives them the context of the first annotated part. The context is the whole statement, because
    Open CASCADE 7.9 crashes on reading a MECHANICAL_DESIGN_AND_DRAUGHTING_RELATIONSHIP to an assembly.
    """
    if (model := _ANNOTATIONS.search(data)) is None:
        return data
    root = _ROOT.search(data)
    assert root is not None, "the kernel's file has a product"
    context = re.search(
        rf"^#{root[1]} = [A-Z_]*SHAPE_REPRESENTATION\([^;]*,\s*(#\d+)\s*\);", data, re.MULTILINE
    )
    assert context is not None, "the first product has a shape"
    return f"{data[: model.start()]}{model[1]}{context[1]});{data[model.end() :]}"


def _styles(data: str, colours: Iterable[Colour]) -> str:
    """Return the entities that colour the solids of the data section, product by product."""
    first = _last_number(data) + 1
    solids = set(_SOLID.findall(data))
    lines: list[str] = []
    for product, colour in zip(_PRODUCT.finditer(data), colours, strict=True):
        for item in re.findall(r"#\d+", product[1]):
            if item in solids:
                lines += _style(first + len(lines), item, product[2], colour)
    return "".join(f"{line}\n" for line in lines)


def _last_number(data: str) -> int:
    """Return the number of the last entity of a data section.

    The search begins at its end, because the section is long.
    """
    place = data.rfind("\n#")
    while (last := _NUMBER.match(data, place + 1)) is None:
        place = data.rindex("\n#", 0, place)
    return int(last[1])


def _style(n: int, solid: str, context: str, colour: Colour) -> Iterator[str]:
    """Yield the nine entities, numbered from n, that define the colour of a solid by ISO 10303-46."""
    red, green, blue = (f"{channel:.6f}" for channel in colour)
    entities = (
        f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#{n + 1}),{context})",
        f"STYLED_ITEM('color',(#{n + 2}),{solid})",
        f"PRESENTATION_STYLE_ASSIGNMENT((#{n + 3}))",
        f"SURFACE_STYLE_USAGE(.BOTH.,#{n + 4})",
        f"SURFACE_SIDE_STYLE('',(#{n + 5}))",
        f"SURFACE_STYLE_FILL_AREA(#{n + 6})",
        f"FILL_AREA_STYLE('',(#{n + 7}))",
        f"FILL_AREA_STYLE_COLOUR('',#{n + 8})",
        f"COLOUR_RGB('',{red},{green},{blue})",
    )
    return (f"#{n + i} = {entity};" for i, entity in enumerate(entities))

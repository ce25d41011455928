"""3MF files for 3D printing: closed meshes in millimetres, with names, colours and positions.

The package follows the 3MF Core Specification 1.3: a ZIP archive of one model, its relationship and the list
of content types. Equal meshes give equal bytes.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
from cadquery import Location

from cad.mesh import Mesh, welded
from cad.model import Colour
from cad.step import rigid

_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_RELATED = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_MODEL = "3D/3dmodel.model"
_TYPES = f"""{_HEAD}<Types xmlns="{_PACKAGE}/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""
_RELATIONS = f"""{_HEAD}<Relationships xmlns="{_PACKAGE}/relationships">
<Relationship Target="/{_MODEL}" Id="rel0" Type="{_RELATED}"/>
</Relationships>
"""
_COLOURS = 1  # id of the list of colours; the meshes have the next ids
_FIRST = 2


def write_3mf(meshes: Sequence[Mesh], title: str = "model") -> bytes:
    """Return meshes as one 3MF package: an object for each, and an item for each of its positions."""
    files = {"[Content_Types].xml": _TYPES, "_rels/.rels": _RELATIONS, _MODEL: _model(meshes, title)}
    stream = io.BytesIO()
    with ZipFile(stream, "w") as package:
        for name, text in files.items():
            entry = ZipInfo(name)  # a ZIP archive's earliest date
            entry.compress_type = ZIP_DEFLATED
            package.writestr(entry, text.encode())
    return stream.getvalue()


def _model(meshes: Sequence[Mesh], title: str) -> str:
    colours = "".join(f"<base name={quoteattr(m.name)} displaycolor={_hex(m.colour)}/>\n" for m in meshes)
    objects = "".join(_object(number, one) for number, one in enumerate(meshes))
    items = "".join(item for number, one in enumerate(meshes) for item in _items(number, one))
    return (
        f'{_HEAD}<model unit="millimeter" xml:lang="en" xmlns="{_CORE}">\n'
        f'<metadata name="Title">{_escaped(title)}</metadata>\n'
        f'<metadata name="Application">Crankwright</metadata>\n'
        f'<resources>\n<basematerials id="{_COLOURS}">\n{colours}</basematerials>\n{objects}</resources>\n'
        f"<build>\n{items}</build>\n</model>\n"
    )


def _object(number: int, one: Mesh) -> str:
    points, triangles = welded(one)
    vertices = "\n".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in points.tolist())
    corners = "\n".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in triangles.tolist())
    return (
        f'<object id="{_FIRST + number}" type="model" name={quoteattr(one.name)} pid="{_COLOURS}" '
        f'pindex="{number}"><mesh>\n<vertices>\n{vertices}\n</vertices>\n<triangles>\n{corners}\n</triangles>\n'
        "</mesh></object>\n"
    )


def _items(number: int, one: Mesh) -> Iterator[str]:
    for name, place in zip(one.names, one.places, strict=True):
        position = f'transform="{_transform(place)}" partnumber={quoteattr(name)}'
        yield f'<item objectid="{_FIRST + number}" {position}/>\n'


def _transform(place: Location) -> str:
    """Return the twelve numbers of a position; 3MF multiplies a row vector of coordinates by the matrix."""
    turn, shift = rigid(place)
    return " ".join(f"{number + 0.0:.12g}" for number in np.concatenate([turn.T.ravel(), shift]).tolist())


def _hex(colour: Colour) -> str:
    return quoteattr("#" + "".join(f"{round(255 * part):02X}" for part in colour[:3]))


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")

"""The stamp on a downloaded STEP file or drawing, which identifies the design.

All designs with equal parameters share a build, so the files of a build name no design. At the download the
stamp is written into a copy: into the product names and the time of a STEP file, or into the title block of a
drawing. The result is a pure function of file and stamp. `is_copy` recognises a STEP file whatever its stamp.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from html import escape

from cad.drafting.letter_width import clipped, width_of
from cad.drafting.title import STAMPED as STAMPED_FIELDS
from cad.drafting.title import STAMPED_OF_PART
from cad.file_names import name, plain_name, stem, wide_stem
from cad.part21 import end_of_string, entities, plain, quoted
from cad.signed_file import without_claims

_STRING = r"'(?:[^']|'')*'"
_FILE = re.compile(rf"FILE_NAME\(({_STRING}\s*,\s*{_STRING})")
_PRODUCT = re.compile(rf" = PRODUCT\(\s*({_STRING}\s*,\s*({_STRING})\s*,\s*({_STRING}))")
_COMMA = re.compile(r"\s*,\s*")
_VERSION = re.compile(rf" = PRODUCT_DEFINITION_FORMATION\(\s*({_STRING})")

MARK = "stamp:"
"""Prefix in the extended data of a DXF text; the line of the title block follows it."""

LONGEST_LINE = 44  # letters that fit into the title block of an older drawing
_SVG_LINE = re.compile(r'(<text data-stamp="([a-z-]+)"[^>]*>)([^<]*)')
_DENSITY = re.compile(r"([0-9.e+-]+) kg/m³")
_VOLUME = re.compile(r"([0-9.e+-]+) (mm³|dm³)")
_METRES = {"mm³": 1e-9, "dm³": 1e-3}


@dataclass(frozen=True)
class Stamp:
    """The design to which a file belongs.

    `model` is the name of the model in the design, `date` the date of the revision (ISO 8601).

    `materials` are the materials of the parts by name, empty if unknown. The file name of a variant contains
    the variant, and the model only if the design has several (`is_only` is false). If title, number or
    revision mark are given, they replace those of the design in a title block. `part` is the part on a sheet
    of one part.
    """

    design: str
    model: str
    revision: int
    date: str
    materials: Mapping[str, str] = field(default_factory=dict)
    variant: str | None = None
    is_only: bool = True
    owner: str = ""
    author: str = ""
    checker: str = ""
    approver: str = ""
    status: str = ""
    mass: float | None = None  # [kg]
    title: str = ""
    number: str = ""
    mark: str = ""
    part: str = ""
    rounded: str = ""  # parameters that the design rounds: calculated and chosen values
    id: str = ""  # of the design
    build: str = ""  # its key

    @property
    def called(self) -> str:
        """Return the name of the model for file names."""
        if self.variant is None:
            return self.model
        return self.variant if self.is_only else f"{self.variant}_{self.model}"

    @property
    def stem(self) -> str:
        """Return the file name without its extension, in ASCII."""
        return stem(self.design, self.called, self.revision)

    @property
    def wide_stem(self) -> str:
        """Return the file name without its extension, in the user's spelling."""
        return wide_stem(self.design, self.called, self.revision)

    @property
    def part_number(self) -> str:
        """Return the product id in ASCII: the given number, otherwise design, variant and model.

        The id does not contain the revision, so that a PDM system sees one part with several revisions.
        """
        return self.number or f"{plain_name(self.design)}_{self.called}"

    @property
    def named(self) -> str:
        """Return the name of the model, with its variant."""
        return ", ".join(filter(None, (self.variant, self.model)))

    @property
    def block(self) -> dict[str, str]:
        """Return the lines for the title block of an older drawing."""
        part = f"{self.named}, revision {self.revision}, {self.date[:10]}"
        return {"design": self.design, "part": part, "material": self.material}

    @property
    def fields(self) -> dict[str, str]:
        """Return the texts of a drawing's title block (ISO 7200), by field."""
        return {
            "owner": self.owner,
            "title": self.title or self.design,
            "author": self.author,
            "checker": self.checker,
            "approver": self.approver,
            "status": self.status,
            "number": self.number or f"{name(self.design)}_{self.called}",
            "revision": self.mark or str(self.revision),
            "date": self.date[:10],
            "material": self._short_material,
            "mass": "" if self.mass is None else f"{self.mass:.4g} kg",
            "part": self.named,
            "rounded": self.rounded,
        }

    def of_part(self, volume: str) -> dict[str, str]:
        """Return the material and mass of the part on its sheet, whose title block gives its volume [mm³]."""
        materials = [*self.materials.values()]
        material = self.materials.get(self.part, materials[0] if len(materials) == 1 else "")
        density, amount = _DENSITY.search(material), _VOLUME.search(volume)
        mass = float(density[1]) * float(amount[1]) * _METRES[amount[2]] if density and amount else None
        return {"material": material, "mass": "" if mass is None else f"{mass:.4g} kg"}

    @property
    def _short_material(self) -> str:
        """Return the materials for the title block, without part names if there is no room for them."""
        field_ = STAMPED_FIELDS["iso-material"]
        if width_of(self.material, field_.letters) <= field_.room:
            return self.material
        return "; ".join(dict.fromkeys(self.materials.values()))

    @property
    def material(self) -> str:
        """Return the distinct materials of all parts; several are listed with the names of their parts."""
        parts: dict[str, list[str]] = {}
        for part, material in self.materials.items():
            parts.setdefault(material, []).append(part)
        if len(parts) < 2:
            return "".join(parts)
        return "; ".join(f"{', '.join(names)}: {material}" for material, names in parts.items())


def stamped(file: bytes, kind: str, stamp: Stamp) -> bytes:
    """Return a file with its stamp; a file of a kind without a stamp is unchanged."""
    write = _WRITERS.get(kind)
    return write(file.decode(_ENCODING[kind]), stamp).encode(_ENCODING[kind]) if write else file


def takes_stamp(file: bytes, kind: str) -> bool:
    """Return whether a file has the lines that a stamp fills in; drawings from older programs lack them."""
    return kind not in _MARKS or _MARKS[kind] in file


def is_copy(file: bytes, original: bytes) -> bool:
    """Return whether a STEP file equals another one except for its stamp.

    The time is linear in both lengths.
    """
    text, source = without_claims(file).decode("latin-1"), original.decode("latin-1")
    place, done = 0, 0
    for hole in _holes(source):
        if not text.startswith(source[done : hole.start], place):
            return False
        place, done = _behind_strings(text, place + hole.start - done, hole.strings), hole.end
    return text[place:] == source[done:]


@dataclass(frozen=True)
class _Hole:
    """A position in a finished STEP file that a stamp replaces, and the number of strings there."""

    start: int
    end: int
    strings: int
    written: Callable[[Stamp], tuple[str, ...]]


def _holes(text: str) -> list[_Hole]:
    """Return the positions to fill in, in text order: file and time, products, product versions."""
    file = _FILE.search(text)
    holes = [_Hole(*file.span(1), 2, _file)] if file else []
    for number, product in enumerate(entities(text, _PRODUCT)):
        write = partial(_part, plain(product[2])) if number else partial(_root, plain(product[3]))
        holes.append(_Hole(*product.span(1), 3, write))
    holes += (_Hole(*version.span(1), 1, _version) for version in entities(text, _VERSION))
    return sorted(holes, key=lambda hole: hole.start)


def _file(stamp: Stamp) -> tuple[str, ...]:
    part = f"_{plain_name(stamp.part)}" if stamp.part else ""
    return f"{stamp.wide_stem}{part}.step", stamp.date


def _root(volume: str, stamp: Stamp) -> tuple[str, ...]:
    """Return the id, name and description of the product that stands for the whole file.

    A file of one part describes its product by its volume.
    """
    if stamp.part:
        id, called, _ = _part(stamp.part, stamp)
        own = stamp.of_part(volume)
        mass = f"mass {own['mass']}" if own["mass"] else ""
        return id, called, ", ".join(filter(None, (own["material"], mass)))
    described = (
        f"design {stamp.design}",
        f"variant {stamp.variant}" if stamp.variant else "",
        f"model {stamp.model}",
        stamp.material,
        "" if stamp.mass is None else f"mass {stamp.mass:.6g} kg",
        f"crankwright:{stamp.id}:{stamp.revision}" if stamp.id else "",  # what another program may keep
    )
    return stamp.part_number, f"{name(stamp.design)}_{stamp.called}", ", ".join(filter(None, described))


def _part(part: str, stamp: Stamp) -> tuple[str, ...]:
    """Return the id, name and description of a part of an assembly."""
    return f"{stamp.part_number}_{part}", part, stamp.materials.get(part, "")


def _version(stamp: Stamp) -> tuple[str, ...]:
    return (stamp.mark or str(stamp.revision),)


def _stamped_step(text: str, stamp: Stamp) -> str:
    pieces, done = [], 0
    for hole in _holes(text):
        pieces += [text[done : hole.start], ",\n  ".join(map(quoted, hole.written(stamp)))]
        done = hole.end
    return "".join([*pieces, text[done:]])


def _behind_strings(text: str, place: int, count: int) -> int:
    """Return the position after a sequence of at most this many strings, separated by commas."""
    for number in range(count):
        if number:
            place = _behind_comma(text, place)
        if text.startswith("'", place):
            place = end_of_string(text, place)
    return place


def _behind_comma(text: str, place: int) -> int:
    match = _COMMA.match(text, place)
    return match.end() if match else place


def _stamped_svg(text: str, stamp: Stamp) -> str:
    lines = _lines(stamp)

    def written(line: re.Match[str]) -> str:
        return line[1] + escape(_written(line[2], line[3], lines, stamp) or "")

    return _SVG_LINE.sub(written, text)


def _stamped_dxf(text: str, stamp: Stamp) -> str:
    """Return the DXF with its stamp.

    DXF consists of pairs of lines, a code and its value; the mark of a text comes after the text.
    """
    lines, known = text.split("\n"), _lines(stamp)
    last = 0
    for place in range(0, len(lines) - 1, 2):
        code, value = lines[place].strip(), lines[place + 1]
        if code == "1":
            last = place + 1
        elif code == "1000" and (mark := value.removeprefix(MARK)) != value:
            written = _written(mark, lines[last], known, stamp)
            if written is not None:
                lines[last] = written.replace("^", "^ ").replace("%%", "%%%%%%")
    return "\n".join(lines)


def _written(mark: str, text: str, lines: Mapping[str, str], stamp: Stamp) -> str | None:
    """Return the text of a marked field in place of the drawing's own; None for a mark that is not known."""
    if (field_ := STAMPED_OF_PART.get(mark)) is None:
        return lines.get(mark)
    return clipped(stamp.of_part(text)[field_.name], field_.room, field_.letters)


def _lines(stamp: Stamp) -> dict[str, str]:
    """Return the lines of a title block by their marks, including those of older drawings."""
    older = {name: _clipped(f"{name}: {value}") for name, value in stamp.block.items()}
    fields = stamp.fields
    return older | {
        mark: clipped(fields[field.name], field.room, field.letters) for mark, field in STAMPED_FIELDS.items()
    }


def _clipped(line: str) -> str:
    plain_line = "".join(sign if sign.isprintable() else " " for sign in line)
    return plain_line if len(plain_line) <= LONGEST_LINE else f"{plain_line[: LONGEST_LINE - 1]}…"


_WRITERS: dict[str, Callable[[str, Stamp], str]] = {
    "step": _stamped_step,
    "validated.step": _stamped_step,
    "drawing.svg": _stamped_svg,
    "dxf": _stamped_dxf,
}
STAMPED = tuple(_WRITERS)
"""Kinds of files that have a stamp."""

_ENCODING = {"step": "latin-1", "validated.step": "latin-1", "drawing.svg": "utf-8", "dxf": "utf-8"}
_MARKS = {"drawing.svg": b'data-stamp="', "dxf": MARK.encode()}

"""The border, title block, notes and parameter table of a sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cad.drafting.formats import COLUMN, EDGE, LEFT
from cad.drafting.frames import Frame
from cad.drafting.letter_width import clipped, width_of
from cad.drafting.page import APP, Page
from cad.drafting.parameter_match import size_of
from cad.drafting.symbols import basic_texture, first_angle, texture
from cad.drafting.title import (
    CAPTION,
    FIELDS,
    GENERAL,
    HEIGHT,
    ROUNDED,
    SIZES,
    STAMPED_OF_PART,
    SURFACES,
    TEXTURE,
    WIDTH,
    Field,
)
from cad.header import Header
from cad.stamp import MARK
from cad.step import Body
from cad.tolerances import Limits, TableTolerance, angle_tolerance, deviations, limits_of, number_of
from templates.core.units.tolerance import IN_TABLE

_ROW = 6.0  # from one row of the table to the next, if they have room [mm on paper]
_LETTERS = 3.0
_NAMES = 58.0  # width of the names in the table [mm on paper]
_LARGE, _DM3 = 1e5, 1e6  # [mm³]
_MOST_LINES = 3  # of one value in the table


def frame(page: Page) -> None:
    """Draw the edge of the sheet, then the borders of its areas."""
    format = page.plan.format
    width, height = format.width, format.height
    right, column, block = width - EDGE, width - EDGE - COLUMN, width - EDGE - WIDTH
    top, over = height - EDGE, EDGE + HEIGHT
    page.line([(0, 0), (width, 0), (width, height), (0, height), (0, 0)], "FRAME")
    page.line([(LEFT, EDGE), (right, EDGE), (right, top), (LEFT, top), (LEFT, EDGE)], "FRAME")
    page.line([(column, over), (column, top)], "FRAME")
    page.line([(LEFT, over), (right, over)], "FRAME")
    page.line([(block, EDGE), (block, over)], "FRAME")


@dataclass(frozen=True)
class General:
    """General tolerances; with a datum, a general profile tolerance refers to it [mm] (ISO 22081)."""

    profile: float | None = None
    datum: str = ""

    @property
    def has_profile(self) -> bool:
        """Return whether the general profile tolerance of ISO 22081 applies."""
        return self.profile is not None and self.datum != ""

    @property
    def text(self) -> str:
        """Return the text before the profile frame in the title block."""
        return f"{SIZES}, {SURFACES}" if self.has_profile else GENERAL

    @property
    def note(self) -> str:
        """Return the note that explains the general tolerances."""
        if not self.has_profile:
            return f"sizes, angles and geometry without a tolerance: {GENERAL}"
        return (
            f"without a tolerance: sizes, angles {SIZES}; surfaces {SURFACES}, about those of the STEP file"
        )

    def draw(self, page: Page, left: float, low: float) -> None:
        """Draw the frame of the profile tolerance after its text."""
        if self.profile is not None and self.datum:
            frame = Frame("profile", self.profile, self.datum, 2.5)
            frame.draw(page, left + width_of(self.text, 2.5) + 1.5, low - 1.3)


@dataclass(frozen=True)
class SheetNumber:
    """The number of a sheet: the first sheet shows all parts, each further sheet one part.

    On the first of several sheets, `names` holds the names of all parts and how often they occur. `volume` is
    that of the part [mm³], from which a stamp computes its mass.
    """

    number: int = 1
    count: int = 1
    part: str = ""
    names: tuple[tuple[str, int], ...] = ()
    volume: float = 0.0

    @property
    def volume_text(self) -> str:
        """Return the volume of a part, with a unit that makes it short enough for its field."""
        if not self.part:
            return ""
        return f"{self.volume:.5g} mm³" if self.volume < _LARGE else f"{self.volume / _DM3:.5g} dm³"

    @staticmethod
    def of(bodies: Sequence[Body], whole: Sequence[Body]) -> SheetNumber:
        """Return the number of the sheet that shows some of the bodies of a model."""
        every = [body.name for body in whole or bodies]
        if len(every) == 1:
            return SheetNumber()
        if len(bodies) == 1:
            part = bodies[0]
            number = every.index(part.name) + 2
            return SheetNumber(number, len(every) + 1, part.name, volume=part.shape.Volume())
        names = tuple((body.name, len(body.places)) for body in bodies)
        return SheetNumber(1, len(every) + 1, "", names)


def title_block(page: Page, header: Header | None, general: General, sheet: SheetNumber) -> None:
    """Draw the fields of ISO 7200; a stamp later fills in those that a design gives."""
    left, low = page.plan.format.block
    model = f"{header.model.replace('_', ' ')}, version {header.version}" if header else "part"
    texts = {
        "sheet": f"{sheet.number}/{sheet.count}",
        "part": sheet.part.replace("_", " "),
        "mass": sheet.volume_text,
        "language": "en",
        "format": page.plan.format.name,
        "model": model,
        "general": general.text,
        "scale": page.plan.scale_text,
    }
    for field in FIELDS:
        x, y = left + field.left, low + field.low
        box = [
            (x, y),
            (x + field.width, y),
            (x + field.width, y + field.height),
            (x, y + field.height),
            (x, y),
        ]
        page.line(box, "FRAME")
        page.write(field.caption, left + field.caption_at[0], low + field.caption_at[1], CAPTION)
        text = clipped(texts.get(field.name, ""), field.room, field.letters)
        mark = _stamped(field, sheet)
        if mark or text:
            line = page.write(text, left + field.text_at[0], low + field.text_at[1], field.letters)
            if mark:
                line.set_xdata(APP, [(1000, f"{MARK}{mark}")])
        if field.name == "general":
            general.draw(page, left + field.text_at[0], low + field.text_at[1])
        if field.name == "projection":
            page.symbol(first_angle(4.8).moved(x + 25.0, y + 3.6))
            page.write("first", left + field.text_at[0], low + field.text_at[1], 2.0)


def _stamped(field: Field, sheet: SheetNumber) -> str:
    """Return the mark by which a stamp fills in a field; none if the drawing itself fills it in."""
    if sheet.part and field.part_mark in STAMPED_OF_PART:
        return field.part_mark
    return field.mark if field.is_stamped and not (sheet.part and field.name == "part") else ""


def notes(page: Page, header: Header | None, unseen: Sequence[str], general: General) -> None:
    """Draw the general notes, to the left of the title block."""
    left, top = LEFT + 3.0, EDGE + HEIGHT - 6.0
    lines = [
        "dimensions in mm, measured on the solid, at 20 °C (ISO 1); ( ) for reference",
        "size is a two-point size, independent of form (ISO 8015)",
        general.note,
        f"build {header.build[:32]}" if header else "",
        "* no dimension shows it, or its tolerance" if unseen else "",
    ]
    written = [*filter(None, lines)]
    for row, text in enumerate(written):
        page.write(text, left, top - 5.0 * row, 2.5)
    stamped = page.write("", left, top - 5.0 * len(written), ROUNDED.letters)
    stamped.set_xdata(APP, [(1000, f"{MARK}{ROUNDED.mark}")])
    y = EDGE + 4.0
    text = f"Ra {TEXTURE:g}"
    reach = width_of(text, 2.5)
    page.symbol(texture(3.5, reach).moved(left + 4.0, y))
    page.write(text, left + 9.5, y + 6.0, 2.5)
    page.write("(", left + 14.0 + reach, y + 1.5, 5.0)
    page.symbol(basic_texture(3.5).moved(left + 20.5 + reach, y + 0.5))
    page.write(")", left + 26.0 + reach, y + 1.5, 5.0)
    page.write("roughness in µm (ISO 21920-1)", left + 34.0 + reach, y + 1.5, 2.5)


def table(page: Page, parameters: Mapping[str, str], unseen: Sequence[str], below: int = 0) -> float:
    """Draw the table of parameters; return where it ends, with room left for `below` more rows."""
    left, top = page.plan.format.column
    left, top = left + 3, top - 7
    if not parameters:
        return top
    page.write("Parameters", left, top, 4.5)
    page.write("mm", left + _NAMES, top, _LETTERS)
    limits = limits_of(parameters)
    rows = [
        (name.replace("_", " ") + (" *" if name in unseen else "") if number == 0 else "", line)
        for name, text in parameters.items()
        for number, line in enumerate(_wrapped(_value(text, limits.get(name)), COLUMN - _NAMES - 6))
    ]
    room = top - (EDGE + HEIGHT) - 3.0
    row = min(_ROW, room / max(len(rows) + (below + 2 if below else 0), 1))
    size = min(_LETTERS, row * 0.55)
    for number, (name, text) in enumerate(rows, 1):
        y = top - row * number
        page.write(clipped(name, _NAMES - 2, size), left, y, size)
        page.write(text, left + _NAMES, y, size)
    return top - row * (len(rows) + 2)


def parts_list(page: Page, names: Sequence[tuple[str, int]], top: float) -> None:
    """Draw the parts list: the numbers of the balloons, the names, and how often each part occurs."""
    if not names:
        return
    left = page.plan.format.column[0] + 3
    room = top - (EDGE + HEIGHT) - 3.0
    row = min(_ROW, room / (len(names) + 1))
    size = min(_LETTERS, row * 0.55)
    page.write("Parts", left, top, min(4.5, row * 0.8))
    page.write("quantity", left + _NAMES, top, size)
    for number, (name, count) in enumerate(names, 1):
        y = top - row * number
        page.write(clipped(f"{number}  {name.replace('_', ' ')}", _NAMES - 2, size), left, y, size)
        page.write(str(count), left + _NAMES, y, size)


def _value(text: str, limits: Limits | None) -> str:
    """Return a length in mm with its deviations, an angle in degrees, and other values unchanged."""
    size = size_of(text)
    if size is None:
        return text.removesuffix(IN_TABLE)
    value, is_angle = size
    if is_angle:
        within = angle_tolerance(text)
        return " ".join((f"{number_of(value, 6)}°", *([f"{_ends(within)}°"] if within else [])))
    if limits is None:
        return number_of(value, 6)
    return " ".join(filter(None, (number_of(value, 6), limits.zone, _ends(limits))))


def _ends(limits: Limits | TableTolerance) -> str:
    return "/".join(filter(None, deviations(limits)))


def _wrapped(text: str, width: float) -> list[str]:
    """Wrap a value into lines of at most a given width; only the beginning of a very long list is kept."""
    if width_of(text, _LETTERS) <= width:
        return [text]
    lines = [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and width_of(longer, _LETTERS) > width:
            lines.append(word)
        else:
            lines[-1] = longer
        if len(lines) > _MOST_LINES:
            return [
                *(clipped(line, width, _LETTERS) for line in lines[: _MOST_LINES - 1]),
                "… whole in the STEP file",
            ]
    return [clipped(line, width, _LETTERS) for line in lines]

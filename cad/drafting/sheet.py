"""A drawing on its sheet as DXF: views, dimensions, table of parameters and title block, all in millimetres.

The section keeps its true coordinates and is drawn 1:1; the sheet around it is scaled instead. So a DIMENSION
measures the true size of the part. Each DIMENSION carries the name of its parameter.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice

from ezdxf._options import options
from ezdxf.document import Drawing

from cad.drafting.balloons import balloons
from cad.drafting.content import Content, contents, declared_of
from cad.drafting.controls import Controls
from cad.drafting.declaration import DrawingDeclaration
from cad.drafting.dimension_layout import DimensionLayout, NoRoom, PlacedDimension
from cad.drafting.formats import Format
from cad.drafting.marks import Centres, centre_lines, cutting_line, pitch_circles, section_label
from cad.drafting.page import Page, document_of
from cad.drafting.plan import Plan
from cad.drafting.removed_section import mark, place
from cad.drafting.room import Rectangle, Room
from cad.drafting.section_rows import in_rows
from cad.drafting.sheet_border import General, SheetNumber, frame, notes, parts_list, table, title_block
from cad.drafting.title import general_profile
from cad.drafting.views import View, is_assembly
from cad.header import Header
from cad.inspect import bounding_box
from cad.step import Body
from cad.surfaces import PartSurfaces

_MOST_PLANS = 8  # sheets and scales that are tried
_MOST_FAULTS = 1000
_MORE_PLANS = 2  # that are tried after one on which some leaders cross many lines
_FEW_FAULTS = 4  # of a sheet with removed sections, rather than one without them


def write_dxf(bodies: Sequence[Body], header: Header | None, whole: Sequence[Body] = ()) -> bytes:
    """Return a dimensioned drawing as DXF; equal bodies and headers give equal bytes."""
    stream = io.StringIO()
    with _no_times():
        document, _ = draw(bodies, header, whole)
        _register_classes(document)
        document.write(stream)
    return stream.getvalue().encode()


def _register_classes(document: Drawing) -> None:
    """Register the DXF classes in a fixed order.

    Ezdxf itself would iterate over a set, whose order differs between processes.
    """
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)


@contextmanager
def _no_times() -> Iterator[None]:
    """Make ezdxf write neither timestamps nor random ids."""
    kept = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = kept


@dataclass(frozen=True)
class Laid:
    """A sheet on which everything has a place.

    `faults` counts places that are not free, `crossed` leaders across many lines.
    """

    page: Page
    room: Room
    centres: Centres
    placed: Sequence[PlacedDimension]
    datum: str
    faults: int
    crossed: int


def draw(bodies: Sequence[Body], header: Header | None, whole: Sequence[Body] = ()) -> tuple[Drawing, Format]:
    """Return the drawing as an ezdxf document, and its sheet.

    On the sheet of a part, `whole` holds all parts of its model.
    """
    seen, declared = declared_of(bodies, header, whole)
    sheet = SheetNumber.of(bodies, whole)
    content, laid = laid_out(bodies, seen, header, declared)
    page = laid.page
    if content.section.cut:
        section_label(page, content.section, "A", laid.room)
    _fill(page, content.section, content.end, laid.centres, laid.placed)
    frame(page)
    box = bounding_box(bodies)
    longest = max(high - low for low, high in zip(box.low, box.high, strict=True))
    general = General(general_profile(longest), "" if is_assembly(bodies) else laid.datum)
    title_block(page, header, general, sheet)
    notes(page, header, content.unseen, general)
    parameters = declared.own(header.parameters if header else {})
    left = table(page, parameters, content.unseen, len(sheet.names))
    parts_list(page, sheet.names, left)
    return page.document, page.plan.format


def laid_out(
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    header: Header | None,
    declared: DrawingDeclaration,
) -> tuple[Content, Laid]:
    """Return the first sheet on which everything has a free place, else that with the fewest faults.

    Of the first such sheets, that is taken on which the fewest leaders cross many lines. Sheets without
    removed sections come last, unless those with them have many faults.
    """
    every: list[tuple[Content, Laid]] = []
    for content in contents(bodies, seen, header, declared):
        if any(laid.faults <= _FEW_FAULTS for _, laid in every):
            break
        more = _MORE_PLANS
        for plan in islice(content.plans(), _MOST_PLANS):
            most = max(min((laid.faults for _, laid in every), default=_MOST_FAULTS), 1)
            try:
                every.append((content, _laid(content, bodies, declared, plan, most)))
            except NoRoom:
                pass
            best = min((laid.faults, laid.crossed) for _, laid in every) if every else (1, 0)
            if best == (0, 0) or (best[0] == 0 and more == 0):
                break
            more -= best[0] == 0
    return min(every, key=lambda one: (one[1].faults, one[1].crossed))


def _laid(
    content: Content, bodies: Sequence[Body], declared: DrawingDeclaration, plan: Plan, most: int
) -> Laid:
    """Return the dimensions, removed sections and symbols on one sheet.

    Raises
    ------
    NoRoom
        If a removed section has no place, or there are as many faults as `most`.
    """
    page = Page(document_of(plan), plan)
    centres = centre_lines(content.section, content.end, bodies, plan)
    room = _room(content.section, content.end, centres, plan)
    cutting_line(page, content.section, content.end, room)
    for one in content.removed:
        mark(page, room, one, content.section)
    placing = DimensionLayout(plan, room, declared.datums)
    placed = placing.all()
    views = [(content.section, 0.0), (content.end, plan.beside)]
    origins = in_rows(plan, room, content.removed)
    for one in content.removed:
        dimensions, view = place(page, room, one, placing, origins.get(one.letter))
        placed += dimensions
        views.append((view, 0.0))
    if placing.faults >= most:
        raise NoRoom
    controls = Controls(page, room, views, most - placing.faults)
    for number, view, points in balloons(content.section, content.end, bodies):
        right = plan.beside if view is content.end else 0.0
        controls.balloon(str(number), [plan.paper(point, right) for point in points])
    datum = controls.draw(declared, placed)
    faults = placing.faults + controls.faults
    return Laid(page, room, centres, placed, datum, faults, controls.crossed)


def _fill(
    page: Page,
    section: View,
    end: View,
    centres: Centres,
    placed: Sequence[PlacedDimension],
) -> None:
    page.view(section, 0.0)
    page.view(end, page.plan.beside)
    page.centres(centres.lines, [*centres.circles, *pitch_circles(placed)])
    for dimension in placed:
        page.dimension(dimension)


def _room(section: View, end: View, centres: Centres, plan: Plan) -> Room:
    """Return the room of a sheet, occupied by its views and its centre lines."""
    left, low, right, high = plan.format.area
    room = Room((left + 1, low + 1, right - 1, high - 1))
    for view, away in ((section, 0.0), (end, plan.beside)):
        lines = (*view.visible, *view.hidden, *view.smooth)
        room.add_view(
            _on_paper(view, plan, away), [[plan.paper(p, away) for p in one.points] for one in lines]
        )
    for line in centres.lines:
        room.add_line([plan.paper(point) for point in line])
    return room


def _on_paper(view: View, plan: Plan, right: float) -> Rectangle:
    """Return the rectangle that a view occupies on the paper."""
    low, high = (plan.paper(corner, right) for corner in view.box)
    return (*low, *high)

"""A drawing on its sheet as DXF: views, dimensions, table of parameters and title block, all in millimetres.

The section stands at its true coordinates, everything is drawn 1:1, and the sheet around it is as large as
the scale requires; so a DIMENSION measures what the part measures. Each carries the name of its parameter.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import islice

from ezdxf._options import options
from ezdxf.document import Drawing

from cad.drafting.controls import Controls
from cad.drafting.declared import Declared
from cad.drafting.formats import Format
from cad.drafting.marks import Centres, centre_lines, cutting_line, pitch_circles, section_label
from cad.drafting.matching import matched, references
from cad.drafting.measures import measures
from cad.drafting.page import Page, document_of
from cad.drafting.placing import NoRoom, Placed, Placing
from cad.drafting.plan import Plan, plans
from cad.drafting.room import Rectangle, Room
from cad.drafting.standing import standing
from cad.drafting.titling import frame, notes, table, title_block
from cad.drafting.views import View, views
from cad.header import Header
from cad.step import Body

_MOST_PLANS = 8  # sheets and scales that are tried


def write_dxf(bodies: Sequence[Body], header: Header | None) -> bytes:
    """A dimensioned drawing; equal bodies and headers give equal bytes."""
    stream = io.StringIO()
    with _no_times():
        document, _ = draw(bodies, header)
        _register_classes(document)
        document.write(stream)
    return stream.getvalue().encode()


def _register_classes(document: Drawing) -> None:
    """List the classes in one order; ezdxf itself would walk a set, whose order differs by process."""
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)


@contextmanager
def _no_times() -> Iterator[None]:
    """Let ezdxf write neither times nor random ids."""
    kept = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = kept


def draw(bodies: Sequence[Body], header: Header | None) -> tuple[Drawing, Format]:
    """The drawing as a document of ezdxf, and its sheet."""
    declared = Declared.of(header)
    section, end = views(bodies, is_shaft=declared.is_shaft)
    seen = [*measures(bodies, section, end), *standing(bodies, section, end)]
    parameters = header.parameters if header else {}
    matches, unseen = matched(parameters, seen, declared.limits)
    tried = list(islice(plans(section, end, [*matches, *references(matches, seen)]), _MOST_PLANS))
    for plan in tried:
        document = document_of(plan)
        page = Page(document, plan)
        centres = centre_lines(section, end, bodies, plan)
        room = _room(section, end, centres, plan)
        cutting_line(page, section, end, room)
        try:
            is_last = plan is tried[-1]
            placed = Placing(plan, room, is_last=is_last).all()
            Controls(page, room, is_last=is_last).draw(declared, placed)
        except NoRoom:
            continue
        break
    section_label(page, section, room)
    _fill(page, section, end, centres, placed)
    frame(page)
    title_block(page, header)
    notes(page, header, unseen)
    table(page, parameters, unseen)
    return document, page.plan.format


def _fill(
    page: Page,
    section: View,
    end: View,
    centres: Centres,
    placed: Sequence[Placed],
) -> None:
    page.view(section, 0.0)
    page.view(end, page.plan.beside)
    page.centres(centres.lines, [*centres.circles, *pitch_circles(placed)])
    for dimension in placed:
        page.dimension(dimension)


def _room(section: View, end: View, centres: Centres, plan: Plan) -> Room:
    """The sheet with its views, into which no words may come, and its centre lines."""
    left, low, right, high = plan.format.area
    room = Room((left + 1, low + 1, right - 1, high - 1))
    for view, away in ((section, 0.0), (end, plan.beside)):
        room.add(_on_paper(view, plan, away), is_view=True)
    for line in centres.lines:
        room.add_line([plan.paper(point) for point in line])
    return room


def _on_paper(view: View, plan: Plan, right: float) -> Rectangle:
    """What a view takes on the paper."""
    low, high = (plan.paper(corner, right) for corner in view.box)
    return (*low, *high)

"""The content of a drawing: views, removed sections and the dimensions that define its parts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot

from cad.drafting.cross_sections import cross_sections
from cad.drafting.declaration import DrawingDeclaration
from cad.drafting.definition import Definition
from cad.drafting.measures import lengths, measures
from cad.drafting.parameter_match import Dimension, matched, spans_of
from cad.drafting.parts_features import Features
from cad.drafting.plan import Plan, plans
from cad.drafting.protrusions import standing
from cad.drafting.removed_section import RemovedSection, removed_sections
from cad.drafting.supplement import Supplement
from cad.drafting.views import View, is_assembly, views
from cad.header import Header
from cad.inspect import look_at
from cad.step import Body, rigid
from cad.surfaces import PartSurfaces, Surface, Z
from cad.tolerances import toleranced_in

_ON_CIRCLE = 1e-3  # from a circle to the centres of the holes on it [mm]


@dataclass(frozen=True)
class Content:
    """The content of a drawing.

    Attributes
    ----------
    unseen
        Parameters that no dimension shows, or whose tolerances none shows.
    undefined
        Features that the dimensions must define; None for an assembly, whose parts have their own sheets.
    repeated
        Start and end of lengths along the shaft that repeat, by parameter.
    """

    section: View
    end: View
    removed: Sequence[RemovedSection]
    dimensions: Sequence[Dimension]
    unseen: Sequence[str]
    undefined: Features | None
    repeated: Mapping[str, Sequence[tuple[float, float]]]

    def plans(self) -> Iterator[Plan]:
        """Yield the sheets and scales in the order in which they are tried."""
        elsewhere = sum(len(one.dimensions) for one in self.removed)
        below = any(one.stations for one in self.removed)
        return plans(self.section, self.end, self.dimensions, elsewhere, below=below)

    def missing(self, without: Dimension | None = None) -> list[str]:
        """Return descriptions of everything that the dimensions leave undefined.

        Parameters
        ----------
        without
            A dimension to ignore, as if the drawing did not show it.
        """
        if self.undefined is None:
            return []
        definition = Definition.of(self.undefined)
        for section in self.removed:
            kept = tuple(one for one in section.dimensions if one is not without)
            replace(section, dimensions=kept).define(definition)
        supplement = Supplement(definition, self.section, self.end, (), self.repeated)
        for one in self.dimensions:
            if one is not without and not one.is_reference:
                supplement.judged(one)
        return [*definition.missing()]


def declared_of(
    bodies: Sequence[Body], header: Header | None, whole: Sequence[Body] = ()
) -> tuple[dict[str, PartSurfaces], DrawingDeclaration]:
    """Return the surfaces of the bodies and the declaration of their model.

    On the sheet of a part, `whole` holds all parts of the model.
    """
    seen = look_at(bodies)
    every = look_at(whole) if len(whole) > len(bodies) else seen
    declared = DrawingDeclaration.of(header, every, is_assembly=is_assembly(bodies))
    return seen, declared.on(seen) if len(every) > len(seen) else declared


def content_of(bodies: Sequence[Body], header: Header | None, whole: Sequence[Body] = ()) -> Content:
    """Return the preferred content for the drawing of a STEP file, or of one of its parts."""
    seen, declared = declared_of(bodies, header, whole)
    return next(contents(bodies, seen, header, declared))


def contents(
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    header: Header | None,
    declared: DrawingDeclaration,
) -> Iterator[Content]:
    """Yield the content with removed sections, then without them for sheets that lack the room."""
    section, end = views(bodies, is_shaft=declared.is_shaft)
    parameters = declared.own(header.parameters if header else {})
    repeated = {name: spans_of(size, seen) for name, size in declared.sizes.items()}
    seen = {body.name: _standing(seen[body.name], body) for body in bodies}
    upright = [body for body in bodies if _is_upright(body)]
    own = {body.name: seen[body.name] for body in upright}
    shown = [
        *lengths(declared.sizes.values(), own, section),
        *measures(upright, own, section, end),
        *standing([*own.values()], section, end),
    ]
    removed = [
        *removed_sections(declared, parameters, bodies, seen, end),
        *cross_sections(declared, parameters, bodies, seen, end),
    ]
    for some in ([removed] if removed else []) + [[]]:
        cuts = [(one.height, one.leaning) for one in some]
        features = None if is_assembly(bodies) else Features.of(_defined(declared, seen), end.frame, cuts)
        names = {name for one in some for name in one.names}
        rest = {name: text for name, text in parameters.items() if name not in names}
        dimensions, unseen = matched(rest, declared.sizes, shown, declared.limits)
        unseen += _in_table_alone(parameters, dimensions, some, unseen)
        if features is not None:
            definition = Definition.of(features)
            for one in some:
                one.define(definition)
            dimensions = Supplement(definition, section, end, shown, repeated).complete(dimensions)
        shown_end = _without_hidden(end, dimensions) if any(one.stations for one in some) else end
        yield Content(section, shown_end, some, dimensions, unseen, features, repeated)


def _without_hidden(end: View, dimensions: Sequence[Dimension]) -> View:
    """Return the view along a shaft without what its sections show, but with holes on dimensioned circles."""
    pitches = [
        one.measure.value / 2
        for one in dimensions
        if (one.measure.place, one.measure.form, one.measure.points[0]) == ("end", "circle", (0.0, 0.0))
    ]
    arcs = ((curve, curve.arc) for curve in end.hidden)
    kept = [
        curve
        for curve, arc in arcs
        if arc and any(abs(hypot(*arc.centre) - pitch) < _ON_CIRCLE for pitch in pitches)
    ]
    return replace(end, hidden=kept)


def _is_upright(body: Body) -> bool:
    """Return whether a part stands with its z axis along the shaft; bolts and dowels across it do not.

    Those are dimensioned on their own sheets.
    """
    turn, _ = rigid(body.places[0])
    return bool(turn[2, 2] > 1 - 1e-9)


def _standing(seen: PartSurfaces, body: Body) -> PartSurfaces:
    """Return the surfaces of a part, moved to its place if it is round about an axis away from the shaft."""
    turn, shift = rigid(body.places[0])
    rings = seen.about(Z)
    if len(body.places) > 1 or not rings or hypot(*shift[:2]) < max(one.diameter for one in rings):
        return seen
    return seen.moved(turn, shift)


def _in_table_alone(
    parameters: Mapping[str, str],
    dimensions: Sequence[Dimension],
    removed: Sequence[RemovedSection],
    unseen: Sequence[str],
) -> list[str]:
    """Return further parameters whose tolerances no dimension shows."""
    drawn = [*dimensions, *(one for section in removed for one in section.dimensions)]
    stated = {one.name for one in drawn if one.limits} | {*unseen}
    return [name for name in toleranced_in(parameters) if name not in stated]


def _defined(declared: DrawingDeclaration, seen: Mapping[str, PartSurfaces]) -> list[Surface]:
    """Return the surfaces of the parts that carry parameters; the other parts equal or mirror these."""
    carriers = {
        part
        for size in declared.sizes.values()
        for place in size.places
        for part, _ in (*place.first, *place.second)
    }
    return [s for name, one in seen.items() if name in carriers or not carriers for s in one.surfaces]

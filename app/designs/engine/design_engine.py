"""A design as a function of N rows: built and checked once, then calculated in array calls.

A row is one set of values for some parameters and inputs of the design. All values are in SI; arrays have the
row as first axis and the points of a curve as last axis. Each step has one level for all rows of a call, so
that a change of level causes no jump in a column. The engine calculates only what the requested values depend
on. Between calls it keeps only values that are equal for all rows.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.analyses import measured_unit
from app.designs.document import Document
from app.designs.engine.levels import LevelChoice
from app.designs.engine.needs import is_member, solids_in_the_way
from app.designs.engine.places import Ranks, checked_rows, place_faults, with_places
from app.designs.engine.refusals import Refusal
from app.designs.engine.row_design import MOST_ROWS, Levels, RowDesign, Rows, Targets
from app.designs.engine.table import Table
from app.designs.engine.verdicts import JudgedColumn
from app.designs.graph import build_graph, raise_if
from app.designs.network import Graph, Subject, subjects
from app.pool.cost import array_seconds
from app.reference import Reference
from templates.core.arrays import Array
from templates.core.errors import unknown_names
from templates.core.units.quantity import read_any
from templates.core.units.units import Value

__all__ = ["MOST_ROWS", "DesignEngine", "JudgedColumn", "Refusal", "Rows", "Table"]


@dataclass(frozen=True)
class DesignEngine:
    """A design in which some parameters and inputs vary from row to row.

    Attributes
    ----------
    design
        The checked design, with a placeholder value at every varied place.
    written
        The design as its user wrote it.
    """

    design: RowDesign
    written: RowDesign

    @property
    def varied(self) -> frozenset[Reference]:
        """Return the names whose values the rows provide."""
        return self.design.varied

    @property
    def graph(self) -> Graph:
        """Return the network of the design, with a placeholder value at every varied place."""
        return self.design.graph

    @classmethod
    def of(
        cls,
        document: Document,
        catalogues: Catalogues,
        varied: Collection[Reference],
        *,
        wanted: Collection[Reference] | None = None,
        criteria: Collection[str] = (),
        measured: Mapping[Reference, float] | None = None,
        pending: bool = False,
        set_aside: Collection[Reference] = (),
    ) -> DesignEngine:
        """Return an engine for a design whose places `varied` differ from row to row.

        Parameters
        ----------
        document
            The design.
        catalogues
            Its templates and models.
        varied
            Parameters, inputs of steps, parameters of models; also measurements of solids if the rows provide
            them.
        wanted
            The values that will be requested; if given, other parts of the design are not checked.
        criteria
            The criteria that will be judged, besides the requested values.
        measured
            Known measurements of solids, including those of iterations [SI].
        pending
            If true, values that depend on a missing solid are NaN; otherwise they are refused.
        set_aside
            Varied places that a relation sets in the document; the values of the rows replace the relation.

        Raises
        ------
        InvalidInputs
            If the design has faults, or if places cannot vary. The error lists all of them; those of places
            have the codes `unknown_name`, `not_a_number`, `follows_from`, `not_varied`, `no_relation`,
            `needs_solids` or `shape`.
        """
        written, faults = build_graph(document, catalogues)
        raise_if(faults)
        raise_if(list(place_faults(written, varied, set_aside)))
        graph, faults = build_graph(with_places(document, written, varied), catalogues)
        raise_if(faults)
        constants = dict(measured or {})
        design = RowDesign(graph, frozenset(varied), constants)
        judged = [subject for name, subject in subjects(graph).items() if name in criteria]
        due = design.needs(Targets.of(wanted if wanted is not None else _all_used(graph), judged))
        measures = {
            reference for reference in due.waiting | constants.keys() if reference not in design.varied
        }
        raise_if([] if pending else solids_in_the_way(graph, measures, design.moving))
        steps = [name for name, block in graph.blocks.items() if not block.is_model]
        checked = [name for name in steps if wanted is None or name in due.members]
        raise_if(list(Ranks(graph, design.moving).faults(checked)))
        return cls(design, RowDesign(written, frozenset(), constants))

    def __call__(
        self,
        rows: Rows,
        wanted: Collection[Reference],
        *,
        levels: Levels | None = None,
        judge: bool = False,
        criteria: Collection[str] | None = None,
        chunk: int = MOST_ROWS,
    ) -> Table:
        """Return the requested values of all rows, and the verdicts of criteria.

        Parameters
        ----------
        rows
            A column for every varied place.
        wanted
            Parameters, inputs and outputs of steps, parameters of models, known measurements.
        levels
            Levels by step; a step not named here uses the level or tolerance of the design, otherwise the
            starting level of its template.
        judge
            Whether the result includes the numbers behind each verdict; this judges all criteria unless
            `criteria` names some. Errors are propagated through relations at both ends of their bands, as for
            a single design.
        criteria
            The criteria whose verdicts are requested.
        chunk
            The largest number of rows in one array call; fewer if curves or a level require it
            (`rows_at_once`).

        Raises
        ------
        InvalidInputs
            If columns or names are wrong; never because of the values in a row.
        """
        raise_if(list(self.design.faults(wanted, levels or {})))
        count, given = self.checked(rows)
        judged = self.subjects(self.criteria() if judge and criteria is None else criteria or ())
        asked = Targets.of(wanted, judged.values())

        def table(pinned: Levels) -> Table:
            chosen = LevelChoice(self.design, given, count, asked).of_tolerances(pinned)
            result = Table.of(count, wanted)
            for start, part in self.design.passes(given, count, asked, chosen, chunk):
                result.add(start, part, wanted)
                result.judge(start, part, judged, with_columns=judge)
            return result

        return self.design.settled(table, levels or {})

    def levels_for(
        self,
        rows: Rows,
        wanted: Collection[Reference],
        tolerance: float,
        share: float = 1.0,
        *,
        criteria: Collection[str] = (),
    ) -> dict[str, str | None]:
        """Return one level for each step: the cheapest whose stated error is within the tolerance.

        The error must be within the tolerance in a `share` of the rows that have values. A step for which the
        design sets a level keeps it. A step that states errors for too few rows uses its starting level. For
        a step without levels the result is None.
        """
        raise_if(list(self.design.faults(wanted, {})))
        count, given = self.checked(rows)
        choice = LevelChoice(self.design, given, count, self._wanted(wanted, criteria))
        return self.design.settled(lambda starts: choice.within(tolerance, share, starts), {})

    def seconds(
        self,
        count: int,
        wanted: Collection[Reference],
        levels: Levels,
        *,
        criteria: Collection[str] = (),
        by_tables: bool = False,
    ) -> float:
        """Estimate the time of a call for this number of rows [s].

        The estimate uses the processor time of the last similar call with enough rows. Before such a call it
        uses the cost tables of the levels, which give an order of magnitude and ignore heat balances. With
        `by_tables` it always uses the tables, so that equal requests give equal answers in any process.
        """
        asked, seconds = self._wanted(wanted, criteria), 0.0
        if not by_tables and (pace := self.design.pace(asked, levels)) is not None:
            return count * pace
        due, places = self.design.needs(asked), max(self.design.sizes(asked).values(), default=1)
        calls = -(-count // self.design.rows_at_once(asked, levels))
        for block in self.design.steps(asked):
            level = levels.get(block.name) or block.level or block.cls.default_level or None
            points, times = (count, calls) if block in self.design.moving else (1, 1)
            seconds += array_seconds(block.cls, level, points, due.outputs(block), times, places)
        return seconds

    def rows_at_once(
        self,
        wanted: Collection[Reference],
        levels: Levels,
        chunk: int = MOST_ROWS,
        *,
        criteria: Collection[str] = (),
    ) -> int:
        """Return the number of rows in one array call, at most `chunk`."""
        return self.design.rows_at_once(self._wanted(wanted, criteria), levels, chunk)

    def criteria(self) -> list[str]:
        """Return the criteria of a design of one row, except those whose outputs are not computed."""
        return [name for name, one in subjects(self.graph).items() if one.is_due(self.graph)]

    def unit(self, reference: Reference) -> str:
        """Return the declared unit of an input, output or measurement; for a parameter the typed unit."""
        if cell := self.graph.parameters.get(str(reference)):
            typed = None if cell.relations else read_any(cell.raw).unit
            return typed or self.graph.kinds[str(reference)].unit
        raise_if(list(self.design.faults([reference], {})))
        is_inside = is_member(self.graph, reference)
        return self.graph.unit_of(reference) if is_inside else measured_unit(reference)

    def accepted(self, reference: Reference) -> str:
        """Return the unit that determines in which units a user may type a value for a name."""
        is_inside = str(reference) not in self.graph.parameters and is_member(self.graph, reference)
        return self.graph.accepted(reference) if is_inside else self.unit(reference)

    def nominal(self, reference: Reference) -> Value:
        """Return the value [SI] of a name in the document.

        It is NaN if there is none, or if it depends on a missing solid.
        """
        raise_if(list(self.design.faults([reference], {})))
        return self.written.nominal(Targets.of([reference]), {}).column(reference).value

    def nominal_value(self, reference: Reference) -> float:
        """Return the single value [SI] of a name in the document; NaN if there is none, or several."""
        value = np.asarray(self.nominal(reference), dtype=float)
        return float(value) if value.ndim == 0 else float("nan")

    def checked(self, rows: Rows, levels: Levels | None = None) -> tuple[int, dict[Reference, Array]]:
        """Return the number of rows, and their columns as arrays.

        Raises
        ------
        InvalidInputs
            If columns are missing, too many, of different lengths or of the wrong shape, or a level is
            unknown.
        """
        raise_if(list(self.design.faults((), levels or {})))
        return checked_rows(self.graph, self.varied, rows)

    def subjects(self, criteria: Collection[str]) -> dict[str, Subject]:
        """Return criteria by their names.

        Raises
        ------
        InvalidInputs
            If the design has no criterion with one of the names.
        """
        by_name = subjects(self.graph)
        unknown = (name for name in criteria if name not in by_name)
        raise_if([fault.within("criteria") for fault in unknown_names(unknown, by_name, "criterion")])
        return {name: by_name[name] for name in criteria}

    def _wanted(self, wanted: Collection[Reference], criteria: Collection[str]) -> Targets:
        return Targets.of(wanted, self.subjects(criteria).values())


def _all_used(graph: Graph) -> list[Reference]:
    """Return all references that relations use."""
    return [reference for cell in graph.cells() for reference in cell.uses.values()]

"""A request read and checked against its design: places, requirements, engines and levels."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Literal

import numpy as np

from app.answers.bodies import AnswerIn
from app.answers.columns import Chosen, Levels, LevelTally, RequestColumns
from app.answers.places import FreePlace, PlaceReader, choice_of, form_faults
from app.answers.requirements import Requirements, named, requirements
from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.design_engine import DesignEngine
from app.designs.engine.row_design import Targets
from app.designs.graph import Graph, build_graph, raise_if
from app.designs.network import Block, subjects
from app.designs.overrides import WITH, changed
from app.designs.variants.table import applied, is_place, places
from app.reference import Reference
from app.studies.methods.answers import Held, Objective, Problem
from app.studies.methods.points import sobol_sequence
from app.studies.methods.space import Space
from templates.core.criteria.comparison import NOT_CHECKED
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_names
from templates.core.units.quantity import read_any

CONFIRMED_SECONDS = 30.0
"""Estimated time of a row at the finest levels above which the answer is confirmed at cheaper ones [s]."""
AFFORDABLE_TOLERANCE = 0.01
MOST_COMBINATIONS = 500
"""Largest number of combinations of options; each is a design of its own."""
PROBED = 8  # rows from which levels are chosen


@dataclass(frozen=True)
class Request:
    """A request, read and checked against its design."""

    written: Document
    catalogues: Catalogues
    body: AnswerIn

    @cached_property
    def asked(self) -> Requirements:
        """Return the requirements, and the document that has them as criteria."""
        raise_if(list(body_faults(self.body)))
        document = self.written
        if self.body.others:
            document = changed(document, self.catalogues, self.body.others, "")
        return requirements(self.body, document)

    @property
    def document(self) -> Document:
        """Return the document with the requirements as criteria."""
        return self.asked.document

    @cached_property
    def graph(self) -> Graph:
        """Return the network of the document."""
        graph, faults = build_graph(self.document, self.catalogues)
        raise_if([self.asked.place_of(fault) for fault in faults])
        return graph

    @cached_property
    def _choices(self) -> list[str]:
        return [name for name in self.body.free if choice_of(self.graph, name)]

    @cached_property
    def free(self) -> list[FreePlace]:
        """Return the free places."""
        unknown = [name for name in self.body.free if not is_place(self.graph, name)]
        faults = unknown_names(unknown, list(places(self.graph)), "place")
        for name, one in self.body.free.items():
            if name not in unknown:
                faults += form_faults(name, one, is_choice=name in self._choices)
        raise_if([fault.within("free") for fault in faults])
        engine = self.engine(())
        if self.objective is not None:
            raise_if([fault.within(self.sense) for fault in engine.design.faults([self.objective], {})])
        free = PlaceReader(self.graph, engine.accepted, engine.nominal_value).read(self.body.free)
        count = int(np.prod([len(place.options) or 1 for place in free]))
        if count > MOST_COMBINATIONS:
            detail = f"the options have {count} combinations; at most {MOST_COMBINATIONS} are tried"
            raise InvalidInputs([Fault("free", "too_many", f"{detail}: name fewer options")])
        return free

    @cached_property
    def _engines(self) -> dict[tuple[Chosen, tuple[str, ...]], DesignEngine]:
        return {}

    def engine(self, required: Collection[str], chosen: Chosen = ()) -> DesignEngine:
        """Return the engine of the design with some options, which judges some criteria."""
        key = chosen, tuple(required)
        if key not in self._engines:
            document = self._with_options(chosen) if chosen else self.document
            self._engines[key] = self._engine(document, required)
        return self._engines[key]

    def _engine(self, document: Document, required: Collection[str]) -> DesignEngine:
        numbers = [Reference.parse(name) for name in self.body.free if name not in self._choices]
        try:
            return DesignEngine.of(
                document,
                self.catalogues,
                numbers,
                wanted=[self.objective] if self.objective else [],
                criteria=required,
                set_aside=[Reference.parse(name) for name in self.body.set_aside],
            )
        except InvalidInputs as error:
            raise InvalidInputs(map(self._with_remedy, error.faults)) from None

    def _with_remedy(self, fault: Fault) -> Fault:
        fault = self.asked.place_of(fault)
        if fault.name in self.body.free:
            more = "; or name it in `set_aside`" if fault.code == "follows_from" else ""
            return Fault(f"free.{fault.name}", fault.code, f"{fault.detail}{more}", fault.also)
        return fault

    @property
    def sense(self) -> Literal["minimise", "maximise"]:
        """Return the direction in which the objective is better."""
        return "maximise" if self.body.maximise else "minimise"

    @cached_property
    def objective(self) -> Reference | None:
        """Return the output to minimise or maximise."""
        name = self.body.minimise or self.body.maximise
        return Reference.parse(name) if name else None

    @cached_property
    def required(self) -> list[str]:
        """Return the required criteria."""
        names = named(self.asked, self.graph, self.engine(()).criteria())
        if self.asked.names is None:
            names = self._judgeable(names)
        if not names:
            detail = (
                "no criterion of the design can be judged; name a requirement, such as "
                "`film.minimum_film_thickness >= 3 um`"
            )
            raise InvalidInputs([Fault("require", "missing", detail)])
        return names

    def _judgeable(self, names: list[str]) -> list[str]:
        """Return the criteria that can be judged in the middle of the free places."""
        columns = self._columns(names)
        middle = np.full((1, len(self.free)), 0.5)
        rows = columns.problem.space.at(columns.problem.space.snapped(middle))
        codes = columns.at(LevelTally(self.coarse(names)))(rows).codes(columns.problem)
        return [name for name, code in zip(names, codes, strict=True) if code != NOT_CHECKED]

    @cached_property
    def columns(self) -> RequestColumns:
        """Return the objective and the requirements as functions of rows."""
        return self._columns(self.required)

    def _columns(self, names: list[str]) -> RequestColumns:
        every = subjects(self.graph)
        held = tuple(Held(name, every[name].criterion.sign) for name in names)
        goal = Objective(str(self.objective or "objective"), self.sense)
        problem = Problem(Space(tuple(place.variable for place in self.free)), (goal,), held)
        engine_of = partial(self.engine, names)
        return RequestColumns(engine_of, self.free, names, self.asked.targets, self.objective, problem)

    def _with_options(self, chosen: Chosen) -> Document:
        places = [place for place in self.free if place.options]
        options = {place.name: place.options[n] for place, n in zip(places, chosen, strict=True)}
        return applied(self.document, options) if options else self.document

    def coarse(self, names: list[str]) -> Levels:
        """Return the levels of the search: the cheaper of the default level and that of the design."""
        levels: dict[str, str | None] = {}
        for block in self._steps(names):
            ladder = list(block.cls.levels)
            own = [one for one in (block.cls.default_level, block.level) if one in ladder]
            levels[block.name] = min(own, key=ladder.index) if own else None
        return levels

    @cached_property
    def levels(self) -> tuple[Levels, Levels]:
        """Return the levels of the search and those of the verdicts; none of the first is finer."""
        coarse, fine = self.coarse(self.required), self._fine()
        ladders = {block.name: list(block.cls.levels) for block in self._steps(self.required)}
        return {
            name: min(
                (level for level in (coarse[name], fine[name]) if level), key=ladder.index, default=None
            )
            for name, ladder in ladders.items()
        }, fine

    def _fine(self) -> Levels:
        """Return the levels that give the verdicts: by the tolerance, else the finest that time allows."""
        steps = self._steps(self.required)
        if self.body.tolerance is not None:
            return self._within(self.body.tolerance)
        finest = {one.name: one.level or (one.cls.levels or (None,))[-1] for one in steps}
        engine, wanted = (
            self.engine(self.required),
            [self.objective] if self.objective else [],
        )
        seconds = engine.seconds(1, wanted, finest, criteria=self.required)
        return finest if seconds <= CONFIRMED_SECONDS else self._within(AFFORDABLE_TOLERANCE)

    def _within(self, tolerance: float) -> Levels:
        columns = self.columns
        unit = sobol_sequence(len(self.free), 1, 0, PROBED)
        rows = columns.problem.space.at(columns.problem.space.snapped(unit))
        inputs = columns.inputs(rows)[:, 0]
        engine = columns.engine_of(columns.first)
        values = {self.free[n].reference: inputs[:, k] for k, n in enumerate(columns.numbers)}
        wanted = [self.objective] if self.objective else []
        return engine.levels_for(values, wanted, tolerance, criteria=self.required)

    def _steps(self, names: list[str]) -> list[Block]:
        """Return the steps that the requirements and the objective need."""
        engine = self.engine(names)
        wanted = [self.objective] if self.objective else []
        return engine.design.steps(Targets.of(wanted, engine.subjects(names).values()))


def body_faults(body: AnswerIn) -> Iterator[Fault]:
    """Yield the faults in a request that show without its design."""
    if not body.free:
        detail = (
            'name the places to choose, such as `{"film.bearing_width": {"between": ["15 mm", "25 mm"]}}`'
        )
        yield Fault("free", "missing", detail)
    if body.minimise and body.maximise:
        yield Fault("maximise", "contradiction", "give one objective: `minimise` or `maximise`")
    if body.require == [] and not body.targets:
        yield Fault(
            "require", "missing", "name a requirement, or omit `require` for all criteria of the design"
        )
    for name, raw in body.others.items():
        try:
            if not isinstance(raw, str):  # a text may be the word of a choice
                read_any(raw)
        except FaultyText as error:
            yield error.fault(f"{WITH}.{name}")
        if name in body.free:
            yield Fault(f"{WITH}.{name}", "conflict", f"{name} is free; omit its value")
    for name in body.set_aside:
        if name not in body.free:
            yield Fault("set_aside", "not_varied", f"{name} is not free; name it in `free` too")

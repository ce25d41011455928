"""The wizard's engine as one design document: its fields, and the proposed values where a field is empty.

The design has one parameter for each value. A proposed value is listed under `assumed`, with its source, as
long as it stays unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TypeVar

from pydantic import JsonValue

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.gallery.engine_bearings import SHELL, Bearing, bearings, film_step, heat_step
from app.designs.graph import build_graph
from app.presentation import numbers
from app.presentation.units import System, shown_unit
from app.web.engine_bearings import ratios
from app.web.engine_bearings.fields import QUANTITIES, TYPING, Typing, firing_order, oil_grade, viscosity
from app.web.engine_bearings.gas import Diagram
from app.web.engine_bearings.layouts import LAYOUTS, Layout
from app.web.engine_bearings.ratios import Ratio
from templates.core.errors import FaultyText
from templates.core.units.relation import is_relation
from templates.core.units.units import unit

PETROL, DIAGRAM = "petrol", "diagram"
"""Choices of the field `gas`; the second is also the name of the file's field."""
ORDER = "firing_order"
_OUTPUTS: list[JsonValue] = [
    "layout", "crankpin_angles", "ignition_angles", "mean_torque", "mean_power", "crankpin_load_max",
    "main_load_max", "elastic_main_load_max", "elastic_difference", "governing_elastic_main",
]  # fmt: skip
_MECHANISM = (
    "speed", "bore", "stroke", "rod_length", "rod_mass", "rod_centre", "piston_mass", ORDER,
    "journal_diameter", "crankpin_diameter", "crankpin_length", "web_thickness", "web_width",
    "support_stiffness",
)  # fmt: skip
"""Inputs of the engine that are parameters of the design with the same name."""
_NAMES = re.compile(r"[a-z][a-z_]{2,}")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Proposal:
    """The design document of an engine.

    Parameters
    ----------
    document
        The design, as `POST /designs` accepts it; empty if there are faults.
    faults
        What is wrong, by field.
    parameters
        The values read so far, proposals included.
    offers
        The proposals for this layout; empty if none is chosen.
    """

    document: dict[str, JsonValue]
    faults: dict[str, str]
    parameters: dict[str, JsonValue] = field(default_factory=dict)
    offers: dict[str, Ratio] = field(default_factory=dict)


@dataclass(frozen=True)
class _Engine:
    """The values of an engine: texts of parameters, those that are assumed, and the gas and oil."""

    layout: Layout
    parameters: dict[str, JsonValue]
    offers: dict[str, Ratio]
    cycle: dict[str, JsonValue]  # inputs of the engine that describe its gas
    grade: str | None  # of the oil; None if its viscosity is given


class _Reader:
    """Reads the fields and collects what is wrong with them."""

    def __init__(self, typed: Mapping[str, str], typing: Typing) -> None:
        self.typing = typing
        self.typed = {name: text.strip() for name, text in typed.items()}
        self.faults: dict[str, str] = {}

    def text(self, name: str) -> str:
        """Return the text of a field."""
        return self.typed.get(name, "")

    def given(self, name: str, words: str, read: Callable[[str], Value]) -> Value | None:
        """Return the value of a field without a proposal; None, with a fault, if it is empty or wrong."""
        if not self.text(name):
            self.faults[name] = f"give the {words}"
            return None
        return self.read(name, read)

    def read(self, name: str, read: Callable[[str], Value]) -> Value | None:
        """Return the value of a field; None, with a fault, if it is wrong."""
        try:
            return read(self.text(name))
        except FaultyText as error:
            self.faults[name] = str(error)
            return None


def proposed(layout: Layout, gas: str, *, has_grade: bool = True) -> dict[str, Ratio]:
    """Return the proposed values of an engine by the names of their fields."""
    return {
        ORDER: ratios.of_order(layout.order),
        **ratios.of_crankshaft(layout.family),
        **ratios.of_bearings(layout.rods_per_throw),
        **ratios.of_supply(has_temperature=has_grade),
        **ratios.of_gas(gas),
    }


def propose(typed: Mapping[str, str], diagram: Diagram | None = None, typing: Typing = TYPING) -> Proposal:
    """Return the design of the engine that the fields describe.

    Parameters
    ----------
    typed
        The texts of the fields by name: `name`, `layout`, `gas`, `oil`, those of `QUANTITIES`, and those of
        proposed values, which may be empty.
    diagram
        The indicator diagram, if `gas` is `diagram`.
    typing
        The units of bare numbers, and the meaning of a comma.
    """
    reader = _Reader(typed, typing)
    engine = _engine(reader, diagram)
    if engine is None:
        return Proposal({}, reader.faults)
    name = reader.text("name") or f"Bearings of an engine: {engine.layout.title}"
    document = {} if reader.faults else _document(name, engine)
    return Proposal(document, reader.faults, engine.parameters, engine.offers)


def _engine(reader: _Reader, diagram: Diagram | None) -> _Engine | None:
    """Return the values of the engine; None if no layout is chosen."""
    layout, gas = LAYOUTS.get(reader.text("layout")), reader.text("gas") or PETROL
    if layout is None:
        reader.faults["layout"] = "choose the layout of the engine"
    given: dict[str, JsonValue] = {
        name: reader.given(name, asked.words, partial(reader.typing.quantity, unit=asked.unit))
        for name, asked in QUANTITIES.items()
    }
    grade = oil_grade(reader.text("oil"))
    if grade is None:
        given["oil_viscosity"] = reader.given("oil", "oil", partial(viscosity, typing=reader.typing))
    if gas == DIAGRAM and diagram is None:
        reader.faults[DIAGRAM] = "choose the file of the indicator diagram, or paste its table"
    if layout is None:
        return None
    offers = proposed(layout, gas, has_grade=grade is not None)
    if diagram is not None:
        offers |= ratios.of_crankcase(is_gauge=diagram.is_gauge)
    chosen = {name: _chosen(reader, name, ratio, layout) for name, ratio in offers.items()}
    parameters = {**given, **chosen, "bearing": "1"}
    return _Engine(layout, parameters, offers, _cycle(gas, diagram, offers), grade)


def _chosen(reader: _Reader, name: str, ratio: Ratio, layout: Layout) -> JsonValue:
    """Return the value of a field with a proposal: the proposal if the field is empty."""
    if not reader.text(name):
        return list(layout.order) if name == ORDER else ratio.relation
    if name == ORDER:
        return list(reader.read(name, lambda text: firing_order(text, layout.cylinders)) or ())
    return reader.read(name, lambda text: reader.typing.quantity(text, ratio.unit))


def _document(name: str, engine: _Engine) -> dict[str, JsonValue]:
    main = Bearing("= main_width", "= main_clearance")
    big_end = Bearing("= big_end_width", "= big_end_clearance")
    film = film_step(
        main,
        dynamic_viscosity="= heat.effective_viscosity" if engine.grade else "= oil_viscosity",
        permissible_film="= permissible_film",
        groove_width="= groove_width",
        supply_pressure="= supply_pressure",
    )
    heat = {"heat": heat_step(engine.grade, "= supply_temperature")} if engine.grade else {}
    return {
        "name": name,
        "parameters": engine.parameters,
        "steps": {"engine": _engine_step(engine), **heat, "film": film},
        "models": {"shell": SHELL},
        "variants": bearings(engine.layout.mains, engine.layout.banks, big_end),
        "assumed": _assumed(engine),
    }


def _assumed(engine: _Engine) -> dict[str, JsonValue]:
    """Return the parameters that have their proposed value, each with this value and its source."""
    return {
        name: {"value": engine.parameters[name], "source": ratio.source}
        for name, ratio in engine.offers.items()
        if engine.parameters[name] == (list(engine.layout.order) if name == ORDER else ratio.relation)
    }


def _engine_step(engine: _Engine) -> dict[str, JsonValue]:
    layout = engine.layout
    inputs: dict[str, JsonValue] = {name: f"= {name}" for name in _MECHANISM}
    share = f" / {layout.rods_per_throw}" if layout.rods_per_throw > 1 else ""
    inputs |= {"strokes": 4, "crank_angle_step": "5 deg", "crank_unbalance": f"= crank_unbalance{share}"}
    return {
        "template": "engine",
        "version": 1,
        "inputs": {**inputs, **_positions(layout), **_banks(layout), **engine.cycle},
        "outputs": _OUTPUTS,
    }


def _positions(layout: Layout) -> dict[str, JsonValue]:
    """Return the positions along the shaft; the two rods on a throw stand side by side."""
    beside = ["- crankpin_length / 4", "+ crankpin_length / 4"] if layout.rods_per_throw == 2 else [""]
    cylinders = [
        f"= {throw + 0.5} * throw_pitch {side}".strip() for throw in range(layout.throws) for side in beside
    ]
    return {
        "cylinder_positions": list[JsonValue](cylinders),
        "main_positions": [f"= {main} * throw_pitch" for main in range(layout.mains)],
    }


def _banks(layout: Layout) -> dict[str, JsonValue]:
    """Return the inputs of an engine with two banks; empty for one row of cylinders."""
    if not layout.bank:
        return {}
    throws: list[JsonValue] = [n // layout.rods_per_throw + 1 for n in range(layout.cylinders)]
    pins: JsonValue = {"value": list[JsonValue](layout.banks[:1] * layout.cylinders), "unit": "deg"}
    return {
        "bank_angles": {"value": list[JsonValue](layout.banks), "unit": "deg"},
        "throws": throws,
        **({"pins_of_a_throw": "split"} if layout.is_split else {}),
        **({"pin_angles": pins} if layout.is_uneven else {}),
    }


def _cycle(gas: str, diagram: Diagram | None, offers: Mapping[str, Ratio]) -> dict[str, JsonValue]:
    """Return the inputs of the engine that describe the gas: a diagram, or an ideal cycle."""
    if diagram is None:
        cycle = {name: f"= {name}" for name in offers if offers[name].group == ratios.GAS}
        return {"gas_cycle": "four_stroke", **cycle}
    return {
        "gas_cycle": "table",
        "pressure_angle": {"value": list[JsonValue](diagram.angles), "unit": "deg"},
        "pressure": {"value": list[JsonValue](diagram.pressures), "unit": "bar"},
        "crankcase_pressure": "= crankcase_pressure",
    }


def proposed_values(
    parameters: Mapping[str, JsonValue],
    offers: Mapping[str, Ratio],
    catalogues: Catalogues,
    units: System = "si",
) -> dict[str, str]:
    """Return the value of each proposal whose relation depends on determined parameters only.

    In US units, the values of proposed quantities are returned too: they show the unit of a bare number.
    """
    determined = _determined(parameters)
    graph, faults = build_graph(Document(name="proposals", parameters=determined), catalogues)
    if faults:
        return {}
    result = calculate(graph, lambda *_: None, lambda *_: None)
    units_of = {name: shown_unit(offer.unit, units) for name, offer in offers.items()}
    return {
        name: _written(float(result.values[name].value), shown)
        for name, shown in units_of.items()
        if name in result.values and (is_relation(determined.get(name)) or shown != offers[name].unit)
    }


def _written(value: float, shown: str) -> str:
    """Return a value in SI as the page shows it in a unit."""
    return f"= {numbers.plain(float(unit(shown).from_si(value)))} {numbers.unit(shown)}"


def _determined(parameters: Mapping[str, JsonValue]) -> dict[str, JsonValue]:
    """Return the quantities, and the relations between them."""
    determined: dict[str, JsonValue] = {
        name: value for name, value in parameters.items() if value and not is_relation(value)
    }
    waiting = {name: str(value) for name, value in parameters.items() if is_relation(value)}
    for _ in parameters:
        ready = {n: text for n, text in waiting.items() if _of(text, parameters) <= determined.keys()}
        determined |= ready
        waiting = {name: text for name, text in waiting.items() if name not in ready}
    return determined


def _of(relation: str, parameters: Mapping[str, JsonValue]) -> set[str]:
    return {name for name in _NAMES.findall(relation) if name in parameters}

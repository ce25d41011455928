"""Finite-element analyses of a solid, and the cache key of each result.

The REST interface and relations of designs use them. `cad.analysis.kinds` lists the analyses; it does not
import the kernel that computes them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Container, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version

from pydantic import ConfigDict, Field

from app.plain import JsonObject, Raw
from app.schemas.bounds import Bounded
from app.solids.outputs import Outputs, Refinement, StoredOutput
from cad.analysis.kinds import (
    BORE_COMPLIANCE,
    BOUNDARIES,
    CHAIN,
    DEFAULT_LEVEL,
    KINDS,
    LEVELS,
    LISTS,
    STRESSES,
    SURFACE,
    TABLES,
    UNIT_LOADS,
    Boundary,
    Level,
)
from cad.assemblies import AssemblyModel
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText
from templates.core.units.quantity import read

LARGEST_LOAD = 1e12  # [N m]

ON_REQUEST = STRESSES | {SURFACE}
"""Outputs that are computed only if a request names them."""

WITHOUT_SURFACE = (UNIT_LOADS, CHAIN, BORE_COMPLIANCE)
"""Kinds whose solid has no picture."""

RECIPE = 8
"""Version of the analyses; increase it whenever an analysis of the same solid gives a different answer."""

_MADE_BY = f"recipe {RECIPE}, ngsolve {version('ngsolve')}"


class Options(Bounded):
    """Supports of a solid in an analysis, and the accuracy of the answer."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    boundary: Boundary = Field(
        "free_end", description="the loaded end: `free_end`, or kept on the axis, `guided_end`"
    )
    level: Level | None = Field(None, description="how fine the mesh is; `default` if not given")
    tolerance: float | None = Field(
        None, gt=0, le=1, description="the largest relative error wanted, instead of a level"
    )
    load: str | JsonObject | None = Field(
        None,
        description="the torque or bending moment under which stress is given; 1 N*m if not given",
        examples=["500 N*m"],
    )


@dataclass(frozen=True)
class Question:
    """A requested analysis."""

    kind: str
    boundary: Boundary
    level: Level | None
    tolerance: float | None
    load: float = 1.0  # [N m]

    def key(self, build: str) -> str:
        """Return the key of the answers for a build: SHA-256 of build, request, solver and recipe.

        The load is not part of it: all results are linear in the load, so they are stored for 1 N·m.
        """
        identity = [build, self.kept(), _MADE_BY]
        return hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()

    def whatever_level(self) -> Question:
        """Return the request without its level, under 1 N·m, because a stress refines its own mesh."""
        return replace(self, level=None, tolerance=None, load=1.0)

    def kept(self) -> dict[str, object]:
        """Return the request in the form that is stored with its answers; it omits the load."""
        return {name: value for name, value in asdict(self).items() if name != "load"}

    def shown(self) -> dict[str, object]:
        """Return the request in the form of a response."""
        return {**asdict(self), "load": {"value": self.load, "unit": "N*m"}}


def question(kind: str, options: Options) -> Question:
    """Return the requested analysis with these options; the defaults are the default level and 1 N·m."""
    level = options.level or (None if options.tolerance else DEFAULT_LEVEL)
    load = 1.0 if options.load is None or load_faults(options.load) else load_of(options.load)
    return Question(kind, options.boundary, level, options.tolerance, load)


def load_of(raw: Raw) -> float:
    """Return a load [N·m] that has no faults."""
    return float(read(raw, "N*m").si)


def faults(kind: str, options: Options) -> list[Fault]:
    """Return the faults of the options of a kind, except wrong types."""
    if kind in (UNIT_LOADS, BORE_COMPLIANCE):
        return [*_faults_of_tables(kind, options)]
    both = options.level is not None and options.tolerance is not None
    detail = "give either a level or a tolerance, which chooses the level"
    conflicts = [Fault("tolerance", "conflict", detail)] if both else []
    if kind == CHAIN and options.load is not None:
        detail = f"{CHAIN} answers no stress, and its other results are the same under any load: omit `load`"
        return [*conflicts, Fault("load", "not_offered", detail)]
    return conflicts + ([] if options.load is None else load_faults(options.load))


_OF_TABLES = {
    UNIT_LOADS: {
        "boundary": "has one way of holding the throw, held at one end and borne by both mains",
        "tolerance": "has no estimate of its error",
        "load": "is under 1 kN and 1 kN*m: multiply its tables",
    },
    BORE_COMPLIANCE: {
        "boundary": "has one way of holding the solid, by the top of the block or the small end",
        "tolerance": "chooses no level by a tolerance",
        "load": "is under unit pressures",
    },
}
"""For each kind of analysis with tables, the reason why it lacks an option."""


def _faults_of_tables(kind: str, options: Options) -> Iterator[Fault]:
    """Yield a fault for each option that analyses with tables do not have."""
    why = _OF_TABLES[kind]
    if options.boundary != "free_end":
        yield Fault("boundary", "not_offered", f"{kind} {why['boundary']}: omit `boundary`")
    if options.tolerance is not None:
        detail = f"{kind} {why['tolerance']}: give a level, {', '.join(LEVELS)}"
        yield Fault("tolerance", "not_offered", detail)
    if options.load is not None:
        yield Fault("load", "not_offered", f"{kind} {why['load']}: omit `load`")


def load_faults(raw: Raw) -> list[Fault]:
    """Return the faults of a load."""
    try:
        load = read(raw, "N*m").si
    except FaultyText as error:
        return [error.fault("load")]
    if isinstance(load, float) and 0 < load <= LARGEST_LOAD:
        return []
    detail = f'load is one torque or moment > 0 N*m and ≤ {LARGEST_LOAD:g} N*m, such as "500 N*m"'
    return [Fault("load", "out_of_range", detail)]


def under_load(asked: Question, outputs: Mapping[str, StoredOutput]) -> Outputs:
    """Return outputs under the requested load, computed from those under 1 N·m.

    Stress is proportional to the load.
    """
    return {
        name: _times(asked.load, output) if name in STRESSES else output for name, output in outputs.items()
    }


def _times(load: float, stress: StoredOutput) -> StoredOutput:
    value = stress["value"]
    scaled = value * load if isinstance(value, float | int) else None
    steps: list[Refinement] = [{**step, "value": step["value"] * load} for step in stress["convergence"]]
    return {**stress, "value": scaled, "convergence": steps}


def offered(kind: str) -> tuple[str, ...]:
    """Return all outputs that an analysis of this kind can compute."""
    return (*KINDS[kind],) if kind in WITHOUT_SURFACE else (*KINDS[kind], SURFACE)


def in_order(kind: str, outputs: Container[str]) -> tuple[str, ...]:
    """Return outputs of a kind in a fixed order, each only once."""
    return tuple(name for name in offered(kind) if name in outputs)


def no_shaft(cls: type[CadModel]) -> str | None:
    """Return the reason why solids of a model cannot be analysed as shafts; None if they can."""
    if issubclass(cls, AssemblyModel):
        return f"{cls.id} is an assembly: a finite-element analysis needs a single solid"
    if cls.shaft is not CadModel.shaft:
        return None
    return f"{cls.id} is not a shaft: it does not say by which ends it is held and loaded"


def not_offered(cls: type[CadModel], kind: str) -> Fault | None:
    """Return the reason why solids of a model do not allow this kind of analysis; None if they allow it."""
    if kind == BORE_COMPLIANCE:
        from cad.shells.bore_place import has_split_bore  # this module also draws

        if has_split_bore(cls):
            return None
        detail = f"{kind} is of a split bore, as of bearing_housing and connecting_rod; {cls.id} has none"
        return Fault("model", "no_bore", detail)
    if reason := no_shaft(cls):
        return Fault("model", "no_shaft", reason)
    if kind not in (UNIT_LOADS, CHAIN) or (kind == UNIT_LOADS and cls.is_throw()):
        return None
    from cad.cranks.chain_throw import has_throws  # this module draws, so it imports the kernel

    if has_throws(cls):
        return None
    if kind == CHAIN:
        detail = f"{CHAIN} analyses a crankshaft made of throws, such as crankshaft 1; {cls.id} is not one"
        return Fault("model", "no_throws", detail)
    detail = f"{cls.id} is not a single crank throw, from mid-journal to mid-journal, as crank_throw is"
    return Fault("model", "no_throw", f"{UNIT_LOADS} analyses a single throw: {detail}")


def what_can_be_asked(cls: type[CadModel]) -> dict[str, object]:
    """Return the kinds of analyses of a model, each with its outputs and their units."""
    return {
        kind: {
            "outputs": {name: KINDS[kind].get(name) for name in offered(kind)},
            "tables": {name: [*TABLES[name]] for name in KINDS[kind] if name in TABLES},
            "lists": [name for name in KINDS[kind] if name in LISTS],
            "boundaries": [*BOUNDARIES] if kind not in _OF_TABLES else [*BOUNDARIES[:1]],
            "levels": [*LEVELS],
            "default_level": DEFAULT_LEVEL,
        }
        for kind in KINDS
        if not not_offered(cls, kind)
    }


def warnings(asked: Question, outputs: Mapping[str, StoredOutput]) -> list[dict[str, str]]:
    """Return warnings for outputs whose error may be larger than requested."""
    wanted = asked.tolerance
    return [
        {"code": "tolerance_unmet", "name": name, "detail": _unmet(error, wanted)}
        for name, output in outputs.items()
        if wanted and (error := output["error"]) is not None and error > wanted
    ]


def _unmet(error: float, tolerance: float) -> str:
    return f"the error may be {error:.2g}, more than the {tolerance:g} asked for, and no finer mesh is tried"

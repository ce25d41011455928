"""Compare a chain of throw matrices with finite elements of the whole shaft, free and guided at all mains.

    python -m benchmarks.crank_chain [split]

The shaft extends from its first mid-main to its last, with one end held. Both methods use the same level, so
the difference is due to the chain alone: it represents sections by mean displacements, and a throw moves only
as loads at mains and pins move it. The whole shaft is the joined solids of the throws, so that mid-mains are
faces of its mesh. `series` is the stiffness of one throw with a free end, divided by the number of throws;
`series_guided` uses a throw guided at its end. `throws` is the torque per rotation of each throw in the
shaft. The rows are printed and stored in benchmarks/results/crank_chain.json.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from math import radians
from pathlib import Path
from tempfile import NamedTemporaryFile
from time import process_time
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.occ import Axis, Glue, OCCGeometry, Pnt, Z

from cad.analysis.chain import Chain
from cad.analysis.elastic import Response, System
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import make_grid
from cad.analysis.modes import torsional_mode
from cad.analysis.solid import FREE, HELD, LOADED, Solid, read_solid
from cad.analysis.throw_matrix import ThrowMatrix, matrix_on, section_loads
from cad.cranks.chain_throw import throw_step
from cad.cranks.whole import WholeShaft
from cad.models.crankshaft_v1 import Crankshaft

RESULTS = Path("benchmarks/results/crank_chain.json")
LEVEL = LEVELS[0]
GIVEN: dict[str, Any] = {
    "journal_diameter": "55 mm", "journal_length": "26 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "throw": "43 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "2.5 mm",
}  # fmt: skip
CASES = (0.0, 180.0), (0.0, 120.0, 240.0), (0.0, 180.0, 180.0, 0.0)
SPLIT_CASES = (((0.0, 120.0, 240.0), 30.0),)


@cache
def shaft(angles: tuple[float, ...], split: float = 0.0) -> WholeShaft:
    """Return the shaft with pins at these angles, split by an angle [deg]."""
    pins = {"value": list(angles), "unit": "deg"}
    if split == 0:
        return Crankshaft.from_quantities({**GIVEN, "pin_angles": pins}).drawn()
    divided = {"pin_split": {"value": split, "unit": "deg"}, "pin_length": "24 mm"}
    return Crankshaft.from_quantities({**GIVEN, "pin_angles": pins, **divided}).drawn()


@cache
def one(level: Level = LEVEL, split: float = 0.0) -> ThrowMatrix:
    """Return the matrices of the shaft's throw."""
    step, ends, pin = throw_step(shaft((0.0,), split), 0)
    solid = read_solid(step, ends, mirrors=())
    return matrix_on(make_grid(solid, level.fineness), level.order, ends, pin)


def in_series(throws: Sequence[ThrowMatrix], *, guided: bool) -> float:
    """Return the stiffness [N m/rad] of separate throws in series."""
    alone = (Chain([throw], [0.0]).stiffness(guided=guided) for throw in throws)
    return 1 / sum(1 / stiffness for stiffness in alone)


def whole(angles: Sequence[float], level: Level, split: float = 0.0) -> tuple[System, list[str]]:
    """Return a mesh of all throws joined at mid-mains, which remain faces of the mesh.

    Also return the names of the faces at the mains.
    """
    drawn = shaft(tuple(angles), split)
    pieces = []
    for k, angle in enumerate(angles):
        step, held, _ = throw_step(drawn, k)
        piece = solid_in(step)
        piece = piece.Rotate(Axis(Pnt(0, 0, 0), Z), angle).Move((0, 0, drawn.pitch * k - held.held))
        pieces.append(piece)
    glued = Glue(pieces)
    names = [HELD, *(f"main_{k}" for k in range(1, len(angles))), LOADED]
    for face in glued.faces:
        low, high = face.bounding_box
        at = [
            n
            for n, z in zip(names, drawn.mains, strict=True)
            if max(abs(low[2] - z), abs(high[2] - z)) < 1e-6
        ]
        face.name = at[0] if at else FREE
    solid = Solid(glued, "", drawn.like.journal)
    grid = make_grid(solid, level.fineness)
    _, held, _ = throw_step(drawn, 0)
    return System(grid, level.order, held.material, "torsion"), names[1:]


def solid_in(step: bytes) -> Any:
    """Return the one solid of a STEP file, as Netgen reads it."""
    with NamedTemporaryFile(suffix=".step") as file:
        file.write(step)
        file.flush()
        return next(iter(OCCGeometry(file.name).shape.solids))


def response(system: System, mains: Sequence[str]) -> Response:
    """Return the response to a unit torque at the loaded end, with the named mains held on the axis."""
    force, _ = system.loads()
    guides = []
    for name in mains:
        for field in section_loads(system, name)[:2]:
            v = system.space.TestFunction()
            guide = ng.LinearForm(system.space)
            guide += field * v.Trace() * ng.ds(name)
            guide.Assemble()
            guides.append(guide.vec)
    u = system.solve(force)
    moved = [system.solve(guide) for guide in guides]
    gram = np.array([[ng.InnerProduct(f, w) for w in moved] for f in guides]).reshape(
        len(guides), len(guides)
    )
    shown = ng.GridFunction(system.space)
    shown.vec.data = u
    if guides:
        held = np.array([ng.InnerProduct(guide, u) for guide in guides])
        for reaction, w in zip(np.linalg.solve(gram, held), moved, strict=True):
            shown.vec.data -= float(reaction) * w
    return Response(system, ng.InnerProduct(force, shown.vec), shown, tuple(guides), tuple(moved), gram)


def rotations(answer: Response, mains: Sequence[str]) -> list[float]:
    """Return the mean rotations about z of the sections at the mains [rad]."""
    system = answer.system
    return [
        float(
            ng.Integrate(
                ng.InnerProduct(section_loads(system, name)[5], answer.displacement) * ng.ds(name),
                system.grid.mesh,
            )
        )
        for name in mains
    ]


def compared(angles: Sequence[float], split: float = 0.0) -> Iterator[dict[str, Any]]:
    """Return the relative differences of the chain from the whole, free and guided."""
    throws = [one(LEVEL, split)] * len(angles)
    chain = Chain(throws, [radians(angle) for angle in angles])
    system, mains = whole(angles, LEVEL, split)
    for guided in (False, True):
        answer = response(system, mains if guided else [])
        stiffness, frequency = 1e-3 / answer.compliance, torsional_mode(answer).frequency
        between = 1e-3 / np.diff(rotations(answer, mains), prepend=0.0)
        yield {
            "pins": list(angles),
            **({"split": split} if split else {}),
            "guided": guided,
            "stiffness_of_the_whole": stiffness,
            "frequency_of_the_whole": frequency,
            "chain": chain.stiffness(guided=guided) / stiffness - 1,
            "chain_frequency": chain.frequency(guided=guided) / frequency - 1,
            "throws": (chain.throw_stiffnesses(guided=guided) / between - 1).tolist(),
            "series": in_series(throws, guided=False) / stiffness - 1,
            "series_guided": in_series(throws, guided=True) / stiffness - 1,
        }


def main() -> None:
    """Measure and store all cases; with `split` as argument, add those of split pins to the stored ones."""
    only_split = "split" in sys.argv[1:]
    kept = json.loads(RESULTS.read_text()) if only_split else {"level": LEVEL.name, "rows": []}
    rows = kept["rows"] = [row for row in kept["rows"] if "split" not in row]
    undivided = () if only_split else tuple((angles, 0.0) for angles in CASES)
    for angles, split in (*undivided, *SPLIT_CASES):
        for row in compared(angles, split):
            print(json.dumps(row), file=sys.stderr, flush=True)
            rows.append(row)
    if not only_split:
        started = process_time()
        one.__wrapped__()
        kept["seconds_of_a_throw"] = process_time() - started
    RESULTS.write_text(json.dumps(kept, indent=1) + "\n")


if __name__ == "__main__":
    main()

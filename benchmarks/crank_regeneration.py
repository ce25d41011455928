"""Cost of a crank from its parameters to a checked STEP file, against CadQuery on the same dimensions.

    python -m benchmarks.crank_regeneration

`regenerate` draws, writes STEP, reads it back, measures and checks it. Two baselines write STEP and no more:
`plain script` is the throw as a CadQuery user writes it, with Workplanes, unions, cuts and fillets on edges
that are picked; `own build` is the model's solid. All take turns in one process, after two rounds for warming
up. The table is printed and kept in benchmarks/results/crank.json: median times and ratios of medians.
"""

import json
import os
import tempfile
from collections.abc import Callable
from datetime import UTC, datetime
from math import cos, sin
from pathlib import Path
from statistics import median, quantiles
from time import perf_counter
from typing import Any

import cadquery as cq

from cad.catalogue import models
from cad.cranks.throw import Throw
from cad.regenerate import regenerate

RESULTS = Path("benchmarks/results/crank.json")
ROUNDS, WARMING = 20, 2
AIM = 300.0  # ms, for a warm regeneration of a crank throw

THROW = {
    "journal_diameter": "55 mm", "journal_length": "40 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "throw": "42 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "3 mm",
}  # fmt: skip
BORED = {**THROW, "journal_bore": "16 mm", "pin_bore": "14 mm", "oil_drilling_diameter": "5 mm"}
CASES: dict[str, tuple[str, dict[str, str]]] = {
    "throw with fillets": ("crank_throw", THROW),
    "throw, bored and drilled": ("crank_throw", BORED),
    "throw, everything": (
        "crank_throw",
        {**BORED, "counterweight_radius": "75 mm", "face_inclination": "8 deg"},
    ),
    "shaft": ("crankshaft", THROW),
}


def own_build(throw: Throw, file: Path) -> float:
    """The model's solid, written by CadQuery; its volume [mm³]."""
    return _exported(cq.Workplane(throw.solid()), file)


def plain_script(t: Throw, file: Path) -> float:
    """The throw as a script draws it; a counterweight is a wedge of a disc, an inclination a cut."""
    o, top = t.outline, t.journal_end
    slot = cq.Workplane("XY").workplane(offset=t.inner).center(o.throw / 2, 0)
    web = slot.slot2D(o.throw + 2 * o.half_width, 2 * o.half_width).extrude(t.web_thickness)
    if o.counterweight > 0:
        disc = cq.Solid.makeCylinder(
            o.counterweight, t.web_thickness, cq.Vector(0, 0, t.inner), cq.Vector(0, 0, 1), 360
        )  # fmt: skip
        web = web.union(cq.Workplane(disc).intersect(_sector(t)))
    if t.inclination > 0:
        web = web.cut(cq.Workplane(t._wedge()))
    body = web.union(web.mirror("XY"))
    body = body.union(_cylinder(t.pin, -t.inner, t.inner, o.throw))
    for low, high in ((t.outer, top), (-top, -t.outer)):
        body = body.union(_cylinder(t.journal, low, high, 0.0))
    for end, side in ((t.front, -1), (t.rear, 1)):
        if end:
            low, high = sorted((side * top, side * (top + end.length)))
            body = body.union(_cylinder(end.radius, low, high, 0.0))
    feet = [
        (t.pin, o.throw, t.inner),
        (t.pin, o.throw, -t.inner),
        (t.journal, 0.0, t.outer),
        (t.journal, 0.0, -t.outer),
    ]
    body = body.newObject([edge for edge in body.edges("%CIRCLE").vals() if _is_foot(edge, feet)]).fillet(
        t.fillet
    )
    if t.journal_bore > 0:
        body = body.cut(_cylinder(t.journal_bore, -2 * top, 2 * top, 0.0))
    if t.pin_bore > 0:
        body = body.cut(_cylinder(t.pin_bore, -t.outer - 1, t.outer + 1, o.throw))
    if t.drilling > 0:
        body = body.cut(cq.Workplane(t._drill()))
    return _exported(body, file)


def _cylinder(radius: float, low: float, high: float, x: float) -> cq.Workplane:
    return cq.Workplane("XY").workplane(offset=low).center(x, 0).circle(radius).extrude(high - low)


def _sector(t: Throw) -> cq.Workplane:
    """A wedge-shaped block that holds the counterweight."""
    reach, half = 2 * t.outline.counterweight, t.outline.half_angle
    far = [(-reach * cos(angle), reach * sin(angle)) for angle in (half, 0.0, -half)]
    block = cq.Workplane("XY").workplane(offset=t.inner).polyline([(0.0, 0.0), *far]).close()
    return block.extrude(t.web_thickness)


def _is_foot(edge: Any, feet: list[tuple[float, float, float]]) -> bool:
    centre, radius = edge.arcCenter(), edge.radius()
    return any(
        abs(radius - r) < 1e-6 and abs(centre.x - x) < 1e-6 and abs(centre.z - z) < 1e-6 for r, x, z in feet
    )


def _exported(body: cq.Workplane, file: Path) -> float:
    cq.exporters.export(body, str(file))
    return float(sum(solid.Volume() for solid in body.solids().vals()))  # type: ignore[union-attr, misc]


def milliseconds(actions: dict[str, Callable[[], Any]]) -> dict[str, list[float]]:
    """Wall times [ms] of the actions, which take turns."""
    taken: dict[str, list[float]] = {name: [] for name in actions}
    for _ in range(WARMING + ROUNDS):
        for name, action in actions.items():
            start = perf_counter()
            action()
            taken[name].append(1e3 * (perf_counter() - start))
    return {name: times[WARMING:] for name, times in taken.items()}


def row(case: str, folder: Path) -> dict[str, Any]:
    """One line of the table; raises if a baseline is another solid."""
    model_id, given = CASES[case]
    model = models().get(model_id, 1).from_quantities(given)
    file, si = folder / "crank.step", model.inputs_si()
    throw = model.drawn()  # type: ignore[attr-defined]
    baselines = {"own build": own_build, "plain script": plain_script}
    volume = regenerate(model_id, 1, si).measures["volume"]
    for name, baseline in baselines.items():
        if abs(off := baseline(throw, file) / volume - 1) > 1e-4:
            raise RuntimeError(f"{case}: {name} draws another solid, {off:+.1e} of the volume")
    times = milliseconds(
        {
            "regenerate": lambda: regenerate(model_id, 1, si),
            **{name: lambda draw=draw: draw(throw, file) for name, draw in baselines.items()},  # type: ignore[misc]
        }
    )
    medians = {name: median(some) for name, some in times.items()}
    low, _, high = quantiles(times["regenerate"], n=4)
    return {
        "case": case,
        "milliseconds": {name: round(value, 1) for name, value in medians.items()},
        "quartiles": [round(low, 1), round(high, 1)],
        "ratio to own build": round(medians["regenerate"] / medians["own build"], 3),
        "ratio to plain script": round(medians["regenerate"] / medians["plain script"], 3),
        "aim met": medians["regenerate"] < AIM,
    }


def main() -> None:
    """Measure every case."""
    load = os.getloadavg()
    with tempfile.TemporaryDirectory() as folder:
        rows = [row(case, Path(folder)) for case in CASES]
    summary = {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "load average": {"before": load, "after": os.getloadavg()},
        "rounds": ROUNDS,
        "rows": rows,
    }
    RESULTS.write_text(json.dumps(summary, indent=1) + "\n")
    for one in rows:
        print(json.dumps(one))


if __name__ == "__main__":
    main()

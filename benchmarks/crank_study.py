"""Repeat the paper's study of a crankshaft as a design: four changes, and the stiffness of each.

    python -m benchmarks.crank_study

Punewale, Khobragade, Chaudhari and Khandre (2015) change crankpin, journals, throw and the face inclination
of the webs of a single-cylinder crankshaft. The paper does not print its dimensions, so this shaft is our
own. Every number comes from one design on a running service: the solid is regenerated, measured and analysed
by finite elements, and relations pass inertia and stiffness to `torsional_vibration`. The script writes
docs/crank_study.md and docs/pictures/crank_study.png.
"""

from __future__ import annotations

import io
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
from PIL import Image

from app.calculations.schemas.evaluations import UsedInput
from app.cli.demonstration import service
from app.client import Client
from app.designs.schemas.designs import Design

DOCS = Path(__file__).parents[1] / "docs"
PAGE, PICTURE = DOCS / "crank_study.md", DOCS / "pictures" / "crank_study.png"

LEVEL = "fine"
WIDTH = 118  # length of a line of the page
SHEAR = 210 / 2.6  # [GPa]
HEADS = (
    "change", "K", "paper: K", "mass", "K per mass", "√(K/I)", "torsional mode", "paper: frequency",
    "closed form: K",
)  # fmt: skip
CLOSED = (
    "journal_length", "journal_diameter", "web_thickness", "web_width", "pin_length", "pin_diameter", "throw",
)  # fmt: skip

SLENDER = {
    "pin_angles": "[0] deg",
    "journal_diameter": "44 mm",
    "journal_length": "36 mm",
    "pin_diameter": "46 mm",
    "pin_length": "34 mm",
    "web_thickness": "8 mm",
    "web_width": "56 mm",
    "web_shape": "obround",
    "throw": "80 mm",
    "fillet": "2 mm",
    "counterweight_radius": "60 mm",
    "counterweight_angle": "120 deg",
    "face_inclination": "4.5 deg",
    "nose_length": "15 mm",
    "nose_diameter": "40 mm",
    "flange_thickness": "12 mm",
    "flange_diameter": "52 mm",
}
STOUT = {"web_thickness": "18 mm", "face_inclination": "9 deg"}
"""The same shaft with webs of a usual thickness."""


@dataclass(frozen=True)
class Change:
    """One change of the paper, and its effects in the paper [%]."""

    words: str
    parameters: Mapping[str, str]
    stiffness: float
    frequency: float


CHANGES = (
    Change("crankpin diameter +10 %", {"pin_diameter": "50.6 mm"}, 0.495, 4.74),
    Change("journal diameter +10 %", {"journal_diameter": "48.4 mm"}, 5.633, 4.53),
    Change("throw +1.5 mm", {"throw": "81.5 mm"}, -0.012, -0.32),
    Change("material on the face inclination", {"face_inclination": "1.4 deg"}, 15.209, 2.42),
)
STOUT_CHANGES = (*(c.parameters for c in CHANGES[:3]), {"face_inclination": "5.95 deg"})


@dataclass(frozen=True)
class State:
    """One variant of the shaft, from one revision of the design."""

    stiffness: float  # [N m/rad], by finite elements
    error: float  # estimated relative error of the stiffness
    frequency: float  # [Hz], from stiffness and measured inertia, as in the paper
    mode: float  # [Hz], the first torsional mode of the solid by finite elements
    recommended: float  # [N m/rad], of the throw alone by the closed form
    mass: float  # [kg]
    inertia: float  # [kg m²], about the shaft's axis


def document(parameters: Mapping[str, str]) -> dict[str, Any]:
    """Return the design: the shaft, its frequency, and its throw in closed form."""
    dimensions = [name for name in CLOSED if name in parameters]
    throw: dict[str, Any] = {name: f"= crank.{name}" for name in dimensions}
    train = {
        "inertias": ["= crank.polar_inertia"],
        "stiffnesses": ["= crank.torsion.stiffness"],
        "ends": "fixed_free",
    }
    steps = {
        "vibration": {"template": "torsional_vibration", "version": 1, "inputs": train},
        "throw": {
            "template": "crank_stiffness",
            "version": 1,
            "inputs": {**throw, "shear_modulus": {"value": SHEAR, "unit": "GPa"}},
        },
    }
    crank = {
        "id": "crankshaft",
        "version": 1,
        "parameters": dict(parameters),
        "analyses": {"torsion": {"level": LEVEL}},
    }
    return {"name": "the paper's study", "steps": steps, "models": {"crank": crank}}


def states(client: Client, base: Mapping[str, str], changes: Sequence[Mapping[str, str]]) -> list[State]:
    """Return the original shaft and its changes, each from a revision of one design."""
    design = client.create(document(base))
    listed = [state(client, design)]
    for change in changes:
        parameters = {**base, **change}
        design = client.change(
            design, {"models": {"crank": {"parameters": parameters}}, "note": note_of(change)}
        )
        listed.append(state(client, design))
        print(note_of(change), listed[-1], flush=True)
    return listed


def note_of(change: Mapping[str, str]) -> str:
    """Return the text of a change as the note of its revision."""
    return ", ".join(f"{name} {value}" for name, value in change.items()) or "as drawn"


def state(client: Client, design: Design) -> State:
    """Return results and measurements of the newest revision, and the torsional mode of its solid."""
    revision = client.revision(design.id, design.revision)
    vibration, throw = revision.steps["vibration"], revision.steps["throw"]
    measured, crank = client.measurements(design.id)["crank"], revision.models["crank"]
    stiffness = crank.analyses["torsion"].outputs["stiffness"]
    outputs = ["torsional_frequency"]
    mode = client.analyse("crankshaft", 1, crank.parameters, "torsion", level=LEVEL, outputs=outputs)
    return State(
        stiffness=_number(stiffness.value),
        error=_number(stiffness.error),
        frequency=_first(vibration.outputs["natural_frequencies"].value),
        mode=_number(mode.outputs["torsional_frequency"].value),
        recommended=_number(throw.outputs["recommended_stiffness"].value),
        mass=measured.mass.value,
        inertia=_inertia(vibration.inputs["inertias"]),
    )


def _number(value: object) -> float:
    """Return a value that the study needs."""
    if not isinstance(value, float):
        raise ValueError("the service has no single value for an output of the study")
    return value


def _first(values: object) -> float:
    """Return the first of several values."""
    if not isinstance(values, list):
        raise ValueError("the service has no list of values for an output of the study")
    return _number(values[0])


def _inertia(used: object) -> float:
    """Return the first inertia that a step used."""
    if not isinstance(used, UsedInput):
        raise ValueError("the step of the vibration waits for its inputs")
    return _first(used.value)


def main() -> None:
    """Run the study on its own service and write page and picture."""
    mpl.use("Agg")
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as client:
        slender = states(client, SLENDER, [change.parameters for change in CHANGES])
        picture = client.model(client.designs()[0].id, "png")
        stout = states(client, {**SLENDER, **STOUT}, STOUT_CHANGES)
    draw(slender, stout, picture)
    PAGE.write_text(page(slender, stout), encoding="utf-8")


def gains(listed: Sequence[State], name: str) -> list[float]:
    """Return the effect [%] of each change on one quantity."""
    base, *changed = (getattr(state, name) for state in listed)
    return [100 * (value / base - 1) for value in changed]


def draw(slender: Sequence[State], stout: Sequence[State], picture: bytes) -> None:
    """Draw the change of stiffness for each change, ours and the paper's, and the shaft."""
    figure, (shown, axes) = plt.subplots(1, 2, figsize=(10, 4), width_ratios=[0.7, 1], layout="constrained")
    shown.imshow(Image.open(io.BytesIO(picture)))
    shown.axis("off")
    shown.set_title("the shaft, material added on its webs' faces", fontsize=9)
    rows = {
        "slender webs": gains(slender, "stiffness"),
        "stout webs": gains(stout, "stiffness"),
        "Punewale et al. 2015": [change.stiffness for change in CHANGES],
    }
    for i, (label, values) in enumerate(rows.items()):
        bars = axes.barh([4 * place + i for place in range(len(values))], values, label=label)
        axes.bar_label(bars, fmt="%+.2f", padding=3, fontsize=8)
    axes.set_yticks([4 * place + 1 for place in range(len(CHANGES))], [change.words for change in CHANGES])
    axes.invert_yaxis()
    axes.margins(x=0.15)
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set_xlabel("change of torsional stiffness [%]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.3, -0.16), ncols=3, frameon=False)
    figure.savefig(PICTURE, dpi=100)
    plt.close(figure)


def table(listed: Sequence[State]) -> str:
    """Return one row for each change with our results and the paper's."""
    rows = [HEADS, ("---",) + ("---:",) * (len(HEADS) - 1)]
    columns = [gains(listed, name) for name in ("stiffness", "frequency", "mode", "recommended")]
    for i, change in enumerate(CHANGES):
        gain, frequency, mode, closed = (column[i] for column in columns)
        added = listed[i + 1].mass - listed[0].mass
        rows.append((
            change.words, f"{gain:+.2f} %", f"{change.stiffness:+.3f} %", f"{1000 * added:+.0f} g",
            f"{gain / added:+.0f} %/kg" if gain > 0 else "a loss", f"{frequency:+.2f} %", f"{mode:+.2f} %",
            f"{change.frequency:+.2f} %", f"{closed:+.2f} %",
        ))  # fmt: skip
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def line(base: State) -> str:
    """Return the main figures of a shaft as text."""
    return (
        f"K = {base.stiffness / 1000:.1f} kN m/rad ± {100 * base.error:.1g} %, "
        f"I = {1000 * base.inertia:.3f}e-3 kg m², {base.mass:.2f} kg; "
        f"√(K/I)/2π = {base.frequency:.0f} Hz, first torsional mode {base.mode:.0f} Hz"
    )


def page(slender: Sequence[State], stout: Sequence[State]) -> str:
    """Return the page in Markdown with its numbers."""
    text = (Path(__file__).parent / "crank_study.txt").read_text(encoding="utf-8")
    return text.format(
        dimensions=fill(f"Dimensions: {listed(SLENDER)}.", WIDTH),
        slender=fill(f"As drawn: {line(slender[0])}.", WIDTH),
        slender_table=table(slender),
        stout=fill(f"As drawn, with {listed(STOUT)}: {line(stout[0])}.", WIDTH),
        stout_table=table(stout),
    )


def listed(parameters: Mapping[str, str]) -> str:
    """Return parameters as text."""
    return ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in parameters.items())


if __name__ == "__main__":
    main()

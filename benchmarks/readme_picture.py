"""Draws the README's picture from a running service: the worksheet beside the part that it drives.

    python -m benchmarks.readme_picture

Writes docs/pictures/link.png; every number and both pictures of the part come from the service.
"""

import copy
import io
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
from PIL import Image

from app.client import Client, Design
from app.demo import service
from app.designs.schemas import PAPER

TARGET = Path(__file__).parents[1] / "docs" / "pictures" / "link.png"
SHOWN = ("sommerfeld_number", "relative_eccentricity", "minimum_film_thickness")
SCALES = ("1", "1.25")
UNITS = {"1": "", "um": "µm"}


def main() -> None:
    """Create the paper's design at two scales and draw both."""
    mpl.use("Agg")
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as client:
        formulas = {f["name"]: f["latex"] for f in client.template("oil_film", 1)["formulas"]}
        designs = [client.create(_document(scale)) for scale in SCALES]
        figure, rows = plt.subplots(len(designs), 2, figsize=(11, 7.2), width_ratios=[1.25, 1])
        for design, (worksheet, part) in zip(designs, rows, strict=True):
            _worksheet(worksheet, client, design, formulas)
            _part(part, client, design)
    figure.tight_layout()
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(TARGET, dpi=90)


def _document(scale: str) -> dict[str, Any]:
    return {**copy.deepcopy(PAPER), "parameters": {"scale": scale}}


def _worksheet(axes: Any, client: Client, design: Design, formulas: dict[str, str]) -> None:
    """The relation and three of the formulas with their results, as a worksheet shows them."""
    step = client.revision(design.id, design.revision)["steps"]["film"]
    diameter = step["inputs"]["bearing_diameter"]["value"]
    lines = [
        f"SCALE := {design.parameters['scale']}",
        f"D := SCALE · 48 mm = {diameter:g} mm",
        *(f"${formulas[name]}$  =  {_shown(step['outputs'][name])}" for name in SHOWN),
    ]
    axes.axis("off")
    for place, line in enumerate(lines):
        axes.text(0.02, 0.9 - 0.2 * place, line, fontsize=15, va="center", transform=axes.transAxes)


def _shown(quantity: dict[str, Any]) -> str:
    return f"{quantity['value']:.4g} {UNITS[quantity['unit']]}".strip()


def _part(axes: Any, client: Client, design: Design) -> None:
    measured = client.measurements(design.id)["model"]["dimensions"]["inner_diameter"]
    axes.imshow(Image.open(io.BytesIO(client.model(design.id, "png"))))
    axes.set_title(
        f"inner diameter {measured['value']:g} {measured['unit']}, measured on the STEP", fontsize=12
    )
    axes.axis("off")


if __name__ == "__main__":
    main()

"""Draw the README's picture from a running service: the worksheet and the part that it drives.

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
from PIL import Image, ImageChops

from app.calculations.schemas.evaluations import Output, UsedInput
from app.cli.demonstration import service
from app.client import Client
from app.designs.bodies import PAPER
from app.designs.schemas.designs import Design

TARGET = Path(__file__).parents[1] / "docs" / "pictures" / "link.png"
SHOWN = ("sommerfeld_number", "relative_eccentricity", "minimum_film_thickness")
SCALES = ("1", "1.25")
UNITS = {"1": "", "um": "µm"}
WIDEST = 116  # largest size of a part in the picture [mm]


def main() -> None:
    """Create the paper's design at two scales and draw both, with the parts in true proportion."""
    mpl.use("Agg")
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as client:
        formulas = {f.name: f.latex for f in client.template("oil_film", 1).formulas}
        designs = [client.create(_document(scale)) for scale in SCALES]
        figure, rows = plt.subplots(len(designs), 2, figsize=(9.2, 6.2), width_ratios=[0.8, 1])
        for design, (worksheet, part) in zip(designs, rows, strict=True):
            _worksheet(worksheet, client, design, formulas)
            _part(part, client, design)
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=0.95, wspace=0, hspace=0.12)
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(TARGET, dpi=100)


def _document(scale: str) -> dict[str, Any]:
    return {**copy.deepcopy(PAPER), "parameters": {"scale": scale}}


def _worksheet(axes: Any, client: Client, design: Design, formulas: dict[str, str]) -> None:
    """Draw the relation and three formulas with their results, as a worksheet shows them."""
    step = client.revision(design.id, design.revision).steps["film"]
    diameter = step.inputs["bearing_diameter"]
    assert isinstance(diameter, UsedInput)
    lines = [
        f"SCALE := {design.parameters['scale']}",
        f"D := SCALE · 48 mm = {diameter.value:g} mm",
        *(f"${formulas[name]}$  =  {_shown(step.outputs[name])}" for name in SHOWN),
    ]
    axes.axis("off")
    for place, line in enumerate(lines):
        axes.text(0.05, 0.92 - 0.2 * place, line, fontsize=15, va="center", transform=axes.transAxes)


def _shown(output: Output) -> str:
    return f"{output.value:#.4g} {UNITS[output.unit or '1']}".strip()


def _part(axes: Any, client: Client, design: Design) -> None:
    dimensions: dict[str, Any] = dict(client.measurements(design.id)["model"].dimensions)
    bore, outside = (dimensions[name].value for name in ("inner_diameter", "outer_diameter"))
    picture = _trimmed(Image.open(io.BytesIO(client.model(design.id, "png"))).convert("RGB"))
    half, height = outside / 2, outside * picture.height / picture.width / 2
    axes.imshow(picture, extent=(-half, half, -height, height))
    axes.set(xlim=(-WIDEST / 2, WIDEST / 2), ylim=(-WIDEST / 2.9, WIDEST / 2.9), aspect="equal")
    axes.set_title(f"bore {bore:g} mm, outside {outside:g} mm, as measured on the STEP file", fontsize=11)
    axes.axis("off")


def _trimmed(picture: Image.Image) -> Image.Image:
    """Return the part that is not background.

    Of a ring seen from above its edge, this is as wide as the ring.
    """
    background = Image.new("RGB", picture.size, picture.getpixel((0, 0)))
    return picture.crop(ImageChops.difference(picture, background).getbbox())


if __name__ == "__main__":
    main()

"""Draw the accuracy of every level of `oil_film`: error against cost, and maps of the error.

python -m benchmarks.accuracy_picture  docs/pictures/oil_film_accuracy.png from the tables of accuracy
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy import EPS, FOLDER, WIDTH
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

PICTURE = Path("docs/pictures/oil_film_accuracy.png")


def draw() -> None:
    """Draw error against cost at three points, and maps of the error in film thickness."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    second = json.loads((FOLDER / "oil_film_v2.accuracy.json").read_text(encoding="utf-8"))
    first = json.loads((FOLDER / "oil_film_v1.accuracy.json").read_text(encoding="utf-8"))
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.5), layout="constrained")
    _against_cost(axes[0, 0], second)
    maps = [
        ("short_bearing", second),
        ("fit", second),
        ("map", second),
        ("reynolds", second),
        ("only", first),
    ]
    for panel, (level, content) in zip(axes.flat[1:], maps, strict=True):
        shown = _error_map(panel, level, content)
    figure.colorbar(shown, ax=axes, label="error of the minimum film thickness", shrink=0.8)
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, dpi=80)
    print(PICTURE, PICTURE.stat().st_size // 1000, "kB")


def _against_cost(panel: Any, content: dict[str, Any]) -> None:
    """Plot each level's error and cost for light, medium and heavy load at B/D about 0.6."""
    column = np.searchsorted(WIDTH, 0.6) - 1
    for eps, mark in ((0.35, "o"), (0.75, "s"), (0.96, "^")):
        row = np.searchsorted(EPS, eps) - 1
        points = [
            (content["levels"][level]["cost"]["vectorised"], e[row][column])
            for level in content["levels"]
            if (e := content["levels"][level]["errors"]["minimum_film_thickness"])[row][column]
        ]
        panel.loglog(*zip(*points, strict=True), mark + "-", label=f"eps {eps}")
    for height, (level, about) in zip((8, 0.3, 1, 1, 0.02), content["levels"].items(), strict=True):
        panel.axvline(about["cost"]["vectorised"], color="0.9", zorder=0)
        panel.text(about["cost"]["vectorised"], height, f" {level}", va="top", fontsize=7)
    panel.set(
        xlabel="seconds a point, vectorised", ylabel="error of h_min", title="error against cost, B/D 0.6"
    )
    panel.legend()


def _error_map(panel: Any, level: str, content: dict[str, Any]) -> Any:
    """Return a map of the film thickness error; white where it was refused or not measured."""
    from matplotlib.colors import LogNorm

    table = np.array(content["levels"][level]["errors"]["minimum_film_thickness"], dtype=float)
    along = np.array(content["axes"][0]["values"])
    is_eps = content["axes"][0]["attribute"] == "eps"
    edges = np.arctanh(np.minimum(along, ECCENTRICITY_LIMIT)) if is_eps else np.log10(along)
    widths = content["axes"][1]["values"]
    shown = panel.pcolormesh(edges, widths, table.T, norm=LogNorm(1e-5, 1), cmap="viridis")
    ticks = [0, 0.5, 0.8, 0.95, 0.99, 0.999, 0.9999, 0.99999] if is_eps else [0.01, 0.1, 1, 10, 100, 1000]
    places = np.arctanh(ticks) if is_eps else np.log10(ticks)
    panel.set_xticks(places, [f"{tick:g}" for tick in ticks], fontsize=7, rotation=30)
    name = f"oil_film 2, {level}" if is_eps else "oil_film 1"
    panel.set(yscale="log", ylabel="B/D", xlabel="eps" if is_eps else "So", title=name)
    return shown


if __name__ == "__main__":
    draw()

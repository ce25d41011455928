"""What a model of FreeCAD costs: the import, builds, and changes of a design while its process is warm.

`python -m benchmarks.freecad_models` starts a service, draws a bush by FreeCAD, and brings it. It prints
seconds; each build and each change has another bore. It needs FreeCAD.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import httpx

from app.settings import Settings

TESTS = Path(__file__).parents[1] / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "app"), str(TESTS / "app" / "brought")]

from freecad_files import bush, imported  # noqa: E402 - the tests draw the same bush
from serving import API, created, paper, patched, serving  # noqa: E402

BORES = range(41, 51)  # [mm]


def seconds(call: Callable[[], object]) -> float:
    """How long a call takes [s]."""
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def builds(http: httpx.Client) -> list[float]:
    """Builds of the model alone."""

    def build(bore: int) -> None:
        body = {"parameters": {"bore": f"{bore} mm"}, "artifacts": ["step"]}
        path = f"{API}/models/bush/versions/1/build"
        assert http.post(path, json=body, headers={"Prefer": "wait=60"}).status_code == 200

    return [seconds(lambda bore=bore: build(bore)) for bore in BORES]


def changes(http: httpx.Client) -> list[float]:
    """Changes of a design whose oil film drives the bore, from the request to the checked solid."""
    document = paper()
    diameter = "film.bearing_diameter"
    parameters = {"bore": f"= {diameter}", "outer_diameter": f"= {diameter} + 10 mm"}
    document["model"] = {"id": "bush", "version": 1, "parameters": parameters}
    design = created(http, document)

    def change(bore: float) -> None:
        nonlocal design
        given = {"bearing_diameter": f"{bore} mm"}
        design = patched(http, design, {"steps": {"film": {"inputs": given}}})
        assert design["state"] == "current"

    return [seconds(lambda bore=bore: change(bore + 0.5)) for bore in BORES]


def main() -> None:
    """Print the seconds of each."""
    content = bush()
    with (
        tempfile.TemporaryDirectory() as folder,
        serving(Settings(data=Path(folder), wait_seconds=60)) as server,
        httpx.Client(base_url=server.url, timeout=120, trust_env=False) as http,
    ):
        brought = seconds(lambda: imported(http, "bush", content))
        print(f"import: {brought:.2f} s, the start of processes included")
        for what, measured in (("build", builds(http)), ("change of a design", changes(http))):
            median, longest = statistics.median(measured), max(measured)
            print(f"{what}: median {median:.2f} s, longest {longest:.2f} s of {len(measured)}")


if __name__ == "__main__":
    main()

"""Our film against two peers in one run: ROSS's plain journal bearing, and the scipy prototype.

    python -m benchmarks.film_ross [prototype.py]

ROSS is installed from PyPI into build/ross, an environment of its own (CRANKWRIGHT_ROSS names another folder,
and the release that stands there is kept). Its bearing is given the same film
as ours: one land of 360° that begins at the widest gap, constant viscosity, the eccentricity held, its
default mesh. Errors of the load are against our solution extrapolated from 1024 × 128. ROSS's time is
that of its constructor, which finds stiffness and damping too; ours is given without and with them.
The prototype is compared on the coarsest of its meshes whose error is no larger than ours.
The table is printed and kept in benchmarks/results/film.json; if ROSS gives no answer it says why.
"""

import json
import os
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from shutil import which
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.film_cost import seconds
from benchmarks.film_ross_answer import POINTS
from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.film_map import mapped_film
from templates.physics.films.reynolds import extrapolated_film, static_film

RELEASE = "ross-rotordynamics==3.1.0"
ENVIRONMENT = Path(os.environ.get("CRANKWRIGHT_ROSS", "build/ross"))
RESULTS = Path("benchmarks/results/film.json")
MESH = 64, 8
PROTOTYPE_MESHES = [(60, 8), (120, 12), (180, 18), (240, 24), (360, 40), (480, 48)]
INSTALL_SECONDS, ANSWER_SECONDS = 900, 300


class NoAnswerError(Exception):
    """ROSS could not be installed or gave no answer."""


def main() -> None:
    """Measure, print and keep."""
    results: dict[str, Any] = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    try:
        python = environment()
        results["ROSS"] = release(python)
        results["ROSS, plain journal, default mesh"] = ross_rows(answers(python))
    except NoAnswerError as reason:
        results["ROSS, plain journal, default mesh"] = f"no answer: {reason}"
    if len(sys.argv) > 1:
        results["scipy prototype, at equal error"] = [prototype_row(sys.argv[1], *p) for p in POINTS]
    RESULTS.parent.mkdir(exist_ok=True)
    RESULTS.write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n")
    print(json.dumps(results, indent=1, ensure_ascii=False))


def environment() -> Path:
    """ROSS's interpreter, installed if it is not yet.

    Raises
    ------
    NoAnswerError
        If it cannot be installed.
    """
    python = ENVIRONMENT / "bin" / "python"
    if "CRANKWRIGHT_ROSS" in os.environ and python.exists():
        return python
    if not python.exists():
        run([interpreter(), "-m", "venv", str(ENVIRONMENT)], INSTALL_SECONDS)
    install = [str(python), "-m", "pip", "install", "--quiet", "--only-binary=:all:"]
    run([*install, "--ignore-requires-python", RELEASE], INSTALL_SECONDS)
    return python


def release(python: Path) -> str:
    """The release of ROSS that is installed."""
    asked = "from importlib.metadata import version; print(version('ross-rotordynamics'))"
    return run([str(python), "-c", asked], ANSWER_SECONDS).strip()


def interpreter() -> str:
    """Python 3.13, which ROSS asks for, if there is one that starts; else this one."""
    candidates = [which("python3.13"), *map(str, Path.home().glob(".pyenv/versions/3.13*/bin/python3.13"))]
    for candidate in filter(None, candidates):
        if subprocess.run([candidate, "--version"], capture_output=True, check=False).returncode == 0:
            return candidate
    return sys.executable


def run(command: list[str], limit: float) -> str:
    """What a command prints, on as many threads as it likes.

    Raises
    ------
    NoAnswerError
        If it fails or takes too long.
    """
    free = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    try:
        done = subprocess.run(command, env=free, capture_output=True, text=True, timeout=limit, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoAnswerError(str(error)) from error
    if done.returncode:
        raise NoAnswerError(done.stderr.strip()[-300:])
    return done.stdout


def answers(python: Path) -> list[dict[str, float]]:
    """ROSS's load and time at each point, from its own environment.

    Raises
    ------
    NoAnswerError
        If it gave none.
    """
    printed = run([str(python), "-m", "benchmarks.film_ross_answer"], ANSWER_SECONDS)
    return list(json.loads(printed.splitlines()[-1]))


def ross_rows(ross: list[dict[str, float]]) -> list[dict[str, float | str]]:
    """Errors of ROSS's load, ours and our map's, and ROSS's time over ours."""
    rows: list[dict[str, float | str]] = []
    for (eps, ratio), theirs in zip(POINTS, ross, strict=True):
        truth = extrapolated_film(eps, ratio, 512, 64)[0].So
        film = seconds(lambda e=eps, b=ratio: static_film(e, b, *MESH))  # type: ignore[misc]
        linear = seconds(lambda e=eps, b=ratio: plain_coefficients(e, b, *MESH))  # type: ignore[misc]
        rows.append({
            "eps": eps,
            "B/D": ratio,
            "error, ROSS [%]": percent(theirs["So"] / truth - 1),
            "error, ours 64 × 8 [%]": percent(static_film(eps, ratio, *MESH).So / truth - 1),
            "error, our map [%]": percent(
                float(mapped_film(np.array(eps), np.array(ratio))["So"]) / truth - 1
            ),
            "time, ROSS [ms]": round(1e3 * theirs["time"], 2),
            "ROSS over our film": round(theirs["time"] / film, 1),
            "ROSS over our film, stiffness and damping": round(theirs["time"] / linear, 1),
            "aim": "at least 5, at smaller error",
        })  # fmt: skip
    return rows


def prototype_row(path: str, eps: float, ratio: float) -> dict[str, float | str]:
    """Time of the prototype over ours, on its coarsest mesh that is as exact as ours."""
    spec = spec_from_file_location("prototype", path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    truth = extrapolated_film(eps, ratio, 512, 64)[0].So
    ours = abs(static_film(eps, ratio, *MESH).So / truth - 1)
    row: dict[str, float | str] = {"eps": eps, "B/D": ratio, "error, ours 64 × 8 [%]": percent(ours)}
    for n, m in PROTOTYPE_MESHES:
        begin = perf_counter()
        error = abs(module.solve(eps, ratio, n, m)["So"] / truth - 1)
        once = perf_counter() - begin
        if error <= ours or (n, m) == PROTOTYPE_MESHES[-1]:
            repeats = 5 if once < 1 else 1
            theirs = min(once, seconds(lambda n=n, m=m: module.solve(eps, ratio, n, m), repeats))  # type: ignore[misc]
            film = seconds(lambda: static_film(eps, ratio, *MESH))
            row |= {"prototype's mesh": f"{n} × {m}", "error, prototype [%]": percent(error)}
            row |= {"prototype over ours": round(theirs / film, 1), "aim": "at least 5"}
            if error > ours:
                row["note"] = "the prototype's finest mesh, less exact than ours"
            break
    return row


def percent(share: float) -> float:
    """Per cent, to a ten-thousandth."""
    return round(100 * share, 4)


if __name__ == "__main__":
    main()

"""Lines of the table that `benchmarks.service` prints, and on what it was measured."""

import os
import platform
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import service_load


@dataclass(frozen=True)
class Row:
    """One line of the table: a measure over its repeats and, if it is compared, the ratio."""

    part: str
    what: str
    unit: str
    median: float
    quartiles: tuple[float, float]
    against: str = ""
    ratio: float | None = None
    ratio_quartiles: tuple[float, float] | None = None
    aim: str = ""
    met: bool | None = None


def row(
    part: str,
    what: str,
    unit: str,
    values: Sequence[float],
    *,
    baseline: Sequence[float] | None = None,
    **more: Any,
) -> Row:
    """A line from its repeats, with the ratios to those of the baseline."""
    figures: dict[str, Any] = {}
    if baseline is not None:
        figures["ratio"], figures["ratio_quartiles"] = _spread(np.divide(values, baseline))
    return Row(part, what, unit, *_spread(values), **figures, **more)


def _spread(values: Any) -> tuple[float, tuple[float, float]]:
    low, middle, high = (float(f"{q:.4g}") for q in np.percentile(values, [25, 50, 75]))
    return middle, (low, high)


def judged(
    measured: Row, aim: str, *, ratio_at_least: float = 0, ratio_below: float = np.inf, below: float = np.inf
) -> Row:
    """A line with its aim and whether it is met."""
    ratio = 1.0 if measured.ratio is None else measured.ratio
    met = ratio_at_least <= ratio < ratio_below and measured.median < below
    return Row(**{**asdict(measured), "aim": aim, "met": bool(met)})


def milliseconds(action: Callable[[], object]) -> float:
    """How long it takes."""
    start = time.perf_counter()
    action()
    return 1e3 * (time.perf_counter() - start)


def commit() -> str:
    """Which commit was measured, and whether the working tree had changes beside it."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    return subprocess.run(command, capture_output=True, text=True).stdout.strip()


def machine() -> dict[str, Any]:
    """The machine of the measurement."""
    names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    packages = {name: version(name) for name in ("fastapi", "uvicorn", "cadquery", "numpy")}
    load = "wrk" if service_load.WRK else "sockets"
    processor = names[0].partition(":")[2].strip() if names else platform.processor()
    return {
        "processor": processor,
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "load": load,
        **packages,
    }


def line(measured: Row) -> str:
    """A line of the table."""
    ratio = ""
    if measured.ratio is not None and measured.ratio_quartiles is not None:
        ratio = "× {:6.3g}  [{:.3g} … {:.3g}]  of {}".format(
            measured.ratio, *measured.ratio_quartiles, measured.against
        )
    spread = "[{:.3g} … {:.3g}]".format(*measured.quartiles)
    verdict = "" if measured.met is None else f"  aim {measured.aim}: {'met' if measured.met else 'MISSED'}"
    value = f"{measured.median:9.4g} {measured.unit:4}"
    return f"{measured.part:2} {measured.what:52} {value} {spread:19} {ratio}{verdict}"

"""A slow template that its table declares as expensive, and a server for it."""

import json
from pathlib import Path
from textwrap import dedent

SLEEPER = '''
"""Sleeps, or worse, in the process that calculates."""

import ctypes
import os
import time
from pathlib import Path

import numpy as np

from templates.core.errors import Fault, InvalidInputs
from templates.core.progress import report
from templates.core.language.template import Array, Template, choice, formula, given, units


ALARM = "no such file"


class Sleeper(Template):
    """Sleeps, or worse, in the process that calculates."""

    example = {"duration": "0 s"}

    t: Array = given("s", "duration", ge=0)
    mood: str = choice("good", "dies", "eats", "refuses", words="mood", default="good")

    @formula("1", "process")
    def n(self) -> Array:
        return slept(self.t, self.mood)


@units("s", None, returns="1")
def slept(seconds, mood):
    """The process that slept so long; it notes that it began, unless the example is checked."""
    with Path(os.environ.get("SLEEPER_LOG", os.devnull)).open("a") as log:
        log.write(f"{os.getpid()}\\n" if np.max(seconds) > 0 else "")
    if mood == "dies":
        ctypes.string_at(0)
    if mood == "refuses":
        raise InvalidInputs([Fault("mood", "refused", "such a mood shows when it is calculated only")])
    if mood == "eats":
        bytearray(8 * 2**30)
    end = time.monotonic() + float(np.max(seconds))
    report(0.5, "half asleep")
    while (left := end - time.monotonic()) > 0 and not Path(ALARM).exists():
        time.sleep(min(left, 0.2))
        report(0.5, "half asleep")
    return np.float64(os.getpid())
'''


ALARM = "alarm"
"""While a file of this name lies in its folder, the template sleeps no longer."""


def folder_of_sleeper(path: Path) -> Path:
    """A team's folder with the template and the table that says what it costs."""
    path.mkdir(parents=True)
    source = dedent(SLEEPER).lstrip().replace('"no such file"', repr(str(path / ALARM)))
    (path / "sleeper_v1.py").write_text(source)
    axis = {"attribute": "t", "name": "duration", "unit": "s", "values": [0, 1]}
    words = {"truth": "a clock", "error": "relative error", "cost": "seconds a point"}
    table = {**words, "axes": [axis, axis], "levels": {"only": {"cost": {"single": 1.0}, "errors": {}}}}
    (path / "sleeper_v1.accuracy.json").write_text(json.dumps(table))
    return path

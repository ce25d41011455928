"""Plotly's browser file, as its installed Python package holds it: served compressed, never copied.

Under the pages' Content-Security-Policy it may add no style element. It looks for two elements by their ids
first, and adds none where it finds them: `plotly.js-style-global`, whose sheet it fills by calls (a linked
sheet will do), and one for the maps that it bundles, which no page of ours shows. Pages with plots hold both.
Colour bars set style attributes when they are drawn again, and so do raised exponents: `plots/plots.js` has
a scale of its own, and axes write 1e-3.
"""

from __future__ import annotations

import gzip
import re
from functools import cache
from importlib.metadata import version
from importlib.resources import files

ROOM_OF_MAPS = re.compile(rb'getElementById\("([0-9a-f]{64})"\)')


@cache
def script() -> bytes:
    """Return the browser file, compressed by gzip; equal bytes for equal versions."""
    return gzip.compress(_plain(), 9, mtime=0)


@cache
def tag() -> str:
    """Return a text that differs between versions of the file."""
    return f'"plotly-{version("plotly")}"'


@cache
def ids_of_styles() -> tuple[str, ...]:
    """Return the ids under which the file looks for styles of maps before it adds them."""
    return tuple(sorted({id.decode() for id in ROOM_OF_MAPS.findall(_plain())}))


def _plain() -> bytes:
    return files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()

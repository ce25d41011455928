"""Serve Plotly's browser file from its installed Python package, compressed.

The pages' Content-Security-Policy does not let Plotly add style elements. It adds none if it finds two
elements by their ids: `plotly.js-style-global`, a style sheet that it fills by function calls (a linked
sheet works), and one for its maps, which our pages do not use. Pages with plots contain both. Colour bars
and raised exponents would set style attributes when they are redrawn, so `plots/plots.js` draws its own
scale, and axes write 1e-3.
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
    """Return the browser file, compressed by gzip; equal versions give equal bytes."""
    return gzip.compress(_plain(), 9, mtime=0)


@cache
def tag() -> str:
    """Return a text that identifies the file's version."""
    return f'"plotly-{version("plotly")}"'


@cache
def ids_of_styles() -> tuple[str, ...]:
    """Return the ids of the style elements that the file looks for before it adds them."""
    return tuple(sorted({id.decode() for id in ROOM_OF_MAPS.findall(_plain())}))


def _plain() -> bytes:
    return files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()

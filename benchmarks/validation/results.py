"""Our values of the published cases as they were last calculated."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from templates.validate.case import Numbers

RESULTS = Path(__file__).parents[1] / "results" / "validation.json"


@cache
def kept() -> Mapping[str, Numbers]:
    """Return our values by case."""
    results: Mapping[str, Numbers] = json.loads(RESULTS.read_text(encoding="utf-8"))
    return results

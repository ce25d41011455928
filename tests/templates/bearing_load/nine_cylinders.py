"""The nine-cylinder generator set of DYREMI: inputs as far as they survive, and what was printed."""

import json
from pathlib import Path

_CASE = json.loads(Path(__file__).parents[2].joinpath("references/nine_cylinder_set.json").read_text())
INPUTS, PRINTED = _CASE["inputs"], {name: reported["value"] for name, reported in _CASE["printed"].items()}

"""The nine-cylinder generator set of DYREMI: the known inputs, and the printed results."""

import json
from pathlib import Path

_CASE = json.loads(Path(__file__).parents[2].joinpath("references/nine_cylinder_set.json").read_text())
INPUTS, PRINTED = _CASE["inputs"], {name: reported["value"] for name, reported in _CASE["printed"].items()}

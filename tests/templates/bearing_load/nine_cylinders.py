"""The nine-cylinder generator set of DYREMI: the known inputs, and the printed results."""

import json

from templates.validate.case import numbers
from templates.validate.reference import FOLDER, reference

INPUTS = json.loads((FOLDER / "nine_cylinder_set.json").read_text(encoding="utf-8"))["inputs"]
PRINTED = numbers(reference("nine_cylinder_set.csv").rows[0])

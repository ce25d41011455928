"""A script as the docs of version 0.1 show it: evaluates, prints the report, checks the dimensions."""

import sys
from pathlib import Path

from app.catalogue.finding import find_templates
from templates.core import dimensions, report
from templates.core.errors import InvalidInputs
from templates.core.evaluate import evaluate

joint = find_templates([Path(sys.argv[1])]).get("spigot_joint", 1)
answer = evaluate(joint, joint.example)
for row in report.rows(answer.template):
    print(row.latex)
print(dimensions.faults(joint))
print(f"{answer.outputs['joint_pressure'].value:.6g}")
try:
    evaluate(joint, {**joint.example, "hub_diameter": "30 mm"})
except InvalidInputs as refusal:
    print([fault.name for fault in refusal.faults])

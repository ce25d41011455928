"""Bare shells of `plain_bearing`, its quickest solids, for tests of other things.

Each set is what to give beside the bore: one body of steel, `full_back` or `upper_back`, with square edges,
an oil groove and an oil hole. By default the model draws a pair of half shells with linings.
"""

BUSH = {"shells": "full", **dict.fromkeys(("lining_thickness", "inner_chamfer", "outer_chamfer"), "0 mm")}
HALF = {**BUSH, "shells": "upper", "tang_width": "0 mm"}

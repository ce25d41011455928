"""How `crank_stiffness` errs about overlap 0, against finite elements of the same throws.

    python -m benchmarks.crank_transition

One throw without fillets, three thicknesses of its webs, throws from no overlap to much. The stiffness by
finite elements is that of level `default`, end to end, free end.
"""

import numpy as np

from benchmarks.torsion_levels import shaft_of
from cad.analysis.analyse import AnalysisRequest, analyse
from templates.core.language.evaluate import evaluate
from templates.stiffness.crank_stiffness_v1 import CrankStiffness as First
from templates.stiffness.crank_stiffness_v2 import CrankStiffness

JOURNAL, PIN = 55.0, 48.0
OVERLAPS = (-0.15, -0.08, -0.001, 0.001, 0.08, 0.15)  # in journal + pin diameter
WEBS = (12.0, 18.0, 26.0)


def throw_of(overlap: float, web: float) -> dict[str, float]:
    """Return the dimensions [mm] of a throw."""
    return {"journal_diameter": JOURNAL, "journal_length": 40.0, "pin_diameter": PIN, "pin_length": 32.0,
             "web_thickness": web, "web_width": 80.0, "throw": (0.5 - overlap) * (JOURNAL + PIN)}  # fmt: skip


def by_elements(sizes: dict[str, float]) -> float:
    """Return the stiffness [N·m/rad] by finite elements."""
    step, shaft = shaft_of({name: value / 1000 for name, value in sizes.items()})
    found = analyse(step, shaft, AnalysisRequest(), ["stiffness"], lambda done, what: None)
    return float(found.outputs["stiffness"]["value"])


def main() -> None:
    """Print a row for each throw."""
    errors: dict[str, list[float]] = {"1": [], "2": []}
    print("| web | overlap | Carter | Ker Wilson | version 1 | version 2 |\n|---:|---:|---:|---:|---:|---:|")
    for web in WEBS:
        for overlap in OVERLAPS:
            sizes = throw_of(overlap, web)
            true = by_elements(sizes)
            mm = {name: f"{value} mm" for name, value in sizes.items()}
            raw = {**mm, "shear_modulus": {"value": 210 / 2.6, "unit": "GPa"}}
            ours, first = (evaluate(cls, raw).outputs for cls in (CrankStiffness, First))
            carter, wilson, new = (
                100 * (ours[name].value / true - 1)
                for name in ("stiffness_carter", "stiffness_wilson", "recommended_stiffness")
            )
            old = 100 * (first["recommended_stiffness"].value / true - 1)
            errors["1"].append(old)
            errors["2"].append(new)
            cells = (f"{value:+.1f} %" for value in (carter, wilson, old, new))
            print(f"| {web:g} mm | {overlap:+.3f} |", " | ".join(cells), "|", flush=True)
    for version, all_ in errors.items():
        rms, worst = np.sqrt(np.mean(np.square(all_))), np.abs(all_).max()
        print(f"version {version}: root mean square {rms:.1f} %, worst {worst:.1f} %")


if __name__ == "__main__":
    main()

"""Pads, concentric journals and rolling bearings: worked examples of courses, books and catalogues."""

from __future__ import annotations

from templates.validate.by_template import by_template
from templates.validate.case import Case

PADS = (
    Case(
        "hydrostatic_mec_315",
        "MEC 315: hydrostatic pad of 100 mm under 60 kN",
        "hydrostatic_pad_mec_315.csv",
        "hydrostatic_pad 1",
        "printed example",
        by_template(
            "hydrostatic_pad",
            1,
            "hydrostatic_pad_mec_315.csv",
            restrictor="constant_flow",
            supply_pressure="20 MPa",
        ),
    ),
    Case(
        "hamrock_slider",
        "Hamrock et al. 2004: slider with a fixed incline, 100 mm",
        "hamrock_slider.csv",
        "slider_bearing 1",
        "printed example",
        by_template("slider_bearing", 1, "hamrock_slider.csv", level="infinite"),
    ),
    Case(
        "petrov_mec_315",
        "MEC 315: friction of a concentric journal of 50 mm",
        "petrov_mec_315.csv",
        "journal_friction 1",
        "printed example",
        by_template("journal_friction", 1, "petrov_mec_315.csv", radial_load="10 N"),
    ),
    Case(
        "petrov_pump_handbook",
        "Pump Handbook: friction of a concentric journal of 5 in",
        "pump_handbook_petroff.csv",
        "journal_friction 1",
        "printed example",
        by_template("journal_friction", 1, "pump_handbook_petroff.csv", radial_load="10 N"),
    ),
    Case(
        "skf_6309",
        "SKF: ball bearing 6309 under 10 kN",
        "skf_6309.csv",
        "rolling_bearing_life 1",
        "printed example",
        by_template("rolling_bearing_life", 1, "skf_6309.csv"),
    ),
    Case(
        "jindal_18_9",
        "Jindal, example 18-9: ball bearing under three loads",
        "jindal_2010_ex_18_9.csv",
        "rolling_bearing_life 1",
        "printed example",
        by_template("rolling_bearing_life", 1, "jindal_2010_ex_18_9.csv"),
    ),
)

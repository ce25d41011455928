"""Small drawings of what each field of the wizard means.

Thin lines are the engine, and the marked part is what the field states. Colours come from the style sheet.
"""

from __future__ import annotations

from markupsafe import Markup


def _path(kind: str, d: str) -> str:
    return f'<path class="{kind}" d="{d}"/>'


def _across(left: float, right: float, y: float) -> str:
    """Return a horizontal dimension."""
    return _path("mark", f"M{left},{y}H{right}M{left},{y - 4}v8M{right},{y - 4}v8")


def _upright(x: float, top: float, bottom: float) -> str:
    """Return a vertical dimension."""
    return _path("mark", f"M{x},{top}V{bottom}M{x - 4},{top}h8M{x - 4},{bottom}h8")


def _circle(kind: str, x: float, y: float, radius: float) -> str:
    return f'<circle class="{kind}" cx="{x}" cy="{y}" r="{radius}"/>'


def _mechanism(piston: str = "line", rod: str = "line") -> str:
    """Return one cylinder: walls, piston, rod and crank."""
    return (
        _path("line", "M36,8V48M84,8V48M72,64L60,74")
        + _circle("line dashed", 60, 74, 16)
        + _path(piston, "M38,16H82V32H38Z")
        + _path(rod, "M60,24L72,64")
        + "".join(_circle("dot", *at, 2.5) for at in ((60, 74), (72, 64), (60, 24)))
    )


_THROW = _path(
    "line",
    "M4,50H30V18H42V24H78V18H90V50H116M4,68H30V76H42V40H78V76H90V68H116M42,24V40M78,24V40M30,50V68M90,50V68",
)
"""One throw from the side: journal, web, crankpin, web, journal."""
_BEARING = _circle("line", 60, 46, 38) + _circle("line", 60, 46, 32) + _circle("line solid", 60, 52, 24)
"""A bearing along the shaft, with a large clearance."""
_CYCLE = _path("line", "M8,6V82H114") + _path(
    "line", "M8,74H34C46,74 52,60 56,40L58,14H63C68,44 78,62 90,66L96,72H114"
)
"""The pressure in a cylinder over the crank angle."""
_CLEARANCE = _BEARING + _path("mark", "M60,14V28M56,14h8M56,28h8")
_DRAWINGS = {
    "layout": _path(
        "mark",
        "M14,82V30M10,30h8M34,82V30M30,30h8M54,82V30M50,30h8M92,82L74,36M70,38l8,-4M92,82L110,36M106,34l8,4",
    )
    + _path("line", "M6,82H60M84,82h16"),
    "bore": _mechanism() + _across(36, 84, 12),
    "stroke": _mechanism() + _upright(102, 24, 56),
    "rod_length": _mechanism() + _path("mark", "M78,18L90,58M74,19.500l8,-3M86,59.500l8,-3"),
    "piston_mass": _mechanism(piston="filled"),
    "rod_mass": _mechanism(rod="thick"),
    "rod_centre": _mechanism()
    + _circle("spot", 68, 51, 5)
    + _path("mark", "M82,48L86,62M78,49.500l8,-3M82,63.500l8,-3"),
    "crank_unbalance": _circle("line dashed", 60, 46, 38)
    + _path("line filled", "M50,46V22A10,10 0 0 1 70,22V46L88,62A32,32 0 0 1 32,62Z")
    + _circle("dot", 60, 46, 3)
    + _path("mark", "M60,46V84M56,78l4,6l4,-6"),
    "speed": _mechanism() + _path("mark", "M38,74A22,22 0 1 0 60,52M66,47l-7,5l7,5"),
    "oil": _path("mark filled", "M60,10C72,32 84,44 84,58A24,24 0 0 1 36,58C36,44 48,32 60,10Z"),
    "permissible_film": _BEARING
    + _path("mark", "M60,76V90M60,66l-4,6M60,66l4,6")
    + _circle("spot", 60, 77, 3),
    "gas": _CYCLE,
    "diagram": _path("line", "M8,6V82H114")
    + _path("mark", "M8,74H34C46,74 52,60 58,26C60,8 64,8 67,26C72,56 80,64 92,68L114,74"),
    "firing_order": _path("line", "M8,46H112")
    + _circle("line", 18, 46, 11)
    + _circle("line", 46, 46, 11)
    + _circle("line", 74, 46, 11)
    + _circle("line", 102, 46, 11)
    + '<text x="18" y="50">1</text>'
    + '<text x="46" y="50">4</text>'
    + '<text x="74" y="50">2</text>'
    + '<text x="102" y="50">3</text>'
    + _path("mark", "M18,32C30,14 62,14 74,30M69,26l5,5l2,-7"),
    "journal_diameter": _THROW + _upright(14, 50, 68),
    "crankpin_diameter": _THROW + _upright(60, 24, 40),
    "crankpin_length": _THROW + _across(42, 78, 12),
    "web_thickness": _THROW + _across(30, 42, 84),
    "web_width": '<rect class="line" x="40" y="8" width="40" height="76" rx="20"/>'
    + _circle("line", 60, 28, 12)
    + _circle("line", 60, 62, 14)
    + _across(40, 80, 46),
    "throw_pitch": _THROW + _across(16, 104, 84),
    "support_stiffness": _THROW + _path("mark", "M16,68v3l-6,2l12,3l-12,3l12,3l-6,2v3M8,88h16"),
    "main_width": _THROW + _path("line filled", "M8,44H26V50H8ZM8,68H26V74H8Z") + _across(8, 26, 82),
    "big_end_width": _THROW + _path("line filled", "M48,18H72V24H48ZM48,40H72V46H48Z") + _across(48, 72, 54),
    "main_clearance": _CLEARANCE,
    "big_end_clearance": _CLEARANCE,
    "groove_width": '<rect class="line" x="24" y="12" width="72" height="66" rx="4"/>'
    + _path("line filled", "M52,12H68V78H52Z")
    + _across(52, 68, 85),
    "supply_pressure": _BEARING + _path("mark", "M60,2V16M56,11l4,6l4,-6"),
    "supply_temperature": _path("line", "M54,14A6,6 0 0 1 66,14V56A14,14 0 1 1 54,56Z")
    + _circle("spot", 60, 68, 9)
    + _path("mark", "M60,60V30"),
    "suction_pressure": _CYCLE + _path("mark", "M8,74H34"),
    "exhaust_pressure": _CYCLE + _path("mark", "M96,72H114"),
    "compression_ratio": _path("line", "M18,8V84M50,8V84M70,8V84M102,8V84M18,8H50M70,8H102")
    + _path("line filled", "M18,64H50V76H18ZM70,20H102V32H70Z")
    + _upright(34, 10, 62)
    + _upright(86, 9, 19),
    "compression_exponent": _CYCLE + _path("mark", "M34,74C46,74 52,60 56,40"),
    "expansion_exponent": _CYCLE + _path("mark", "M63,14C68,44 78,62 90,66"),
    "combustion_pressure": _CYCLE + _path("mark", "M60,82V14M56,20l4,-6l4,6"),
    "cutoff": _CYCLE + _path("mark", "M56,14H66"),
    "inlet_closes": _CYCLE + _path("mark", "M34,82V58") + _circle("spot", 34, 74, 3),
    "exhaust_opens": _CYCLE + _path("mark", "M90,82V52") + _circle("spot", 90, 66, 3),
    "crankcase_pressure": _mechanism() + _path("mark", "M48,48V36M44,42l4,-6l4,6M72,48V36M68,42l4,-6l4,6"),
}
PICTURES = {
    name: Markup('<svg class="meaning" viewBox="0 0 120 92" aria-hidden="true">' + drawing + "</svg>")
    for name, drawing in _DRAWINGS.items()
}
"""The drawings by the name of the field."""
